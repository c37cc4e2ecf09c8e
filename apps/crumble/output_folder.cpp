#include "output_folder.hpp"

#include <stdlib.h>

#include <cerrno>
#include <string>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"

namespace crumble::app {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& reason) {
  throw Error(Code::io, "--out '" + path.string() + "' cannot be written: " + reason);
}

std::filesystem::path first_missing(const std::filesystem::path& path) {
  std::filesystem::path missing;
  std::error_code none;
  for (auto part = path; !std::filesystem::exists(part, none) && part != part.parent_path(); part = part.parent_path())
    missing = part;
  return missing;
}

}  // namespace

OutputFolder::OutputFolder(const std::filesystem::path& path) {
  std::error_code error;
  path_ = std::filesystem::absolute(path, error).lexically_normal();
  if (!path_.has_filename()) path_ = path_.parent_path();  // of "folder/"
  made_ = first_missing(path_);
  std::filesystem::create_directories(path_, error);
  std::string name = (path_ / ".part-XXXXXX").string();
  if (!error && !::mkdtemp(name.data())) error.assign(errno, std::generic_category());
  if (error) {
    std::error_code ignored;
    if (!made_.empty()) std::filesystem::remove_all(made_, ignored);
    fail(path, error.message());
  }
  temporary_ = name;
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(temporary_, ignored);
  if (!made_.empty()) std::filesystem::remove_all(made_, ignored);
}

void OutputFolder::commit() {
  Vector<std::filesystem::path> names;
  for (const auto& file : std::filesystem::directory_iterator(temporary_)) names.push_back(file.path().filename());
  std::error_code error;
  for (const auto& name : names) {  // the one thing that stops a move within a folder which we have written to
    if (std::filesystem::is_directory(path_ / name, error)) fail(path_ / name, "it is a folder");
  }
  for (const auto& name : names) {
    std::filesystem::rename(temporary_ / name, path_ / name, error);
    if (error) fail(path_ / name, error.message());
  }
  made_.clear();
}

}  // namespace crumble::app
