// Reads JSON objects key by key, so that every complaint names the key by its whole path and no key is overlooked.
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "crumble/base/error.hpp"
#include "crumble/base/vec.hpp"

namespace crumble {

class Fields {
 public:
  Fields(const nlohmann::json& node, std::string path) : node_(node), path_(std::move(path)) {
    if (!node.is_object()) fail(path_, "must be an object");
  }
  bool has(const std::string& key) const { return node_.contains(key); }
  const nlohmann::json& at(const std::string& key) {
    used_.insert(key);
    if (!has(key)) fail(name(key), "is missing");
    return node_.at(key);
  }
  Fields object(const std::string& key) { return {at(key), name(key)}; }
  double number(const std::string& key) {
    const nlohmann::json& value = at(key);
    if (!value.is_number()) fail(name(key), "must be a number, is " + value.dump());
    return value.get<double>();
  }
  double number(const std::string& key, double otherwise) { return has(key) ? number(key) : otherwise; }
  std::uint32_t count(const std::string& key) {
    const double value = number(key);
    if (!(value >= 0 && value <= 1e9) || value != static_cast<double>(static_cast<std::uint32_t>(value))) {
      fail(name(key), "must be a whole number, is " + at(key).dump());
    }
    return static_cast<std::uint32_t>(value);
  }
  std::string text(const std::string& key) {
    const nlohmann::json& value = at(key);
    if (!value.is_string()) fail(name(key), "must be a text, is " + value.dump());
    return value.get<std::string>();
  }
  Vec3 vector(const std::string& key) {
    const nlohmann::json& value = at(key);
    const bool good =
        value.is_array() && value.size() == 3 && value[0].is_number() && value[1].is_number() && value[2].is_number();
    if (!good) fail(name(key), "must be three numbers, is " + value.dump());
    return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
  }
  Vec3 vector(const std::string& key, const Vec3& otherwise) { return has(key) ? vector(key) : otherwise; }
  /// Throws when a key was not asked for.
  void finish() const {
    for (const auto& item : node_.items()) {
      if (!used_.count(item.key())) fail(name(item.key()), "is not a key that scenes have");
    }
  }
  std::string name(const std::string& key) const { return path_ + (path_.empty() ? "" : ".") + key; }
  [[noreturn]] static void fail(const std::string& field, const std::string& what) {
    throw Error(Code::format, field + " " + what);
  }

 private:
  const nlohmann::json& node_;
  std::string path_;
  std::set<std::string> used_;
};

}  // namespace crumble
