// SPDX-License-Identifier: Apache-2.0
/// \file
/// The relation of two hulls of a few points, with its proof.
#ifndef CCHIP_CERTIFICATE_PAIR_PROOF_HPP
#define CCHIP_CERTIFICATE_PAIR_PROOF_HPP

#include <cchip/check.hpp>
#include <vector>

namespace cchip {

/// Cell that proves whether the hulls share a point (separated or meet), or what their relation is (separated, touch or
/// cross). Numbers of faces are left to the caller.
/// \pre 3 or 4 points each
CertificateCell prove_pair(const std::vector<certificate_check::Point>& a,
                           const std::vector<certificate_check::Point>& b, bool tell_crossing);

}  // namespace cchip

#endif
