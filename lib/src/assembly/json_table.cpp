// SPDX-License-Identifier: Apache-2.0
#include "json_table.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "placed_meshes.hpp"

namespace cchip::assembly {
namespace {

/// Some programs write whole numbers as 3.0.
std::optional<std::size_t> whole_number(const nlohmann::json& value) {
  if (value.is_number_unsigned()) return value.get<std::size_t>();
  if (!value.is_number_float()) return std::nullopt;
  const auto x = value.get<double>();
  if (!(x >= 0 && x < 0x1p53) || x != std::floor(x)) return std::nullopt;
  return static_cast<std::size_t>(x);
}

}  // namespace

JsonTable::JsonTable(const std::string& file, const nlohmann::json& json, std::string who)
    : file_(&file), json_(&json), who_(std::move(who)) {
  if (!json.is_object()) refuse("must be an object of JSON; correct it, or export the file anew");
}

void JsonTable::refuse(const std::string& what) const {
  throw std::runtime_error(*file_ + ": " + who_ + (who_.empty() ? "" : ": ") + what);
}

void JsonTable::refuse_value(const char* key, const std::string& what) const {
  refuse("'" + std::string(key) + "' " + what + "; correct it, or export the file anew");
}

std::optional<std::size_t> JsonTable::whole(const char* key) const {
  if (!has(key)) return std::nullopt;
  const std::optional<std::size_t> value = whole_number((*json_)[key]);
  if (!value) refuse_value(key, "must be a whole number that is at least 0");
  return value;
}

std::size_t JsonTable::required_whole(const char* key) const {
  const std::optional<std::size_t> value = whole(key);
  if (!value) refuse_value(key, "is missing");
  return *value;
}

bool JsonTable::flag(const char* key, bool if_absent) const {
  if (!has(key)) return if_absent;
  const nlohmann::json& value = (*json_)[key];
  if (!value.is_boolean()) refuse_value(key, "must be true or false");
  return value.get<bool>();
}

std::string JsonTable::text(const char* key) const {
  if (!has(key)) return "";
  const nlohmann::json& value = (*json_)[key];
  if (!value.is_string()) refuse_value(key, "must be a text");
  return value.get<std::string>();
}

const nlohmann::json* JsonTable::list(const char* key) const {
  if (!has(key)) return nullptr;
  const nlohmann::json& value = (*json_)[key];
  if (!value.is_array()) refuse_value(key, "must be a list");
  return &value;
}

std::vector<std::string> JsonTable::texts(const char* key) const {
  std::vector<std::string> result;
  const nlohmann::json* values = list(key);
  if (values == nullptr) return result;
  for (const nlohmann::json& value : *values) {
    if (!value.is_string()) refuse_value(key, "must be a list of texts");
    result.push_back(value.get<std::string>());
  }
  return result;
}

std::vector<double> JsonTable::numbers(const char* key) const {
  std::vector<double> result;
  const nlohmann::json* values = list(key);
  if (values == nullptr) return result;
  for (const nlohmann::json& value : *values) {
    if (!value.is_number()) refuse_value(key, "must be a list of numbers");
    result.push_back(value.get<double>());
  }
  return result;
}

std::vector<double> JsonTable::numbers(const char* key, std::size_t count) const {
  std::vector<double> result = numbers(key);
  if (has(key) && result.size() != count) {
    refuse_value(key,
                 "must be a list of " + std::to_string(count) + " numbers, and has " + std::to_string(result.size()));
  }
  return result;
}

std::vector<std::size_t> JsonTable::wholes(const char* key) const {
  std::vector<std::size_t> result;
  const nlohmann::json* values = list(key);
  if (values == nullptr) return result;
  for (const nlohmann::json& value : *values) {
    const std::optional<std::size_t> number = whole_number(value);
    if (!number) refuse_value(key, "must be a list of whole numbers that are at least 0");
    result.push_back(*number);
  }
  return result;
}

std::optional<JsonTable> JsonTable::table(const char* key) const {
  if (!has(key)) return std::nullopt;
  return JsonTable(*file_, (*json_)[key], who_ + (who_.empty() ? "" : ": ") + key);
}

std::vector<JsonTable> JsonTable::tables(const char* key, const std::string& what) const {
  std::vector<JsonTable> result;
  const nlohmann::json* values = list(key);
  if (values == nullptr) return result;
  for (const nlohmann::json& value : *values) {
    std::string who = who_ + (who_.empty() ? "" : ": ") + what + " " + std::to_string(result.size());
    const auto name = value.is_object() ? value.find("name") : value.end();
    if (value.is_object() && name != value.end() && name->is_string()) {
      who += " ('" + one_line(name->get<std::string>()) + "')";
    }
    result.emplace_back(*file_, value, std::move(who));
  }
  return result;
}

std::optional<JsonTable> JsonTable::extension(const char* name) const {
  const std::optional<JsonTable> all = table("extensions");
  return all ? all->table(name) : std::nullopt;
}

std::string JsonTable::extensions() const {
  const std::optional<JsonTable> all = table("extensions");
  std::string names;
  if (!all) return names;
  for (const auto& [name, value] : all->json_->items()) names += (names.empty() ? "" : ", ") + one_line(name);
  return names;
}

}  // namespace cchip::assembly
