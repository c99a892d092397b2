// SPDX-License-Identifier: Apache-2.0
// Two closed modules share one reconfigurable region: docs/paper/tutorial-reconfigurable-module.md.
#include <cchip/rc/rc.hpp>
#include <iostream>

#include "closed_modules.hpp"
namespace rc = cchip::rc;

template <class M>
auto group_of(M& m) {  // step 2: the port group
  return rc::ports(m.in, m.out);
}

struct Top : sc_core::sc_module {
  sc_core::sc_fifo<int> to{"to"}, from{"from"};
  rc::reconfigurable<Doubler> doubler{"doubler"};  // step 1: derived, not changed
  rc::reconfigurable<Squarer> squarer{"squarer"};
  rc::bitfile_size doubler_bits{doubler, 400'000}, squarer_bits{squarer, 800'000};
  rc::portal_group<decltype(group_of(doubler))> portals{"portals", {"in", "out"}};
  rc::timed_control control{"control"};
  SC_CTOR(Top) {
    portals.bind_static(to, from);  // step 3: the place
    portals.bind_dynamic(group_of(doubler));
    portals.bind_dynamic(group_of(squarer));
    control.add(doubler + squarer);  // step 4: who moves them
    control.activate(doubler);
    SC_THREAD(run);
  }
  void ask(int x) {
    int y = 0;
    to.write(x);
    from.read(y);
    std::cout << sc_core::sc_time_stamp() << ": " << x << " -> " << y << std::endl;
  }
  void run() {
    ask(21);
    control.unload(doubler);  // step 5: at run time
    control.activate(squarer);
    ask(21);
    to.write(5);  // no process fetches the result
    try {
      control.unload(squarer);
    } catch (const rc::error& held) {
      std::cout << sc_core::sc_time_stamp() << ": " << held.what() << std::endl;
    }
  }
};

int sc_main(int, char**) {
  const Top top("top");
  sc_core::sc_start();
  return 0;
}
