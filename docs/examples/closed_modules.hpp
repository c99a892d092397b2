// SPDX-License-Identifier: Apache-2.0
// Two modules as they come from elsewhere: they will not be changed, and they know nothing of reconfiguration.
#ifndef CLOSED_MODULES_HPP
#define CLOSED_MODULES_HPP

#include <systemc>

struct Doubler : sc_core::sc_module {
  sc_core::sc_fifo_in<int> in{"in"};
  sc_core::sc_fifo_out<int> out{"out"};
  SC_CTOR(Doubler) { SC_THREAD(run); }
  void run() {
    for (;;) out.write(2 * in.read());
  }
};

struct Squarer : sc_core::sc_module {
  sc_core::sc_fifo_in<int> in{"in"};
  sc_core::sc_fifo_out<int> out{"out"};
  SC_CTOR(Squarer) { SC_THREAD(run); }
  void run() {
    for (;;) {
      const int x = in.read();
      out.write(x * x);
    }
  }
};

#endif
