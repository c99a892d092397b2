// SPDX-License-Identifier: Apache-2.0
/// \file
/// Portals for sc_in, sc_out and sc_inout. They add no delta cycle: a change of the static signal reaches the module's
/// processes in the evaluation phase that follows it, a write of the module reaches the static signal in the evaluation
/// phase in which it is made.
///
/// While the portal is closed, the module reads an undefined value and sees no event; the static side gets an undefined
/// value or keeps the last one. What the module writes meanwhile takes effect when the portal opens, because that is
/// what its pins show then. On opening, the module sees one event of each input, an edge for bool and sc_logic, too.
#ifndef CCHIP_RC_SIGNAL_PORTAL_HPP
#define CCHIP_RC_SIGNAL_PORTAL_HPP

#include <cchip/rc/portal.hpp>
#include <functional>
#include <systemc>
#include <type_traits>
#include <utility>

namespace cchip::rc {

/// Value that represents an undefined one: T() for plain types; specialise it for others.
template <class T>
struct undefined_value {
  static T get() { return T(); }
};
template <>
struct undefined_value<sc_dt::sc_logic> {
  static sc_dt::sc_logic get() { return sc_dt::SC_LOGIC_Z; }
};
template <int W>
struct undefined_value<sc_dt::sc_lv<W>> {
  static sc_dt::sc_lv<W> get() { return sc_dt::sc_lv<W>(sc_dt::SC_LOGIC_Z); }
};

namespace detail {

template <class T>
constexpr bool has_edges = std::is_same_v<T, bool> || std::is_same_v<T, sc_dt::sc_logic>;
inline bool is_high(bool value) { return value; }
inline bool is_high(const sc_dt::sc_logic& value) { return value == sc_dt::SC_LOGIC_1; }
inline bool is_low(bool value) { return !value; }
inline bool is_low(const sc_dt::sc_logic& value) { return value == sc_dt::SC_LOGIC_0; }

/// The events of a signal as its module sees them.
template <class T>
struct signal_events {
  sc_core::sc_event changed;
  sc_core::sc_event positive;
  sc_core::sc_event negative;

  void notify(const T& value) {
    changed.notify();
    if constexpr (has_edges<T>) {
      if (is_high(value)) positive.notify();
      if (is_low(value)) negative.notify();
    }
  }
};

}  // namespace detail

/// What accessors need of the portal of a signal.
template <class T>
class signal_portal : public following_portal {
 public:
  /// What a closed portal shows to the module, T() or 'Z' at first.
  void set_undefined_input(const T& value) { undefined_input_ = value; }

  const T& undefined_input() const { return undefined_input_; }

  // for its accessors
  virtual const sc_core::sc_signal_in_if<T>& channel() const = 0;
  /// The module writes: now, or in the next delta if it did so while the portal was closed.
  virtual void request_write(const T&) {}
  virtual void request_write_later(const T&) {}
  virtual void request_undefined() {}
  virtual sc_core::sc_writer_policy writer_policy() const { return sc_core::SC_ONE_WRITER; }
  const sc_core::sc_event& static_event(edge e) const override {
    if constexpr (detail::has_edges<T>) {
      if (e == edge::rise) return channel().posedge_event();
      if (e == edge::fall) return channel().negedge_event();
    }
    return channel().value_changed_event();
  }

 protected:
  using following_portal::following_portal;

 private:
  T undefined_input_ = undefined_value<T>::get();
};

/// The interface IF of a static signal as one module sees it.
template <class T, class IF>
class signal_accessor : public accessor_of<signal_portal<T>>, public IF {
 public:
  signal_accessor(context& owner, signal_portal<T>& at, const std::string& port_name)
      : accessor_of<signal_portal<T>>(owner, at, port_name) {}

  const sc_core::sc_event& default_event() const override { return value_changed_event(); }
  const sc_core::sc_event& value_changed_event() const override { return watched(events_.changed, edge::any); }
  const T& read() const override {
    return this->is_open() ? this->typed_portal().channel().read() : this->typed_portal().undefined_input();
  }
  const T& get_data_ref() const override { return read(); }
  bool event() const override {
    return this->is_open() && (this->typed_portal().channel().event() || followed_at_ == sc_core::sc_delta_count());
  }

 protected:
  const sc_core::sc_event& watched(const sc_core::sc_event& event, edge e) const {
    this->watch(e);
    return event;
  }
  const detail::signal_events<T>& events() const { return events_; }

  void opened() override { this->typed_portal().refresh(); }
  /// Also runs after the opening.
  void follow() override {
    followed_at_ = sc_core::sc_delta_count();
    events_.notify(read());
  }

 private:
  detail::signal_events<T> events_;
  sc_dt::uint64 followed_at_ = ~sc_dt::uint64{0};
};

/// The same with edges, for bool and sc_logic.
template <class T, class IF, bool Edges = detail::has_edges<T>>
class edge_accessor : public signal_accessor<T, IF> {
 public:
  using signal_accessor<T, IF>::signal_accessor;
};
template <class T, class IF>
class edge_accessor<T, IF, true> : public signal_accessor<T, IF> {
 public:
  using signal_accessor<T, IF>::signal_accessor;
  const sc_core::sc_event& posedge_event() const override { return this->watched(this->events().positive, edge::rise); }
  const sc_core::sc_event& negedge_event() const override { return this->watched(this->events().negative, edge::fall); }
  bool posedge() const override { return this->event() && detail::is_high(this->read()); }
  bool negedge() const override { return this->event() && detail::is_low(this->read()); }
};

template <class T, class IF>
class input_accessor : public edge_accessor<T, IF> {
 public:
  using edge_accessor<T, IF>::edge_accessor;
};

/// Inputs of type bool are signals of the kernel as well, so that reset_signal_is() of the module works on them.
using bool_signal = sc_core::sc_signal<bool, sc_core::SC_MANY_WRITERS>;
template <>
class input_accessor<bool, sc_core::sc_signal_in_if<bool>> : public edge_accessor<bool, bool_signal> {
 public:
  using edge_accessor::edge_accessor;

