// SPDX-License-Identifier: Apache-2.0
// FIFO portals: both rules, transactions, filters.
#include "rc_fixture.hpp"

using namespace rc_test;
using Catch::Contains;
using Catch::Equals;
using rc::fifo_rule;
using rc::state;

namespace {

/// Two adders between one pair of FIFOs.
template <class M = Adder>
struct System {
  sc_core::sc_fifo<int> a{"a", 4}, b{"b", 2};
  rc::reconfigurable<M> m{"m", 10}, other{"other", 20};
  AdderGroup portals{"portals", {"in", "out"}};
  rc::control control{"control"};
  System() {
    portals.bind_static(a, b);
    portals.bind_dynamic(group_of(m));
    portals.bind_dynamic(group_of(other));
    control.add(m + other);
  }
  void set_rule(fifo_rule rule) {
    portals.at<0>().set_rule(rule);
    portals.at<1>().set_rule(rule);
  }
};

/// An adder without a process.
struct Idle : sc_core::sc_module {
  sc_core::sc_fifo_in<int> in{"in"};
  sc_core::sc_fifo_out<int> out{"out"};
  Idle(const sc_core::sc_module_name&, int) {}
};
auto group_of(Idle& m) { return rc::ports(m.in, m.out); }

/// Takes 10 ns from operand to result.
struct Slow : sc_core::sc_module {
  sc_core::sc_fifo_in<int> in{"in"};
  sc_core::sc_fifo_out<int> out{"out"};
  const int k;
  SC_HAS_PROCESS(Slow);
  Slow(const sc_core::sc_module_name&, int addend) : k(addend) { SC_THREAD(run); }
  void run() {
    for (;;) {
      const int value = in.read();
      wait(ns(10));
      out.write(value + k);
    }
  }
};
auto group_of(Slow& m) { return rc::ports(m.in, m.out); }

}  // namespace

TEST_CASE("a FIFO that is not empty holds the module: items not read", "[rc][fifo]") {
  System<Idle> s;
  s.control.activate(s.m);
  s.control.set_deactivation_timeout(ns(30));
  simulate([&] {
    s.a.write(1);
    s.a.write(2);
    CHECK_THAT(error_of([&] { s.control.deactivate(s.m); }), Contains("held by portals.in: 2 item(s) not read"));
    sc_core::sc_spawn([&] {
      wait(ns(5));
      CHECK(s.m.in.read() == 1);
      wait(ns(5));
      CHECK(s.m.in.read() == 2);
    });
    s.control.deactivate(s.m);
    CHECK(sc_time_stamp() == ns(40));
  });
}

TEST_CASE("a FIFO that is not empty holds the module: results not fetched", "[rc][fifo]") {
  System<> s;
  s.control.activate(s.m);
  s.control.set_deactivation_timeout(ns(30));
  simulate([&] {
    s.a.write(1);
    CHECK_THAT(error_of([&] { s.control.deactivate(s.m); }),
               Contains("held by portals.out: result(s) not fetched by the static side"));
    sc_core::sc_spawn([&] {
      wait(ns(5));
      CHECK(s.b.read() == 11);
    });
    s.control.deactivate(s.m);
    CHECK(sc_time_stamp() == ns(35));
  });
}

TEST_CASE("an item written in the evaluation phase in which deactivation is asked for holds the module", "[rc][fifo]") {
  System<> s;
  s.control.activate(s.m);
  simulate([&] {
    sc_core::sc_spawn([&] {
      wait(ns(5));
      CHECK(s.b.read() == 11);
      CHECK(s.b.read() == 12);
    });
    wait(ns(1));
    s.a.write(1);
    s.a.write(2);
    s.control.deactivate(s.m);
    CHECK(sc_time_stamp() == ns(5));
    CHECK(s.a.num_available() == 0);
    CHECK(s.b.num_available() == 0);
  });
}

TEST_CASE("empty FIFOs hold nothing", "[rc][fifo]") {
  System<> s;
  s.control.activate(s.m);
  simulate([&] {
    for (int i = 0; i < 5; ++i) {
      s.a.write(i);
      CHECK(s.b.read() == i + 10);
    }
    s.control.unload(s.m);
    CHECK(sc_time_stamp() == SC_ZERO_TIME);
    s.control.activate(s.other);
    s.a.write(7);
    CHECK(s.b.read() == 27);
  });
}

