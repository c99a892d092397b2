// SPDX-License-Identifier: Apache-2.0
/// \file
/// The JSON and the numbers of a glTF or GLB, without their meaning.
#ifndef CCHIP_ASSEMBLY_GLTF_FILE_HPP
#define CCHIP_ASSEMBLY_GLTF_FILE_HPP

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "json_table.hpp"
#include "placed_meshes.hpp"

namespace cchip::assembly {

class GltfFile {
 public:
  /// Reads the file; the buffers beside it when an accessor needs them.
  /// \throws std::runtime_error one line: it is not glTF 2
  GltfFile(const std::string& path, std::uint64_t most_bytes);
  GltfFile(const GltfFile&) = delete;
  GltfFile& operator=(const GltfFile&) = delete;

  const std::string& path() const { return path_; }
  [[noreturn]] void refuse(const std::string& what) const;
  JsonTable root() const { return {path_, json_, ""}; }
  /// Member `number` of one of the lists of the file.
  const JsonTable& member(const std::vector<JsonTable>& list, std::size_t number, const char* what,
                          const std::string& who) const;
  /// Takes from what the file may ask for.
  void spend(std::uint64_t count, std::uint64_t bytes_each, const std::string& who);

  enum class Use { floats, numbers, indices };
  /// Numbers of an accessor, of all its elements one after the other, with sparse values put in.
  /// \param components of each: 1, 3 or 4
  /// \param use which types of numbers are taken: floats and normalised integers; plain integers as well; or
  ///        unsigned integers
  std::vector<double> accessor(std::size_t number, std::size_t components, Use use, const std::string& who);

 private:
  struct Elements {
    const unsigned char* first;
    std::size_t stride;
  };
  struct Numbers {
    std::size_t type;  ///< of a component: 5126 is float
    bool normalized;
    std::size_t components;
    std::size_t bytes() const;
  };
  std::string_view split_binary(const std::string& content);
  void parse(std::string_view text);
  void check_version() const;
  void check_type(const JsonTable& accessor, const Numbers& numbers, Use use) const;
  std::string_view buffer(std::size_t number, const std::string& who);
  std::string load_buffer(std::size_t number) const;
  Elements elements(const JsonTable& from, std::size_t view, std::size_t count, std::size_t bytes_each);
  void put_sparse(const JsonTable& accessor, std::size_t count, const Numbers& numbers, std::vector<double>& values);

  std::string path_;
  Allowance allowance_;
  nlohmann::json json_;
  std::string binary_;  ///< of a GLB
  bool has_binary_ = false;
  std::vector<JsonTable> accessors_;
  std::vector<JsonTable> views_;
  std::vector<JsonTable> buffers_;
  std::map<std::size_t, std::string> loaded_;
};

}  // namespace cchip::assembly

#endif
