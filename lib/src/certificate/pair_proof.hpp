// SPDX-License-Identifier: Apache-2.0
/// \file
/// The relation of two hulls of a few points, with its proof.
#ifndef CCHIP_CERTIFICATE_PAIR_PROOF_HPP
#define CCHIP_CERTIFICATE_PAIR_PROOF_HPP

#include <cchip/check.hpp>
#include <optional>
#include <vector>

namespace cchip {

/// Cell that proves whether the hulls share a point (separated or meet), or what their relation is (separated, touch or
/// cross). Numbers of faces are left to the caller.
/// \pre 3 or 4 points each
CertificateCell prove_pair(const std::vector<certificate_check::Point>& a,
                           const std::vector<certificate_check::Point>& b, bool tell_crossing);

/// Cell that proves that the hulls share no point after a translation of B by any positive multiple of `along`, if so.
/// \pre along is not 0; else as above
std::optional<CertificateCell> prove_clear(const std::vector<certificate_check::Point>& a,
                                           const std::vector<certificate_check::Point>& b,
                                           const certificate_check::Point& along);

/// Cell that proves whether the hulls have points at most `within` apart, with `below` nearer than that (near), or not
/// (separated). `within` is in the unit of the points.
/// \pre within > 0; else as above
CertificateCell prove_distance(const std::vector<certificate_check::Point>& a,
                               const std::vector<certificate_check::Point>& b, const certificate_check::Int& within,
                               bool below);

}  // namespace cchip

#endif