TEST_CASE("rule of transfers: data stay in the FIFO for the next module", "[rc][fifo]") {
  System<> s;
  s.set_rule(fifo_rule::transfers);
  s.control.activate(s.m);
  simulate([&] {
    for (int i = 1; i <= 5; ++i) s.a.write(i);
    deltas(4);
    CHECK(s.b.num_available() == 2);  // full: m has taken 1, 2, 3 and waits with a result
    s.control.unload(s.m);
    CHECK(s.b.read() == 11);
    CHECK(s.b.read() == 12);
    deltas(3);
    CHECK(s.b.num_available() == 0);
    CHECK(s.a.num_available() == 2);
    s.control.activate(s.other);
    CHECK(s.b.read() == 24);
    CHECK(s.b.read() == 25);
    deltas(2);
    s.control.unload(s.other);
    s.control.activate(s.m);
    CHECK(s.b.read() == 13);  // the blocked call continues
  });
}

TEST_CASE("a blocking call into a closed portal waits for the activation and then continues", "[rc][fifo]") {
  System<Idle> s;
  Thread reader("reader", [&] {
    CHECK(s.m.in.read() == 5);
    CHECK(sc_time_stamp() == ns(20));
    wait(ns(1));
    s.m.out.write(6);
    CHECK(sc_time_stamp() == ns(30));
  });
  simulate([&] {
    s.a.write(5);
    wait(ns(20));
    s.control.activate(s.m);
    deltas(2);
    s.control.deactivate(s.m);
    wait(ns(10));
    CHECK(s.b.num_available() == 0);
    s.control.activate(s.m);
    CHECK(s.b.read() == 6);
    deltas(2);
    CHECK(reader.done());
  });
}

TEST_CASE("a module that waits at an empty input can leave, and finds what came meanwhile", "[rc][fifo]") {
  System<Idle> s;
  Thread reader("reader", [&] {
    CHECK(s.m.in.read() == 5);
    CHECK(sc_time_stamp() == ns(20));
  });
  s.control.activate(s.m);
  simulate([&] {
    wait(ns(10));
    s.control.deactivate(s.m);
    s.a.write(5);
    wait(ns(10));
    CHECK_FALSE(reader.done());
    s.control.activate(s.m);
    deltas(2);
    CHECK(reader.done());
  });
}

TEST_CASE("a module that waits at a full output can leave, and continues later", "[rc][fifo]") {
  System<Idle> s;
  s.set_rule(fifo_rule::transfers);
  Thread writer("writer", [&] {
    for (int i = 1; i <= 3; ++i) s.m.out.write(i);
    CHECK(sc_time_stamp() == ns(20));
  });
  s.control.activate(s.m);
  simulate([&] {
    wait(ns(10));
    s.control.deactivate(s.m);
    CHECK(s.b.read() == 1);
    wait(ns(10));
    CHECK_FALSE(writer.done());
    s.control.activate(s.m);
    CHECK(s.b.read() == 2);
    CHECK(s.b.read() == 3);
    CHECK(writer.done());
  });
}

TEST_CASE("a module that is moved while it waits at a FIFO continues at the new one", "[rc][fifo]") {
  System<Idle> s;
  sc_core::sc_fifo<int> c("c"), d("d");
  AdderGroup elsewhere("elsewhere");
  elsewhere.bind_static(c, d);
  s.control.activate(s.m);
  std::vector<int> seen;
  Thread reader("reader", [&] {
    for (;;) seen.push_back(s.m.in.read());
  });
  simulate([&] {
    wait(ns(1));
    s.control.move(s.m, elsewhere);
    s.a.write(1);
    s.control.activate(s.m);
    for (int i = 2; i < 5; ++i) {
      wait(ns(1));
      c.write(i);
    }
    wait(ns(1));
    CHECK(seen == std::vector<int>{2, 3, 4});
    CHECK(s.a.num_available() == 1);
  });
}

TEST_CASE("non-blocking calls into a closed portal fail and counts are 0", "[rc][fifo]") {
  System<Idle> s;
  simulate([&] {
    s.a.write(5);
    deltas(2);
    int value = 0;
    CHECK(s.m.in.num_available() == 0);
    CHECK_FALSE(s.m.in.nb_read(value));
    CHECK(s.m.out.num_free() == 0);
    CHECK_FALSE(s.m.out.nb_write(1));
    s.control.activate(s.m);
    CHECK(s.m.in.num_available() == 1);
    CHECK(s.m.in.nb_read(value));
    CHECK(value == 5);
    CHECK(s.m.out.num_free() == 2);
    CHECK(s.m.out.nb_write(1));
    CHECK(s.other.in.num_available() == 0);
  });
}

