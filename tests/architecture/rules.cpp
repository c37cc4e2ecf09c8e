#include "architecture/rules.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

namespace crumble::architecture {
namespace {

namespace fs = std::filesystem;

// Modules by layer. A module may include those of lower layers; its siblings it does not know.
constexpr std::array<std::pair<std::string_view, int>, 11> kLayers{{{"base", 0},
                                                                    {"geometry", 1},
                                                                    {"tetmesh", 2},
                                                                    {"bubblemesh", 3},
                                                                    {"contact", 3},
                                                                    {"fracture", 3},
                                                                    {"network", 3},
                                                                    {"device", 4},
                                                                    {"sim", 4},
                                                                    {"haptics", 5},
                                                                    {"capi", 6}}};
// Downward, and still not allowed: a simulation takes any mesh and does not care who made it.
constexpr std::array<std::pair<std::string_view, std::string_view>, 1> kStrangers{{{"sim", "bubblemesh"}}};

std::optional<int> layer_of(std::string_view module) {
  const auto* found =
      std::find_if(kLayers.begin(), kLayers.end(), [&](const auto& row) { return row.first == module; });
  if (found == kLayers.end()) return std::nullopt;
  return found->second;
}

bool has_extension(const fs::path& file, std::initializer_list<std::string_view> extensions) {
  return std::find(extensions.begin(), extensions.end(), file.extension().string()) != extensions.end();
}

// Files below `folder` that `wanted` picks, sorted. Build trees and hidden folders are left out.
template <class Wanted>
std::vector<fs::path> files_below(const fs::path& folder, Wanted&& wanted) {
  std::vector<fs::path> files;
  if (!fs::exists(folder)) return files;
  for (auto it = fs::recursive_directory_iterator(folder); it != fs::recursive_directory_iterator(); ++it) {
    const fs::path& path = it->path();
    if (it->is_directory()) {
      if (path.filename().string().starts_with('.') || path.filename() == "build" ||
          fs::exists(path / "CMakeCache.txt"))
        it.disable_recursion_pending();
    } else if (wanted(path)) {
      files.push_back(path);
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

struct Include {
  std::string path;
  bool quoted;
};

// The path of an include directive, nothing for any other line.
std::optional<Include> include_of(std::string_view line) {
  const auto skip = [&line](std::string_view word) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    if (!line.starts_with(word)) return false;
    line.remove_prefix(word.size());
    return true;
  };
  if (!skip("#") || !skip("include")) return std::nullopt;
  const bool quoted = skip("\"");
  if (!quoted && !skip("<")) return std::nullopt;
  return Include{std::string(line.substr(0, line.find(quoted ? '"' : '>'))), quoted};
}

std::vector<Include> includes_of(const fs::path& file) {
  std::vector<Include> includes;
  for (const std::string& line : lines_of(file)) {
    if (const auto include = include_of(line)) includes.push_back(*include);
  }
  return includes;
}

// "file names word: line" for each line of the file that holds one of the words.
template <std::size_t N>
void find_words(const fs::path& root, const fs::path& file, const std::array<std::string_view, N>& words,
                std::vector<std::string>& wrong) {
  for (const std::string& line : lines_of(file)) {
    for (const std::string_view word : words) {
      if (line.find(word) != std::string::npos)
        wrong.push_back(file.lexically_relative(root).string() + " names " + std::string(word) + ": " + line);
    }
  }
}

// include/crumble/<module>/..., src/<module>/..., capi/...
std::string module_of_file(const fs::path& relative) {
  std::vector<std::string> parts(relative.begin(), relative.end());
  if (parts[0] == "capi") return "capi";
  const std::size_t at = parts[0] == "include" ? 2 : 1;
  return at + 1 < parts.size() ? parts[at] : "";
}

// The module whose header is included, "" for a name that is no module's, nothing for what is outside the library.
std::optional<std::string> module_of_include(const Include& include, const std::string& from) {
  const std::size_t slash = include.path.find('/');
  const std::string first = include.path.substr(0, slash);
  if (first == "crumble" && slash != std::string::npos) {
    const std::string rest = include.path.substr(slash + 1);
    const std::size_t next = rest.find('/');
    return next == std::string::npos ? "capi" : rest.substr(0, next);
  }
  if (!include.quoted) return std::nullopt;
  return slash == std::string::npos ? from : first;
}

// Why `from` may not include a header of `to`; empty when it may.
std::string objection(const std::string& from, const std::string& to) {
  const std::optional<int> here = layer_of(from), there = layer_of(to);
  if (!here) return "the file stands in no module";
  if (!there) return "that is no module of the library";
  if (from == to) return "";
  if (*there > *here) return "upward, from " + from + " to " + to;
  if (*there == *here) return "sideways, from " + from + " to its sibling " + to;
  if (std::find(kStrangers.begin(), kStrangers.end(), std::pair<std::string_view, std::string_view>(from, to)) !=
      kStrangers.end())
    return from + " does not know " + to;
  return "";
}

}  // namespace

std::vector<fs::path> library_files(const fs::path& root) {
  std::vector<fs::path> files;
  for (const char* folder : {"include", "src", "capi"}) {
    for (fs::path& file : files_below(root / folder, [](const fs::path& f) {
           return has_extension(f, {".h", ".hpp", ".c", ".cpp"});
         }))
      files.push_back(std::move(file));
  }
  return files;
}

std::vector<std::string> check_includes(const fs::path& root) {
  std::vector<std::string> wrong;
  for (const fs::path& file : library_files(root)) {
    const fs::path relative = file.lexically_relative(root);
    const std::string from = module_of_file(relative);
    for (const Include& include : includes_of(file)) {
      const std::optional<std::string> to = module_of_include(include, from);
      const std::string why = to ? objection(from, *to) : "";
      if (!why.empty()) wrong.push_back(relative.string() + " includes " + include.path + ": " + why);
    }
  }
  return wrong;
}

std::vector<std::string> check_outside_headers(const fs::path& root) {
  std::vector<std::string> wrong;
  std::string fcl_file;
  for (const fs::path& file : library_files(root)) {
    const std::string name = file.lexically_relative(root).string();
    for (const Include& include : includes_of(file)) {
      const auto complain = [&](const char* why) { wrong.push_back(name + " includes " + include.path + ": " + why); };
      if (include.path == "iostream") complain("the library prints nothing");
      if (include.path.starts_with("Eigen/") && name.starts_with("capi/"))
        complain("Eigen does not cross the C border");
      if (!include.path.starts_with("fcl/")) continue;
      if (!name.ends_with(".cpp")) complain("FCL stays out of headers");
      if (!fcl_file.empty() && fcl_file != name) complain(("FCL already stands in " + fcl_file).c_str());
      fcl_file = name;
    }
  }
  return wrong;
}

std::vector<std::string> check_transcendentals(const fs::path& root) {
  constexpr std::array<std::string_view, 25> kLibm{
      "std::exp(",   "std::exp2(", "std::expm1(",  "std::log(",   "std::log2(", "std::log10(", "std::log1p(",
      "std::pow(",   "std::sin(",  "std::cos(",    "std::tan(",   "std::asin(", "std::acos(",  "std::atan(",
      "std::atan2(", "std::sinh(", "std::cosh(",   "std::tanh(",  "std::cbrt(", "std::hypot(", "std::fma(",
      "std::erf(",   "std::erfc(", "std::lgamma(", "std::tgamma("};
  std::vector<std::string> wrong;
  for (const fs::path& file : library_files(root)) {
    // the angles of the quality report are told to people and are part of no state
    if (file != root / "src/tetmesh/quality.cpp") find_words(root, file, kLibm, wrong);
  }
  return wrong;
}

std::vector<std::string> check_build_files(const fs::path& root) {
  constexpr std::array<std::string_view, 9> kFlags{
      "-march", "-mtune", "-mfma", "-mavx", "-msse", "-ffast-math", "-funsafe-math", "-Ofast", "-ffp-contract=fast"};
  std::vector<std::string> wrong;
  const auto is_build_file = [](const fs::path& f) {
    return f.filename() == "CMakeLists.txt" || f.filename() == "CMakePresets.json" || f.extension() == ".cmake";
  };
  for (const fs::path& file : files_below(root, is_build_file)) find_words(root, file, kFlags, wrong);
  return wrong;
}

// CMake writes one "command" and then one "file" for each compilation, each on its own line.
std::vector<std::string> check_contraction(const fs::path& compile_commands) {
  std::vector<std::string> wrong;
  bool off = false, any = false;
  for (const std::string& line : lines_of(compile_commands)) {
    if (line.find("\"command\":") != std::string::npos) {
      any = true;
      off = line.find("-ffp-contract=off") != std::string::npos;
    }
    if (line.find("\"file\":") != std::string::npos && !off) wrong.push_back(line + " is compiled with contraction");
  }
  if (!any) wrong.push_back(compile_commands.string() + " holds no command");
  return wrong;
}

}  // namespace crumble::architecture
