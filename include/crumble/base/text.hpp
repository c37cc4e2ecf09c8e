// Numbers as text, independent of the locale and exact in both directions.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace crumble {

/// Shortest text that parses back to the same double ("nan", "inf", "-inf" for the rest).
std::string to_text(double value);

/// The whole of `text` as a double; nothing when it is not one number.
std::optional<double> parse_double(std::string_view text);

}  // namespace crumble