TEST_CASE("opening a FIFO portal gives an event if there are data or room", "[rc][fifo]") {
  System<Idle> s;
  int written = 0, read = 0;
  Thread data("data", [&] {
    for (;;) {
      wait(s.m.in.data_written_event());
      ++written;
    }
  });
  Thread room("room", [&] {
    for (;;) {
      wait(s.m.out.data_read_event());
      ++read;
    }
  });
  s.set_rule(fifo_rule::transfers);
  simulate([&] {
    s.control.activate(s.m);
    deltas(2);
    CHECK(written == 0);
    CHECK(read == 1);
    s.control.deactivate(s.m);
    s.a.write(1);
    s.b.write(1);
    s.b.write(1);
    deltas(2);
    CHECK(written == 0);
    s.control.activate(s.m);
    deltas(2);
    CHECK(written == 1);
    CHECK(read == 1);
    CHECK(s.b.read() == 1);
    deltas(2);
    CHECK(read == 2);
  });
}

namespace {

/// Deltas in which `count` items pass three adders in a row, and those until the first result comes out.
struct Passage {
  sc_dt::uint64 first, all;
  bool operator==(const Passage& o) const { return first == o.first && all == o.all; }
};
std::ostream& operator<<(std::ostream& out, const Passage& p) { return out << p.first << " of " << p.all; }

Passage pass(sc_core::sc_fifo<int>& in, sc_core::sc_fifo<int>& out, int count) {
  wait(ns(1));
  const auto start = sc_delta_count();
  sc_core::sc_spawn([&in, count] {
    for (int i = 0; i < count; ++i) in.write(i);
  });
  Passage result{};
  for (int i = 0; i < count; ++i) {
    CHECK(out.read() == i + 111);
    if (i == 0) result.first = sc_delta_count() - start;
  }
  wait(ns(1));
  result.all = sc_delta_count() - start;
  return result;
}

Passage pass_directly(int count) {
  const OwnContext context;
  Passage result{};
  sc_core::sc_fifo<int> a("a", 3), b("b", 2), c("c", 4), d("d", 1);
  Adder m1("m1", 100), m2("m2", 10), m3("m3", 1);
  m1.in(a), m1.out(b), m2.in(b), m2.out(c), m3.in(c), m3.out(d);
  simulate([&] { result = pass(a, d, count); });
  return result;
}

}  // namespace

TEST_CASE("FIFO portals add no delta to a chain of modules", "[rc][fifo]") {
  const int count = GENERATE(1, 2, 50);
  const Passage expected = pass_directly(count);
  const OwnContext context;
  sc_core::sc_fifo<int> a("a", 3), b("b", 2), c("c", 4), d("d", 1);
  rc::reconfigurable<Adder> m1("m1", 100), m2("m2", 10), m3("m3", 1);
  AdderGroup g1("g1"), g2("g2"), g3("g3");
  g1.bind_static(a, b), g2.bind_static(b, c), g3.bind_static(c, d);
  g1.bind_dynamic(group_of(m1)), g2.bind_dynamic(group_of(m2)), g3.bind_dynamic(group_of(m3));
  rc::control control("control");
  control.add(m1 + m2 + m3);
  control.activate(m1 + m2 + m3);
  simulate([&] { CHECK(pass(a, d, count) == expected); });
}

// ---- transactions

TEST_CASE("an open transaction holds its module", "[rc][transaction]") {
  System<Idle> s;
  s.control.activate(s.m);
  s.control.set_deactivation_timeout(ns(100));
  simulate([&] {
    sc_core::sc_spawn([&] {
      {
        rc::transaction outer(s.m, "block");
        {
          rc::transaction inner(s.m, "word");
          wait(ns(150));
        }
        wait(ns(40));
      }
    });
    deltas(1);
    CHECK_THAT(error_of([&] { s.control.deactivate(s.m); }), Contains("held by transaction block; transaction word;"));
    CHECK(sc_time_stamp() == ns(100));
    s.control.deactivate(s.m);
    CHECK(sc_time_stamp() == ns(190));
  });
}

