// SPDX-License-Identifier: Apache-2.0
/// Small closed modules, bound to their channels directly or through portals, and their drivers.
#ifndef CCHIP_BENCH_RIGS_HPP
#define CCHIP_BENCH_RIGS_HPP

#include <array>
#include <cchip/rc/rc.hpp>
#include <cstdint>
#include <systemc>
#include <tuple>
#include <utility>

namespace cchip::bench {

/// Something to measure, in a process of the rig: transfers one after the other, as often as begin() is called.
class Rig : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(Rig);
  explicit Rig(const sc_core::sc_module_name& name) : sc_module(name) { SC_THREAD(drive); }
  /// What the next sc_start() does; `pause` between transfers, none if zero.
  void begin(std::uint64_t count, const sc_core::sc_time& pause) {
    count_ = count;
    pause_ = pause;
    deltas_ = 0;
    begin_.notify(sc_core::SC_ZERO_TIME);
  }
  /// From the beginnings of transfers to their answers, all of the run together.
  sc_dt::uint64 deltas_to_answers() const { return deltas_; }
  /// Answers that were wrong, and runs that have not ended.
  std::uint64_t faults() const { return faults_ + (running_ ? 1 : 0); }

 protected:
  /// Sends a value, waits for the answer. \returns whether it was right
  virtual bool transfer(int value) = 0;

 private:
  void drive() {
    for (;;) {
      wait(begin_);
      running_ = true;
      for (std::uint64_t i = 0; i < count_; ++i) {
        const sc_dt::uint64 start = sc_core::sc_delta_count();
        if (!transfer(++value_)) ++faults_;
        deltas_ += sc_core::sc_delta_count() - start;
        if (pause_ != sc_core::SC_ZERO_TIME) wait(pause_);
      }
      running_ = false;
    }
  }
  sc_core::sc_event begin_;
  std::uint64_t count_ = 0;
  sc_core::sc_time pause_;
  int value_ = 0;
  sc_dt::uint64 deltas_ = 0;
  std::uint64_t faults_ = 0;
  bool running_ = false;
};

// ---- closed modules: they do as little as possible, so that the channels are what is measured

/// out = in + 1
struct SignalModule : sc_core::sc_module {
  sc_core::sc_in<int> in{"in"};
  sc_core::sc_out<int> out{"out"};
  SC_HAS_PROCESS(SignalModule);
  explicit SignalModule(const sc_core::sc_module_name& name) : sc_module(name) {
    SC_METHOD(step);
    sensitive << in;
    dont_initialize();
  }
  void step() { out.write(in.read() + 1); }
};

/// out = in + 1 at each rising edge
struct ClockedModule : sc_core::sc_module {
  sc_core::sc_in<bool> clk{"clk"};
  sc_core::sc_in<int> in{"in"};
  sc_core::sc_out<int> out{"out"};
  SC_HAS_PROCESS(ClockedModule);
  explicit ClockedModule(const sc_core::sc_module_name& name) : sc_module(name) {
    SC_METHOD(step);
    sensitive << clk.pos();
    dont_initialize();
  }
  void step() { out.write(in.read() + 1); }
};

/// Each item + 1
struct FifoModule : sc_core::sc_module {
  sc_core::sc_fifo_in<int> in{"in"};
  sc_core::sc_fifo_out<int> out{"out"};
  SC_HAS_PROCESS(FifoModule);
  explicit FifoModule(const sc_core::sc_module_name& name) : sc_module(name) { SC_THREAD(step); }
  void step() {
    for (;;) out.write(in.read() + 1);
  }
};

/// As many pins as a primitive test has: out[i] = in[i] + 1
struct WideModule : sc_core::sc_module {
  static constexpr std::size_t width = 16;
  sc_core::sc_vector<sc_core::sc_in<int>> in{"in", width};
  sc_core::sc_vector<sc_core::sc_out<int>> out{"out", width};
  SC_HAS_PROCESS(WideModule);
  explicit WideModule(const sc_core::sc_module_name& name) : sc_module(name) {
    SC_METHOD(step);
    for (auto& port : in) sensitive << port;
    dont_initialize();
  }
  void step() {
    for (std::size_t i = 0; i < width; ++i) out[i].write(in[i].read() + 1);
  }
};

inline auto ports_of(SignalModule& m) { return rc::ports(m.in, m.out); }
inline auto ports_of(ClockedModule& m) { return rc::ports(m.clk, m.in, m.out); }
inline auto ports_of(FifoModule& m) { return rc::ports(m.in, m.out); }
template <std::size_t... I>
auto wide_ports(WideModule& m, std::index_sequence<I...>) {
  return rc::ports(m.in[I]..., m.out[I]...);
}
inline auto ports_of(WideModule& m) { return wide_ports(m, std::make_index_sequence<WideModule::width>()); }
template <class M>
using PortsOf = decltype(ports_of(std::declval<M&>()));

