// SPDX-License-Identifier: Apache-2.0
/// \file
/// Objects of JSON with errors that say where.
#ifndef CCHIP_ASSEMBLY_JSON_TABLE_HPP
#define CCHIP_ASSEMBLY_JSON_TABLE_HPP

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace cchip::assembly {

/// An object of a JSON file. Keys that are absent give nothing; values of another type than asked for are errors.
class JsonTable {
 public:
  /// \param file its path; must live as long as this
  /// \param who what the object is, for messages: "node 3"; empty: the file as a whole
  JsonTable(const std::string& file, const nlohmann::json& json, std::string who);

  [[noreturn]] void refuse(const std::string& what) const;
  const std::string& who() const { return who_; }
  bool has(const char* key) const { return json_->contains(key); }
  /// A number of 0, 1, 2, ...
  std::optional<std::size_t> whole(const char* key) const;
  std::size_t whole(const char* key, std::size_t if_absent) const { return whole(key).value_or(if_absent); }
  std::size_t required_whole(const char* key) const;
  bool flag(const char* key, bool if_absent) const;
  std::string text(const char* key) const;
  std::vector<std::string> texts(const char* key) const;
  std::vector<double> numbers(const char* key) const;
  /// \param count how many there must be if the key is there
  std::vector<double> numbers(const char* key, std::size_t count) const;
  std::vector<std::size_t> wholes(const char* key) const;
  /// An object in the object.
  std::optional<JsonTable> table(const char* key) const;
  /// A list of objects. \param what each of them is: "node"
  std::vector<JsonTable> tables(const char* key, const std::string& what) const;
  /// The extension of that name.
  std::optional<JsonTable> extension(const char* name) const;
  /// The names of its extensions, with commas.
  std::string extensions() const;

 private:
  [[noreturn]] void refuse_value(const char* key, const std::string& what) const;
  const nlohmann::json* list(const char* key) const;

  const std::string* file_;
  const nlohmann::json* json_;
  std::string who_;
};

}  // namespace cchip::assembly

#endif
