// SPDX-License-Identifier: Apache-2.0
// One module at a portal, exchanged for another.
#include <cchip/rc/rc.hpp>
#include <iostream>

namespace rc = cchip::rc;

struct Adder : sc_core::sc_module {
  sc_core::sc_in<int> d{"d"};
  sc_core::sc_out<int> q{"q"};
  const int k;
  SC_HAS_PROCESS(Adder);
  Adder(const sc_core::sc_module_name&, int addend) : k(addend) {
    SC_METHOD(step);
    sensitive << d;
  }
  void step() { q.write(d.read() + k); }
};

struct Top : sc_core::sc_module {
  sc_core::sc_signal<int> d{"d"}, q{"q"};
  rc::reconfigurable<Adder> one{"one", 1}, two{"two", 2};
  rc::in_portal<int> in{"in"};
  rc::out_portal<int> out{"out"};
  rc::control control{"control"};
  SC_HAS_PROCESS(Top);
  explicit Top(const sc_core::sc_module_name&) {
    in.static_port(d);
    out.static_port(q);
    for (Adder* m : {static_cast<Adder*>(&one), static_cast<Adder*>(&two)}) {
      in.bind_dynamic(m->d);
      out.bind_dynamic(m->q);
    }
    control.add(one + two);
    control.activate(one);
    SC_THREAD(run);
  }
  void run() {
    d.write(40);
    wait(1, sc_core::SC_NS);
    std::cout << q.read() << std::endl;
    control.unload(one);
    control.activate(two);
    wait(1, sc_core::SC_NS);
    std::cout << q.read() << std::endl;
  }
};

int sc_main(int, char**) {
  const Top top("top");
  sc_core::sc_start();
  return 0;
}
