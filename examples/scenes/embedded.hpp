// The scene and trajectory files, inside the program: built-in names work wherever it is installed.
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace crumble {

std::optional<std::string_view> embedded_file(std::string_view name);
std::span<const std::string_view> embedded_names();  // ascending

}  // namespace crumble
