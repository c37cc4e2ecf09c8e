#include "crumble/base/file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

[[noreturn]] void fail(std::string_view what, const std::filesystem::path& path) {
  throw Error(Code::io, std::string(what) + " '" + path.string() + "': " + std::strerror(errno));
}

template <class Bytes>
Bytes read_whole(const std::filesystem::path& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) fail("cannot read", path);
  std::error_code unknown;
  if (std::filesystem::is_directory(path, unknown)) errno = EISDIR, fail("cannot read", path);
  const std::streamoff size = file.tellg();
  if (size < 0) fail("cannot read", path);  // a pipe has no size
  Bytes bytes(static_cast<std::size_t>(size), {});
  file.seekg(0);
  if (!bytes.empty() && !file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()))) {
    fail("cannot read", path);
  }
  return bytes;
}

}  // namespace

Vector<std::uint8_t> read_bytes(const std::filesystem::path& path) {
  return read_whole<Vector<std::uint8_t>>(path);
}

std::string read_text(const std::filesystem::path& path) {
  return read_whole<std::string>(path);
}

void write_bytes(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  replace_file(path, [&](const std::filesystem::path& temporary) {
    errno = 0;
    std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file) fail("cannot write", path);
  });
}

void write_text(const std::filesystem::path& path, std::string_view text) {
  write_bytes(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace crumble
