// The rules that keep the modules apart, as checks over the text of a source tree. Each returns what is wrong, one
// line for each find, beginning with the file; nothing when the tree is in order.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace crumble::architecture {

/// Sources and headers of the library: include/crumble, src and capi, sorted.
std::vector<std::filesystem::path> library_files(const std::filesystem::path& root);

/// Dependencies point down: no include goes to a higher layer, to a sibling, or out of the library.
std::vector<std::string> check_includes(const std::filesystem::path& root);

/// FCL stands in one source file at most, Eigen nowhere in capi, <iostream> (static constructors) nowhere.
std::vector<std::string> check_outside_headers(const std::filesystem::path& root);

/// exp, sin and the like come from base/transcendental.hpp: libm's differ between systems in the last bit.
std::vector<std::string> check_transcendentals(const std::filesystem::path& root);

/// No build file names a flag that changes results or ties the library to one processor.
std::vector<std::string> check_build_files(const std::filesystem::path& root);

/// Every compilation of compile_commands.json is done with contraction off.
std::vector<std::string> check_contraction(const std::filesystem::path& compile_commands);

}  // namespace crumble::architecture
