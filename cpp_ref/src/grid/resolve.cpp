// SPDX-License-Identifier: Apache-2.0
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/internal/grid/resolve.hpp>

namespace cchip {

bool resolve(const Primitive& a, const Primitive& b, const PairResult& result) {
  return result.definite ? result.grid : exact_intersects(a, b);
}

}  // namespace cchip
