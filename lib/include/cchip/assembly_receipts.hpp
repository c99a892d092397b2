// SPDX-License-Identifier: Apache-2.0
/// \file
/// Receipts: verdicts about an assembly with their proofs, to be checked later and elsewhere. docs/cpp/clash.md
///
/// A folder of certificates (cchip/certificate.hpp), a file for each pair of parts that are not far apart, and
/// receipts.json, which names them. Link collisionchip::assembly.
#ifndef CCHIP_ASSEMBLY_RECEIPTS_HPP
#define CCHIP_ASSEMBLY_RECEIPTS_HPP

#include <cchip/assembly.hpp>
#include <cstddef>
#include <string>
#include <vector>

namespace cchip {

struct ReceiptOptions {
  unsigned threads = 0;  ///< 0: as many as there are cores; the files do not depend on it
  /// Directions that are tried for the proof that parts in touch share no volume, those of most contacts first.
  std::size_t most_normals = 100;
};

/// Proves the verdicts of a report and writes the receipts. A folder that holds receipts gets these in their place.
/// Takes far longer than check(): certify() for each pair that is not far apart.
/// \param report of check() for this assembly
/// \throws std::runtime_error the folder cannot be written, or holds something else than receipts
/// \throws std::invalid_argument as check()
void write_receipts(const Assembly& assembly, const AssemblyReport& report, const std::string& folder,
                    const ReceiptOptions& options = {});

/// What is known of a pair by its receipt.
enum class ReceiptState {
  proved,     ///< it is as its rule wants it
  violation,  ///< it is not
  unproved,   ///< the receipt is right, but neither follows from it
  missing,    ///< there is no receipt
  stale,      ///< it is of another mesh or pose
  refused     ///< its proof does not hold, or cannot be read
};
/// The name of the enumerator, such as "stale".
const char* name_of(ReceiptState state);

struct CheckedReceipt {
  std::size_t a = 0;  ///< numbers of parts, a < b
  std::size_t b = 0;
  ReceiptState state = ReceiptState::unproved;
  std::string text;  ///< what is proved, or why nothing is, with the names of the parts
};

struct ReceiptReport {
  /// Pairs that rules say something of, ascending, but for those `by_boxes`.
  std::vector<CheckedReceipt> pairs;
  std::size_t by_boxes = 0;  ///< pairs that need no receipt: the boxes around them are far enough apart
  std::size_t count(ReceiptState state) const;
};

/// Checks receipts against an assembly, as it is now, and its rules, without any search. Certificates are checked by
/// check_certificate(), sides of solids by rays, all in integers. Trusted are the readers of meshes and rules, which
/// rule counts for a pair, whether a mesh is closed, and boxes in floating point.
/// \throws std::runtime_error the folder holds no receipts; one line
/// \throws std::invalid_argument as check()
ReceiptReport verify_receipts(const Assembly& assembly, const std::string& folder, unsigned threads = 0);

}  // namespace cchip

#endif
