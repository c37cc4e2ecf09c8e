// Several files that appear together.
#pragma once

#include <filesystem>
#include <string_view>

#include "crumble/base/memory.hpp"

namespace crumble::render {

/// Files are written beside their places at once, under names of their own, and get their right names in commit();
/// without one the destructor removes them, and with them the folders that were made.
class FileSet {
 public:
  FileSet() = default;
  ~FileSet();
  FileSet(const FileSet&) = delete;
  FileSet& operator=(const FileSet&) = delete;

  /// A folder whose parent exists; nothing is done when it is there. Throws Error(io), as all of these do.
  void make_folder(const std::filesystem::path& path);
  void add(const std::filesystem::path& path, std::string_view text);
  /// Over files of the same names.
  void commit();

 private:
  Vector<std::filesystem::path> files_, folders_;
};

}  // namespace crumble::render
