#include <array>
#include <bit>
#include <optional>

#include "crumble/base/memory.hpp"
#include "scenes/mesh_formats.hpp"
#include "scenes/text_lines.hpp"

namespace crumble {
namespace {

struct Type {
  std::string_view name, other_name;
  std::size_t bytes;
  enum { is_signed, is_unsigned, is_real } kind;
};
constexpr std::array<Type, 8> kTypes{{{"char", "int8", 1, Type::is_signed},
                                      {"uchar", "uint8", 1, Type::is_unsigned},
                                      {"short", "int16", 2, Type::is_signed},
                                      {"ushort", "uint16", 2, Type::is_unsigned},
                                      {"int", "int32", 4, Type::is_signed},
                                      {"uint", "uint32", 4, Type::is_unsigned},
                                      {"float", "float32", 4, Type::is_real},
                                      {"double", "float64", 8, Type::is_real}}};

struct Property {
  std::string name;
  Type value;
  std::optional<Type> count;  // of a list
};

struct Element {
  std::string name;
  std::size_t count;
  Vector<Property> properties;
};

struct Header {
  bool text = false, big_endian = false;
  Vector<Element> elements;
  std::size_t end = 0;  // in bytes
};

Type read_type(const TextLines& lines, std::size_t word) {
  const std::string_view name = word < lines.words().size() ? lines.words()[word] : std::string_view();
  for (const Type& type : kTypes) {
    if (name == type.name || name == type.other_name) return type;
  }
  lines.fail("has no type of numbers as its word " + std::to_string(word + 1));
}

Property read_property(const TextLines& lines) {
  const std::size_t words = lines.words().size();
  if (words < 3) lines.fail("is no property");
  const std::string name(lines.words()[words - 1]);
  if (lines.words()[1] != "list") return {name, read_type(lines, 1), {}};
  return {name, read_type(lines, 3), read_type(lines, 2)};
}

Header read_header(std::string_view bytes) {
  TextLines lines(bytes);
  if (!lines.next() || !lines.starts_with("ply")) throw Error(Code::format, "it does not begin with 'ply'");
  Header header;
  while (lines.next()) {
    const Vector<std::string_view>& words = lines.words();
    if (words[0] == "end_header") {
      header.end = lines.at();
      return header;
    }
    if (words[0] == "format") {
      header.text = words.size() > 1 && words[1] == "ascii";
      header.big_endian = words.size() > 1 && words[1] == "binary_big_endian";
      const bool little_endian = words.size() > 1 && words[1] == "binary_little_endian";
      if (!header.text && !header.big_endian && !little_endian) lines.fail("names a format that PLY does not have");
    } else if (words[0] == "element") {
      const double count = lines.number(2);
      // every row takes a byte at least
      if (!(count >= 0 && count <= static_cast<double>(bytes.size()))) lines.fail("announces more than the file holds");
      header.elements.push_back({std::string(words[1]), static_cast<std::size_t>(count), {}});
    } else if (words[0] == "property") {
      if (header.elements.empty()) lines.fail("is a property of nothing");
      header.elements.back().properties.push_back(read_property(lines));
    }
  }
  throw Error(Code::format, "its header has no end");
}

// The numbers behind the header, one by one.
class Values {
 public:
  Values(std::string_view bytes, const Header& header)
      : bytes_(bytes.substr(header.end)), text_(header.text), swapped_(header.big_endian) {}

  double next(const Type& type) { return text_ ? next_word() : next_binary(type); }

 private:
  double next_word() {
    constexpr std::string_view kSpace = " \t\r\n\v\f";
    const std::size_t begin = std::min(bytes_.find_first_not_of(kSpace), bytes_.size());
    const std::size_t end = std::min(bytes_.find_first_of(kSpace, begin), bytes_.size());
    std::string_view word = bytes_.substr(begin, end - begin);
    bytes_.remove_prefix(end);
    if (word.empty()) throw Error(Code::format, "it ends too early");
    if (word.starts_with('+')) word.remove_prefix(1);
    const auto value = parse_double(word);
    if (!value) throw Error(Code::format, "'" + std::string(word.substr(0, 40)) + "' is not a number");
    return *value;
  }
  double next_binary(const Type& type) {
    if (bytes_.size() < type.bytes) throw Error(Code::format, "it ends too early");
    std::uint64_t raw = 0;
    for (std::size_t i = 0; i < type.bytes; ++i) {
      const auto byte = static_cast<unsigned char>(bytes_[swapped_ ? type.bytes - 1 - i : i]);
      raw |= std::uint64_t{byte} << (8 * i);
    }
    bytes_.remove_prefix(type.bytes);
    if (type.kind == Type::is_unsigned) return static_cast<double>(raw);
    if (type.kind == Type::is_signed) {
      const auto shift = static_cast<int>(64 - 8 * type.bytes);
      return static_cast<double>(static_cast<std::int64_t>(raw << shift) >> shift);
    }
    if (type.bytes == 8) return std::bit_cast<double>(raw);
    return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(raw)));
  }

  std::string_view bytes_;
  bool text_, swapped_;
};

std::size_t read_count(Values& values, const Type& type) {
  const double count = values.next(type);
  if (!(count >= 0 && count <= 1e9) || count != std::floor(count)) {
    throw Error(Code::format, "it has a list of " + to_text(count) + " numbers");
  }
  return static_cast<std::size_t>(count);
}

Vec3 read_vertex(const Element& element, Values& values) {
  Vec3 place = Vec3::Zero();
  for (const Property& property : element.properties) {
    std::size_t left = property.count ? read_count(values, *property.count) : 1;
    for (; left > 0; --left) {
      const double value = values.next(property.value);
      if (property.name == "x") place.x() = value;
      if (property.name == "y") place.y() = value;
      if (property.name == "z") place.z() = value;
    }
  }
  if (!is_finite(place)) throw Error(Code::format, "it has a vertex that is not finite");
  return place;
}

Vector<std::uint32_t> read_face(const Element& element, std::size_t vertex_count, Values& values) {
  Vector<std::uint32_t> corners;
  for (const Property& property : element.properties) {
    const bool wanted = property.name == "vertex_indices" || property.name == "vertex_index";
    std::size_t left = property.count ? read_count(values, *property.count) : 1;
    for (; left > 0; --left) {
      const double index = values.next(property.value);
      if (!wanted) continue;
      if (!(index >= 0 && index < static_cast<double>(vertex_count)) || index != std::floor(index)) {
        throw Error(Code::format, "a face names vertex " + to_text(index) + " of " + std::to_string(vertex_count));
      }
      corners.push_back(static_cast<std::uint32_t>(index));
    }
  }
  return corners;
}

}  // namespace

TriangleMesh parse_ply(std::string_view bytes) {
  const Header header = read_header(bytes);
  Values values(bytes, header);
  TriangleMesh mesh;
  for (const Element& element : header.elements) {
    for (std::size_t row = 0; row < element.count; ++row) {
      if (element.name == "vertex") {
        mesh.vertices.push_back(read_vertex(element, values));
      } else {
        add_polygon(read_face(element, mesh.vertices.size(), values), mesh.triangles);
      }
    }
  }
  return mesh;
}

}  // namespace crumble
