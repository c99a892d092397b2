// SPDX-License-Identifier: Apache-2.0
/// \file
/// A sample of the pairs of a campaign as queries whose answers prove themselves (docs/cpp/certificates.md).
#ifndef CCHIP_CAMPAIGN_CERTIFY_SAMPLE_HPP
#define CCHIP_CAMPAIGN_CERTIFY_SAMPLE_HPP

#include <algorithm>
#include <atomic>
#include <cchip/internal/wire/pair.hpp>
#include <cstdint>

namespace cchip::campaign {

class CertifySample {
 public:
  /// \param wanted pairs to certify among `pairs`, which are drawn in `parts` parts
  CertifySample(std::uint64_t wanted, std::uint64_t pairs, std::uint64_t parts)
      : wanted_(std::min(wanted, pairs)), parts_(parts) {}

  /// How many pairs of this part are certified: its first ones.
  std::uint64_t of_part(std::uint64_t part) const {
    const auto up_to = [this](std::uint64_t end) { return wanted_ / parts_ * end + wanted_ % parts_ * end / parts_; };
    return up_to(part + 1) - up_to(part);
  }
  /// The CPU device answers the pair as two meshes of one face, the answer is certified and the certificate checked;
  /// it must tell the relation that the exact predicates tell. Any thread. \returns whether all is well
  bool add(const GridPair& pair);

  std::uint64_t certified() const { return certified_; }
  std::uint64_t refused() const { return refused_; }

 private:
  std::uint64_t wanted_;
  std::uint64_t parts_;
  std::atomic<std::uint64_t> certified_ = 0;
  std::atomic<std::uint64_t> refused_ = 0;
};

}  // namespace cchip::campaign

#endif
