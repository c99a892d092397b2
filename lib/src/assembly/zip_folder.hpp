// SPDX-License-Identifier: Apache-2.0
/// \file
/// Files in a zip archive.
#ifndef CCHIP_ASSEMBLY_ZIP_FOLDER_HPP
#define CCHIP_ASSEMBLY_ZIP_FOLDER_HPP

#include <memory>
#include <optional>
#include <string>

#include "placed_meshes.hpp"

struct zip;

namespace cchip::assembly {

class ZipFolder {
 public:
  /// \throws std::runtime_error one line: it cannot be read, or is no zip archive
  explicit ZipFolder(const std::string& path);

  /// The content of a file of it, by its path in the archive, in any case of letters; nothing if it is not there.
  /// \throws std::runtime_error it is broken, packed in a way that is not read, or takes more than the allowance
  std::optional<std::string> read(const std::string& name, Allowance& allowance) const;

 private:
  struct Discard {
    void operator()(zip* archive) const;
  };
  std::string path_;
  std::unique_ptr<zip, Discard> archive_;
};

}  // namespace cchip::assembly

#endif
