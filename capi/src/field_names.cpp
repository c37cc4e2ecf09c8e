#include "field_names.hpp"

#include <cctype>
#include <utility>

namespace crumble::capi {
namespace {

// In C the fields of a group stand in the struct itself, most with the group's name before them. The first row that
// fits counts.
constexpr std::pair<std::string_view, std::string_view> kNames[] = {
    {"holder ", "tool "},
    {"hand.points", "points"},
    {"path.points", "points"},
    {"poke.direction", "press_direction"},
    {"hand.start", "start"},
    {"path.start", "start"},
    {"poke.start", "start"},
    {"press.start", "start"},
    {"tremor.start", "start"},
    {"wander.start", "start"},
    {"tremor.seconds", "seconds"},
    {"wander.seconds", "seconds"},
    {"workspace.pose", "workspace"},
    {"workspace.force_gain", "force_gain"},
    {"friction.static", "static_friction"},
    {"friction.dynamic", "dynamic_friction"},
    {"wall.normal", "normal"},
    {"wall.offset", "offset"},
    {"tool.offset", "offset"},
    {"material.", ""},
    {"step.", ""},
    {"safety.", ""},
    {"passivity.", ""},
    {"coupling.", "coupling_"},
    {"workspace.", "workspace_"},
    {"hand.", "hand_"},
    {"phantom.", "phantom_"},
    {"poke.", "poke_"},
    {"press.", "press_"},
    {"replay.", "replay_"},
    {"tremor.", "tremor_"},
    {"wander.", "wander_"},
    {"inverse3.", "inverse3_"},
};

bool is_of_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '/' || c == '\'';  // not in file names
}

// What is a name's group, and not the end of a sentence: a letter follows the dot.
bool stands_at(std::string_view text, std::size_t at, std::string_view name) {
  if (text.substr(at, name.size()) != name) return false;
  const std::size_t end = at + name.size();
  return name.back() != '.' || (end < text.size() && std::islower(static_cast<unsigned char>(text[end])) != 0);
}

}  // namespace

std::string in_names_of_c(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const bool begins_word = at == 0 || !is_of_word(text[at - 1]);
    bool replaced = false;
    for (const auto& [cpp, c] : kNames) {
      if (!begins_word || !stands_at(text, at, cpp)) continue;
      out += c;
      at += cpp.size();
      replaced = true;
      break;
    }
    if (!replaced) out += text[at++];
  }
  return out;
}

}  // namespace crumble::capi
