// SPDX-License-Identifier: Apache-2.0
#include <cchip/levels/c3.hpp>

namespace cchip::levels {

C3::C3(rc::control& control, std::array<rc::context*, defs::kinds_max> tests) : control_(control), tests_(tests) {
  for (rc::context* test : tests_) control_.add(*test);
}

void C3::configure(ModuleId test) {
  rc::context& wanted = *tests_.at(static_cast<std::size_t>(test) - 1);
  if (wanted.is_active()) return;
  for (rc::context* other : tests_) {
    if (other->now() != rc::state::unloaded) control_.unload(*other);
  }
  control_.activate(wanted);
  ++swaps_;
}

}  // namespace cchip::levels
