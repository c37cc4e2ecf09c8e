// Runs gnuplot.
#pragma once

#include <string>

namespace crumble::render {

/// Gives `script` to gnuplot and returns what its terminal draws (the script sets no output). Throws Error:
/// unsupported when gnuplot cannot be started, internal with its message when it fails, io.
std::string run_gnuplot(const std::string& script);

}  // namespace crumble::render
