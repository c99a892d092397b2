// SPDX-License-Identifier: Apache-2.0
#include <cchip/exact_oracle.hpp>
#include <cchip/resolve.hpp>

namespace cchip {

bool resolve(const Primitive& a, const Primitive& b, const EngineAnswer& answer) {
  return answer.definite ? answer.grid : exact_intersects(a, b);
}

}  // namespace cchip
