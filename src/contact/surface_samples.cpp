#include "crumble/contact/surface_samples.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

// Lists of different lengths, one behind the other.
struct Lists {
  Vector<std::uint32_t> first, items;
  std::span<const std::uint32_t> operator[](std::size_t i) const {
    return std::span(items).subspan(first[i], first[i + 1] - first[i]);
  }
};

// `members` names for each item the lists that hold it.
template <class Members>
Lists invert(const Vector<Members>& members, std::size_t lists) {
  Lists result;
  result.first.assign(lists + 1, 0);
  for (const Members& of : members) {
    for (const std::uint32_t list : of) ++result.first[list + 1];
  }
  for (std::size_t i = 0; i < lists; ++i) result.first[i + 1] += result.first[i];
  result.items.resize(result.first.back());
  Vector<std::uint32_t> next = result.first;
  for (std::uint32_t item = 0; item < members.size(); ++item) {
    for (const std::uint32_t list : members[item]) result.items[next[list]++] = item;
  }
  return result;
}

std::uint32_t edge_between(std::uint8_t a, std::uint8_t b) {
  std::uint32_t e = 0;
  while (kTetEdges[e] != std::array{std::min(a, b), std::max(a, b)}) ++e;
  return e;
}

}  // namespace

struct SurfaceSamples::Faces {
  Vector<Triangle> nodes;                        // counter-clockwise seen from outside the first tetrahedron
  Vector<std::array<std::uint32_t, 2>> sides;    // its tetrahedra; the second kNone on the boundary
  Vector<std::array<std::uint32_t, 3>> springs;  // its edges
  Vector<std::array<std::uint32_t, 4>> of_tet;   // faces of each tetrahedron
  Lists of_node, tets_of_spring;
};

SurfaceSamples::SurfaceSamples(const TetMesh& mesh) {
  struct Side {
    Triangle sorted;
    std::uint32_t tet, local;
  };
  Vector<Side> sides;
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    for (std::uint32_t f = 0; f < 4; ++f) {
      Side side{{}, t, f};
      for (std::size_t k = 0; k < 3; ++k) side.sorted[k] = mesh.tetrahedra[t][kTetFaces[f][k]];
      std::sort(side.sorted.begin(), side.sorted.end());
      sides.push_back(side);
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return std::tie(a.sorted, a.tet) < std::tie(b.sorted, b.tet); });

  auto faces = share_new<Faces>();
  faces->of_tet.resize(mesh.tetrahedra.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const auto& [sorted, tet, local] = sides[i];
    if (i > 0 && sorted == sides[i - 1].sorted) {
      faces->sides.back()[1] = tet;
    } else {
      const auto& corners = kTetFaces[local];
      Triangle nodes, springs;
      for (std::size_t k = 0; k < 3; ++k) {
        nodes[k] = mesh.tetrahedra[tet][corners[k]];
        springs[k] = mesh.tet_springs[tet][edge_between(corners[k], corners[(k + 1) % 3])];
      }
      faces->nodes.push_back(nodes);
      faces->springs.push_back(springs);
      faces->sides.push_back({tet, kNone});
    }
    faces->of_tet[tet][local] = static_cast<std::uint32_t>(faces->nodes.size() - 1);
  }
  faces->of_node = invert(faces->nodes, mesh.node_count());
  faces->tets_of_spring = invert(mesh.tet_springs, mesh.springs.size());
  faces_ = std::move(faces);

  double sum = 0;
  for (const auto& [a, b] : mesh.springs) {
    const double length = norm(mesh.positions[b] - mesh.positions[a]);
    sum += length;
    longest_spring_ = std::max(longest_spring_, length);
  }
  node_spacing_ = sum / static_cast<double>(mesh.springs.size());
  cut_.resize(mesh.springs.size());
  broken_.resize(mesh.tetrahedra.size());
  open_.resize(faces_->nodes.size());
  open_of_node_.resize(mesh.node_count());
  seen_.resize(open_.size());
  found_.resize(open_.size());
  clear();
}

void SurfaceSamples::clear() noexcept {
  std::fill(cut_.begin(), cut_.end(), std::uint8_t{0});
  std::fill(broken_.begin(), broken_.end(), std::uint8_t{0});
  for (std::uint32_t f = 0; f < open_.size(); ++f) open_or_close(f);
}

void SurfaceSamples::note_cut(std::span<const std::uint32_t> springs) noexcept {
  if (!faces_) return;
  for (const std::uint32_t s : springs) {
    cut_[s] = 1;
    for (const std::uint32_t t : faces_->tets_of_spring[s]) broken_[t] = 1;
    for (const std::uint32_t t : faces_->tets_of_spring[s]) {
      for (const std::uint32_t f : faces_->of_tet[t]) open_or_close(f);
    }
  }
}

// Between two broken tetrahedra a face has no inside any more.
void SurfaceSamples::open_or_close(std::uint32_t face) noexcept {
  const auto [first, second] = faces_->sides[face];
  const auto& springs = faces_->springs[face];
  const bool whole = std::none_of(springs.begin(), springs.end(), [&](std::uint32_t s) { return cut_[s] != 0; });
  const std::uint8_t open = whole && (second == kNone || broken_[first] != broken_[second]);
  for (const std::uint32_t i : faces_->nodes[face]) open_of_node_[i] += open - open_[face];
  open_[face] = open;
}

Triangle SurfaceSamples::nodes_of(std::uint32_t face) const noexcept {
  const auto [first, second] = faces_->sides[face];
  const auto [a, b, c] = faces_->nodes[face];
  return second != kNone && broken_[first] ? Triangle{a, c, b} : Triangle{a, b, c};
}

std::span<const std::uint32_t> SurfaceSamples::faces_of(std::span<const std::uint32_t> nodes) noexcept {
  if (++search_ == 0) std::fill(seen_.begin(), seen_.end(), 0), search_ = 1;  // once in 2^32
  std::size_t count = 0;
  for (const std::uint32_t i : nodes) {
    if (open_of_node_[i] == 0) continue;  // most are inside
    for (const std::uint32_t f : faces_->of_node[i]) {
      if (!open_[f] || seen_[f] == search_) continue;
      seen_[f] = search_;
      found_[count++] = f;
    }
  }
  return {found_.data(), count};
}

std::uint32_t SurfaceSamples::parts(double longest_edge, double spacing) noexcept {
  return static_cast<std::uint32_t>(std::clamp(std::ceil(longest_edge / spacing), 1.0, double{kMostParts}));
}

void SurfaceSamples::save(ByteWriter& out) const {
  out.put(cut_);
}

// What is broken and open follows from what is cut.
void SurfaceSamples::load(ByteReader& in) {
  clear();
  const auto cut = in.get_vector<std::uint8_t>();
  if (cut.size() != cut_.size()) throw Error(Code::corrupt, "snapshot holds an impossible number of cut springs");
  for (std::uint32_t s = 0; s < cut.size(); ++s) {
    if (cut[s] > 1) throw Error(Code::corrupt, "snapshot holds a spring that is neither cut nor intact");
    if (cut[s]) note_cut({&s, 1});
  }
}

}  // namespace crumble
