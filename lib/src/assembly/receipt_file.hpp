// SPDX-License-Identifier: Apache-2.0
/// \file
/// receipts.json, and which pairs need a receipt.
#ifndef CCHIP_ASSEMBLY_RECEIPT_FILE_HPP
#define CCHIP_ASSEMBLY_RECEIPT_FILE_HPP

#include <cchip/assembly.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rule_book.hpp"

namespace cchip::assembly {

struct Receipt {
  std::string a;  ///< names of parts
  std::string b;
  std::uint64_t mesh_a = 0;  ///< hashes, as those of a certificate
  std::uint64_t mesh_b = 0;
  std::uint64_t poses = 0;
  std::string file = {};                             ///< of the certificate, in the folder; empty: none
  std::optional<Vec3d> translation = std::nullopt;   ///< of the pose of B that the certificate is about; none: its own
  std::optional<Vec3d> common_point = std::nullopt;  ///< of the world, inside both
};
/// Without a proof.
Receipt receipt_of(const AssemblyPart& a, const AssemblyPart& b);

constexpr const char* receipt_index = "receipts.json";

/// \throws std::runtime_error it cannot be written
void write_receipt_index(const std::string& folder, const std::vector<Receipt>& receipts);
/// \throws std::runtime_error it cannot be read or makes no sense
std::vector<Receipt> read_receipt_index(const std::string& folder);

struct PairsToProve {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  ///< ascending
  std::size_t by_boxes = 0;                                ///< others that rules say something of
};
/// Pairs that rules say something of and whose boxes are not so far apart that it follows from these. Boxes are wider
/// than the parts by more than their rounding.
PairsToProve pairs_to_prove(const Assembly& assembly, const RuleBook& rules);

}  // namespace cchip::assembly

#endif