TEST_CASE("a transaction counter may be negative, the module is held unless it is 0", "[rc][transaction]") {
  System<Idle> s;
  rc::transaction_counter owed("results owed");
  s.m.add(owed);
  s.control.activate(s.m);
  s.control.set_deactivation_timeout(ns(10));
  simulate([&] {
    owed.add(-2);
    CHECK(owed.count() == -2);
    CHECK_THAT(error_of([&] { s.control.deactivate(s.m); }), Contains("held by results owed: -2 transaction(s);"));
    owed.add(3);
    CHECK_THAT(error_of([&] { s.control.deactivate(s.m); }), Contains("results owed: 1"));
    sc_core::sc_spawn([&] {
      wait(ns(3));
      owed.add(-1);
    });
    s.control.deactivate(s.m);
    CHECK(sc_time_stamp() == ns(23));
    s.m.remove(owed);
    s.control.activate(s.m);
    owed.add(1);
    s.control.deactivate(s.m);
    CHECK(sc_time_stamp() == ns(23));
  });
}

TEST_CASE("a module that has read but not yet written is lost without a count, and held with one",
          "[rc][transaction]") {
  const bool counted = GENERATE(false, true);
  const OwnContext context;
  rc::transaction_counter owed("results owed");
  System<Slow> s;
  if (counted) {
    s.portals.at<0>().count(owed, +1);
    s.portals.at<1>().count(owed, -1);
  }
  s.set_rule(fifo_rule::transfers);
  s.control.activate(s.m);
  simulate([&] {
    for (int i = 0; i < 3; ++i) s.a.write(i);
    wait(ns(5));
    s.control.unload(s.m);
    CHECK(sc_time_stamp() == ns(counted ? 10 : 5));
    CHECK(s.a.num_available() == 2);
    s.control.activate(s.other);
    std::vector<int> results;
    sc_core::sc_spawn([&] {
      for (;;) results.push_back(s.b.read());
    });
    wait(ns(100));
    CHECK(results == (counted ? std::vector<int>{10, 21, 22} : std::vector<int>{21, 22}));
  });
}

TEST_CASE("before a counted read the module leaves if it shall and can", "[rc][transaction]") {
  rc::transaction_counter owed("results owed");
  System<> s;  // never pauses between a result and the next operand
  s.set_rule(fifo_rule::transfers);
  s.portals.at<0>().count(owed, +1);
  s.portals.at<1>().count(owed, -1);
  s.control.activate(s.m);
  int fed = 0;
  Thread feeder("feeder", [&] {
    for (;; ++fed) s.a.write(0);
  });
  std::vector<int> results;
  Thread drain("drain", [&] {
    for (;;) results.push_back(s.b.read());
  });
  simulate([&] {
    deltas(50);
    CHECK(results.size() > 10);
    s.control.unload(s.m);  // halfway through it
    CHECK(owed.count() == 0);
    deltas(5);
    const auto count = results.size();
    deltas(20);
    CHECK(results.size() == count);
    CHECK(static_cast<std::size_t>(fed) == count + 4);  // the FIFO is full, nothing is lost
    s.control.activate(s.other);
    deltas(20);
    CHECK(results.size() > count);
    CHECK(results[count - 1] == 10);
    CHECK(results[count] == 20);
  });
}

TEST_CASE("a limit of reads and writes holds for each activation", "[rc][transaction]") {
  System<Idle> s;
  s.set_rule(fifo_rule::empty);
  s.portals.at<0>().set_limit(2);
  s.portals.at<1>().set_limit(1);
  s.control.activate(s.m);
  int events = 0;
  Thread watch("watch", [&] {
    for (;;) {
      wait(s.m.in.data_written_event());
      ++events;
    }
  });
  simulate([&] {
    for (int i = 0; i < 4; ++i) s.a.write(i);
    deltas(2);
    CHECK(s.m.in.num_available() == 4);
    CHECK(s.m.in.read() == 0);
    CHECK(s.m.in.read() == 1);
    CHECK(s.m.in.num_available() == 0);
    int value = 0;
    CHECK_FALSE(s.m.in.nb_read(value));
    const int before = events;
    s.a.write(4);
    deltas(2);
    CHECK(events == before);
    CHECK(s.m.out.nb_write(1));
    CHECK(s.m.out.num_free() == 0);
    CHECK_FALSE(s.m.out.nb_write(2));
    CHECK(s.b.read() == 1);
    s.control.deactivate(s.m);  // what it may not read does not hold it
    s.control.activate(s.m);
    deltas(2);
    CHECK(events == before + 1);
    CHECK(s.m.in.num_available() == 3);
    CHECK(s.m.in.read() == 2);
    CHECK(s.m.out.num_free() == 2);
  });
}
