// Reads JSON objects key by key, so that every complaint names the key by its whole path and no key is overlooked.
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/vec.hpp"

namespace crumble {

class Fields {
 public:
  Fields(const nlohmann::json& node, std::string path) : node_(node), path_(std::move(path)) {
    if (!node.is_object()) fail(path_.empty() ? "the scene" : path_, "must be an object, is " + shown(node));
  }
  bool has(const std::string& key) const { return node_.contains(key); }
  const nlohmann::json& at(const std::string& key) {
    used_.insert(key);
    if (!has(key)) fail(name(key), "is missing");
    return node_.at(key);
  }
  Fields object(const std::string& key) { return {at(key), name(key)}; }
  Vector<Fields> objects(const std::string& key) {
    const nlohmann::json& value = at(key);
    if (!value.is_array()) fail(name(key), "must be a list, is " + shown(value));
    Vector<Fields> all;
    for (std::size_t i = 0; i < value.size(); ++i)
      all.emplace_back(value[i], name(key) + "[" + std::to_string(i) + "]");
    return all;
  }
  double number(const std::string& key) {
    const nlohmann::json& value = at(key);
    if (!value.is_number()) fail(name(key), "must be a number, is " + shown(value));
    return value.get<double>();
  }
  double number(const std::string& key, double otherwise) { return has(key) ? number(key) : otherwise; }
  double positive(const std::string& key) {
    const double value = number(key);
    require_positive(name(key), value);
    return value;
  }
  double positive(const std::string& key, double otherwise) { return has(key) ? positive(key) : otherwise; }
  std::uint32_t count(const std::string& key) {
    const double value = number(key);
    if (!(value >= 0 && value <= 1e9) || value != static_cast<double>(static_cast<std::uint32_t>(value))) {
      fail(name(key), "must be a whole number, is " + shown(at(key)));
    }
    return static_cast<std::uint32_t>(value);
  }
  /// A list of whole numbers below `limit`.
  Vector<std::uint32_t> counts(const std::string& key, std::size_t limit) {
    const nlohmann::json& value = at(key);
    if (!value.is_array()) fail(name(key), "must be a list, is " + shown(value));
    Vector<std::uint32_t> all;
    for (const nlohmann::json& each : value) {
      if (!each.is_number_unsigned() || each.get<std::uint64_t>() >= limit) {
        fail(name(key) + "[" + std::to_string(all.size()) + "]",
             "must be a whole number below " + std::to_string(limit) + ", is " + shown(each));
      }
      all.push_back(each.get<std::uint32_t>());
    }
    return all;
  }
  bool truth(const std::string& key, bool otherwise) {
    if (!has(key)) return otherwise;
    const nlohmann::json& value = at(key);
    if (!value.is_boolean()) fail(name(key), "must be true or false, is " + shown(value));
    return value.get<bool>();
  }
  std::string text(const std::string& key) {
    const nlohmann::json& value = at(key);
    if (!value.is_string()) fail(name(key), "must be a text, is " + shown(value));
    return value.get<std::string>();
  }
  Vec3 vector(const std::string& key) {
    const nlohmann::json& value = at(key);
    const bool good =
        value.is_array() && value.size() == 3 && value[0].is_number() && value[1].is_number() && value[2].is_number();
    if (!good) fail(name(key), "must be three numbers, is " + shown(value));
    return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
  }
  Vec3 vector(const std::string& key, const Vec3& otherwise) { return has(key) ? vector(key) : otherwise; }
  /// Three positive numbers.
  Vec3 sizes(const std::string& key) {
    const Vec3 value = vector(key);
    for (int axis = 0; axis < 3; ++axis) require_positive(name(key) + "." + "xyz"[axis], value[axis]);
    return value;
  }
  /// Of any length but zero; returned as a unit vector.
  Vec3 direction(const std::string& key) {
    const Vec3 value = vector(key);
    require_positive(name(key) + " (its length)", norm(value));
    return normalized(value);
  }
  /// Calls `make`, and says in which object of the scene it was when it complains.
  template <class Make>
  auto build(Make&& make) const {
    try {
      return make();
    } catch (const Error& error) {
      throw Error(error.code(), path_ + ": " + error.what());
    }
  }
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
  static std::string shown(const nlohmann::json& value) {
    const std::string text = value.dump();
    return text.size() <= 60 ? text : text.substr(0, 57) + "...";
  }

  const nlohmann::json& node_;
  std::string path_;
  std::set<std::string> used_;
};

}  // namespace crumble
