// SPDX-License-Identifier: Apache-2.0
/// \file
/// A control whose loads take as long as the bitstream needs to pass the configuration port (paper 3.2).
#ifndef CCHIP_RC_TIMED_CONTROL_HPP
#define CCHIP_RC_TIMED_CONTROL_HPP

#include <cchip/rc/bitstream_timing.hpp>
#include <cchip/rc/control.hpp>

namespace cchip::rc {

/// Time of an action: the delay that context::delay() gives (0 unless set), plus, for a load, the time by eq. (4) for a
/// module that has a bitfile_size.
class timed_control : public control {
 public:
  explicit timed_control(const sc_core::sc_module_name& name, const bitstream_timing& timing = bitstream_timing())
      : control(name), timing_(timing) {}

  const bitstream_timing& timing() const { return timing_; }
  sc_core::sc_time takes_time(const context& module, action a) const override {
    const sc_core::sc_time computed =
        a == action::load ? timing_.configuration(module.module()) : sc_core::SC_ZERO_TIME;
    return module.delay(a) + computed;
  }

 private:
  bitstream_timing timing_;
};

}  // namespace cchip::rc

#endif
