// SPDX-License-Identifier: Apache-2.0
/// \file
/// Configuration control of levels 1 to 3.
#ifndef CCHIP_LEVELS_C3_HPP
#define CCHIP_LEVELS_C3_HPP

#include <array>
#include <cchip/internal/wire/definitions.hpp>
#include <cchip/rc/rc.hpp>
#include <cstdint>

namespace cchip::levels {

/// The paper's custom configuration controller (C3): replaces the present test with the one that the API asks for.
class C3 {
 public:
  /// \param tests in the order of ModuleId from tri_tri on; added to the control, one may be active
  C3(rc::control& control, std::array<rc::context*, defs::kinds_max> tests);

  /// Returns when the test is active. Call it from a thread.
  void configure(ModuleId test);
  std::uint64_t swaps() const { return swaps_; }

 private:
  rc::control& control_;
  std::array<rc::context*, defs::kinds_max> tests_;
  std::uint64_t swaps_ = 0;
};

}  // namespace cchip::levels

#endif