 protected:
  void started() override {
    if (m_reset_p != nullptr) watch();
  }
  void follow() override {
    m_new_val = read();
    bool_signal::update();
    edge_accessor::follow();
  }
};

/// What a module shows at an output; it appears at the static side while the portal is open.
template <class T, class IF>
class driving_accessor : public edge_accessor<T, IF> {
 public:
  using edge_accessor<T, IF>::edge_accessor;

 protected:
  void show(const T& value) {
    value_ = value;
    written_ = true;
    if (this->is_open()) this->typed_portal().request_write(value_);
  }
  void opened() override {
    edge_accessor<T, IF>::opened();
    if (written_) this->typed_portal().request_write_later(value_);
  }
  void closed() override { this->typed_portal().request_undefined(); }

 private:
  T value_{};
  bool written_ = false;
};

template <class T>
class output_accessor : public driving_accessor<T, sc_core::sc_signal_inout_if<T>> {
 public:
  using driving_accessor<T, sc_core::sc_signal_inout_if<T>>::driving_accessor;
  sc_core::sc_writer_policy get_writer_policy() const override { return this->typed_portal().writer_policy(); }
  void write(const T& value) override {
    if (get_writer_policy() == sc_core::SC_ONE_WRITER) check_writer();
    this->show(value);
  }

 private:
  /// As in sc_signal: one process of a module writes. One that has ended may be followed by another.
  void check_writer() {
    const sc_core::sc_process_handle writer = sc_core::sc_get_current_process_handle();
    if (!writer.valid() || writer == writer_) return;
    if (writer_.valid() && !writer_.terminated()) {
      SC_REPORT_ERROR(sc_core::SC_ID_MORE_THAN_ONE_SIGNAL_DRIVER_,
                      (this->port_name() + " is written by " + writer_.name() + " and by " + writer.name()).c_str());
    }
    writer_ = writer;
  }

  sc_core::sc_process_handle writer_;
};

/// From the static signal to the active module.
template <class T, class Port, class Accessor>
class sensing_portal : public signal_portal<T> {
 public:
  Port static_port{"static_port"};

  explicit sensing_portal(const sc_core::sc_module_name& name) : signal_portal<T>(name) {}
  /// \throws error see portal::make_accessor
  void bind_dynamic(Port& port) {
    auto& made = this->template make_accessor<Accessor>(port, static_cast<signal_portal<T>&>(*this));
    port.bind(static_cast<sc_core::sc_signal_in_if<T>&>(made));
  }

 private:
  const sc_core::sc_signal_in_if<T>& channel() const override { return *static_port[0]; }
};

/// From the active module to the static signal, and back for processes that read their own output.
template <class T, class Port, class Accessor>
class driving_portal : public signal_portal<T> {
 public:
  Port static_port{"static_port"};

  explicit driving_portal(const sc_core::sc_module_name& name) : signal_portal<T>(name) {
    SC_HAS_PROCESS(driving_portal);
    SC_METHOD(drive);
    this->sensitive << request_;
    this->dont_initialize();
  }
  /// \throws error see portal::make_accessor
  void bind_dynamic(Port& port) {
    auto& made = this->template make_accessor<Accessor>(port, static_cast<signal_portal<T>&>(*this));
    port.bind(static_cast<sc_core::sc_signal_inout_if<T>&>(made));
  }
  /// What the static signal gets when the portal closes; asked each time. T() or 'Z' at first.
  void set_undefined_output(std::function<T()> value) { undefined_output_ = std::move(value); }
  /// The static signal keeps its last value when the portal closes, as behind a register.
  void hold_output() { undefined_output_ = nullptr; }

 private:
  const sc_core::sc_signal_in_if<T>& channel() const override { return *static_port[0]; }
  sc_core::sc_writer_policy writer_policy() const override { return static_port[0]->get_writer_policy(); }

  void request_write(const T& value) override {
    value_ = value;
    request_.notify();
  }
  void request_write_later(const T& value) override {
    value_ = value;
    if (sc_core::sc_get_status() == sc_core::SC_RUNNING) {
      request_.notify(sc_core::SC_ZERO_TIME);
    } else {
      drive();  // as an initial value
    }
  }
  void request_undefined() override {
    if (undefined_output_) request_write_later(undefined_output_());
  }
  void drive() { static_port->write(value_); }

  T value_{};
  std::function<T()> undefined_output_ = [] { return undefined_value<T>::get(); };
  sc_core::sc_event request_;
};

template <class T>
using in_portal = sensing_portal<T, sc_core::sc_in<T>, input_accessor<T, sc_core::sc_signal_in_if<T>>>;
template <class T>
using out_portal = driving_portal<T, sc_core::sc_out<T>, output_accessor<T>>;
template <class T>
using inout_portal = driving_portal<T, sc_core::sc_inout<T>, output_accessor<T>>;

template <class T>
struct portal_for<sc_core::sc_in<T>> {
  using type = in_portal<T>;
};
template <class T>
struct portal_for<sc_core::sc_out<T>> {
  using type = out_portal<T>;
};
template <class T>
struct portal_for<sc_core::sc_inout<T>> {
  using type = inout_portal<T>;
};

}  // namespace cchip::rc

#endif
