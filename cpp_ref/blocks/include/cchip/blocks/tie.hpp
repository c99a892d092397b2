// SPDX-License-Identifier: Apache-2.0
/// \file
/// Equality of records.
#ifndef CCHIP_BLOCKS_TIE_HPP
#define CCHIP_BLOCKS_TIE_HPP

#include <tuple>
#include <utility>

namespace cchip::model {

/// Records that hand out all their fields by tie() are equal if these are.
template <class T, class = decltype(std::declval<const T&>().tie())>
bool operator==(const T& x, const T& y) {
  return x.tie() == y.tie();
}

}  // namespace cchip::model

#endif
