// Runs the built command line as a user does.
#pragma once

#include <filesystem>
#include <string>

#include "crumble/base/memory.hpp"

namespace crumble::cli {

struct Outcome {
  int code = -1;  // exit code; 128 + signal when it was killed
  std::string out, err;
};

/// `crumble arguments...`, in `folder`.
Outcome crumble(const Vector<std::string>& arguments,
                const std::filesystem::path& folder = std::filesystem::temp_directory_path());

}  // namespace crumble::cli
