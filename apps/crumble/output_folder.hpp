// A folder that gets all of its new files or none.
#pragma once

#include <filesystem>

namespace crumble::app {

/// Made before the long work, so that a folder that cannot be written is known at once. Files are written into a
/// temporary folder inside it and moved out of that by commit(); without a commit the destructor removes them, and with
/// them the folders that the constructor had to make.
class OutputFolder {
 public:
  /// Throws Error(io) naming --out and the path.
  explicit OutputFolder(const std::filesystem::path& path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::filesystem::path& temporary() const { return temporary_; }
  /// Moves the files to the folder itself, over those of the same names.
  void commit();

 private:
  std::filesystem::path path_, temporary_;
  std::filesystem::path made_;  // the uppermost folder that did not exist; empty when all did, or after commit()
};

}  // namespace crumble::app
