#include "render/file_set.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "crumble/base/error.hpp"

namespace crumble::render {
namespace {

std::filesystem::path waiting(const std::filesystem::path& path) {
  std::filesystem::path name = path;
  return name += ".new";
}

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& reason) {
  throw Error(Code::io, "cannot write '" + path.string() + "': " + reason);
}

}  // namespace

FileSet::~FileSet() {
  std::error_code ignored;
  for (const auto& file : files_) std::filesystem::remove(waiting(file), ignored);
  for (auto folder = folders_.rbegin(); folder != folders_.rend(); ++folder) std::filesystem::remove(*folder, ignored);
}

void FileSet::make_folder(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::create_directory(path, error)) folders_.push_back(path);
  if (error) fail(path, error.message());
}

void FileSet::add(const std::filesystem::path& path, std::string_view text) {
  std::error_code ignored;  // the one thing that stops commit() in a folder which we have written to
  if (std::filesystem::is_directory(path, ignored)) fail(path, "it is a folder");
  files_.push_back(path);
  errno = 0;
  std::ofstream file(waiting(path), std::ios::binary | std::ios::trunc);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  if (!file) fail(path, std::strerror(errno));
}

void FileSet::commit() {
  std::error_code error;
  for (const auto& file : files_) {
    std::filesystem::rename(waiting(file), file, error);
    if (error) fail(file, error.message());
  }
  files_.clear();
  folders_.clear();
}

}  // namespace crumble::render
