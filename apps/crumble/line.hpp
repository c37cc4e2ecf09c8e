// A formatted piece of a report.
#pragma once

#include <cstdio>
#include <string>

namespace crumble::app {

/// printf into a string; at most 399 characters of it.
template <class... Values>
std::string line(const char* format, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

}  // namespace crumble::app