// ---- how a module M meets its channels

template <class M>
class Direct : public sc_core::sc_module {
 public:
  explicit Direct(const sc_core::sc_module_name& name) : sc_module(name) {}
  template <class... Channel>
  void bind(Channel&... channel) {
    std::apply([&](auto&... port) { (port.bind(channel), ...); }, ports_of(module_));
  }

 private:
  M module_{"module"};
};

template <class M>
class ThroughPortals : public sc_core::sc_module {
 public:
  explicit ThroughPortals(const sc_core::sc_module_name& name) : sc_module(name) {
    portals_.bind_dynamic(ports_of(module_));
    control_.add(module_);
    control_.activate(module_);
  }
  template <class... Channel>
  void bind(Channel&... channel) {
    portals_.bind_static(channel...);
  }

 private:
  rc::reconfigurable<M> module_{"module"};
  rc::portal_group<PortsOf<M>> portals_{"portals"};
  rc::control control_{"control"};
};

// ---- transfers

/// A value to the module and its answer back, signals, nothing else going on.
template <template <class> class Binding>
class SignalRig : public Rig {
 public:
  explicit SignalRig(const sc_core::sc_module_name& name) : Rig(name) { module_.bind(in_, out_); }

 private:
  bool transfer(int value) override {
    in_.write(value);
    wait(out_.value_changed_event());
    return out_.read() == value + 1;
  }
  sc_core::sc_signal<int> in_, out_;
  Binding<SignalModule> module_{"module"};
};

/// A clock period: rising edge with a new value, answer, falling edge.
template <template <class> class Binding>
class ClockedRig : public Rig {
 public:
  explicit ClockedRig(const sc_core::sc_module_name& name) : Rig(name) { module_.bind(clk_, in_, out_); }

 private:
  bool transfer(int value) override {
    in_.write(value);
    clk_.write(true);
    wait(out_.value_changed_event());
    clk_.write(false);
    wait(clk_.value_changed_event());
    return out_.read() == value + 1;
  }
  sc_core::sc_signal<bool> clk_;
  sc_core::sc_signal<int> in_, out_;
  Binding<ClockedModule> module_{"module"};
};

/// An item to the module and its answer back by FIFOs.
template <template <class> class Binding>
class FifoRig : public Rig {
 public:
  explicit FifoRig(const sc_core::sc_module_name& name) : Rig(name) { module_.bind(in_, out_); }

 private:
  bool transfer(int value) override {
    in_.write(value);
    int answer = 0;
    out_.read(answer);
    return answer == value + 1;
  }
  sc_core::sc_fifo<int> in_, out_;
  Binding<FifoModule> module_{"module"};
};

// ---- exchanges

/// Two modules alternate behind the same portals; a value and its answer after each exchange prove that the new one
/// works.
template <class M>
class SwapRig : public Rig {
 protected:
  explicit SwapRig(const sc_core::sc_module_name& name) : Rig(name) {
    for (auto* module : {&first_, &second_}) {
      portals_.bind_dynamic(ports_of(*module));
      control_.add(*module);
    }
    control_.activate(*active_);
  }
  virtual bool ask(int value) = 0;
  rc::portal_group<PortsOf<M>>& portals() { return portals_; }

 private:
  bool transfer(int value) override {
    std::swap(active_, other_);
    control_.unload(*other_);
    control_.activate(*active_);
    return ask(value);
  }
  rc::reconfigurable<M> first_{"first"}, second_{"second"};
  rc::context *active_ = &first_, *other_ = &second_;
  rc::portal_group<PortsOf<M>> portals_{"portals"};
  rc::control control_{"control"};
};

class FifoSwapRig : public SwapRig<FifoModule> {
 public:
  explicit FifoSwapRig(const sc_core::sc_module_name& name) : SwapRig(name) { portals().bind_static(in_, out_); }

 private:
  bool ask(int value) override {
    in_.write(value);
    int answer = 0;
    out_.read(answer);
    return answer == value + 1;
  }
  sc_core::sc_fifo<int> in_, out_;
};

class WideSwapRig : public SwapRig<WideModule> {
 public:
  explicit WideSwapRig(const sc_core::sc_module_name& name) : SwapRig(name) {
    bind(std::make_index_sequence<WideModule::width>());
  }

 private:
  template <std::size_t... I>
  void bind(std::index_sequence<I...>) {
    portals().bind_static(in_[I]..., out_[I]...);
  }
  bool ask(int value) override {
    for (auto& signal : in_) signal.write(value);
    while (out_[0].read() != value + 1) wait(out_[0].value_changed_event());
    return out_[WideModule::width - 1].read() == value + 1;
  }
  std::array<sc_core::sc_signal<int>, WideModule::width> in_, out_;
};

}  // namespace cchip::bench

#endif  // CCHIP_BENCH_RIGS_HPP
