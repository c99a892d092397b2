// SPDX-License-Identifier: Apache-2.0
/// \file
/// Portals for sc_fifo_in and sc_fifo_out.
///
/// A module that waits at an empty input or a full output can be deactivated: nothing has been transferred. Closed:
/// blocking calls wait for the next activation and then go on, non-blocking ones fail, counts are 0. On opening the
/// module sees one event if there are data or room.
#ifndef CCHIP_RC_FIFO_PORTAL_HPP
#define CCHIP_RC_FIFO_PORTAL_HPP

#include <cchip/rc/portal.hpp>
#include <string>
#include <systemc>

namespace cchip::rc {

/// When a FIFO lets its module go.
enum class fifo_rule {
  empty,     ///< the paper's, section 3.1: a FIFO that is not empty holds the module
  transfers  ///< that of ReChannel 2: data stay in the FIFO for the next module
};

template <class T>
class fifo_in_portal;
template <class T>
class fifo_out_portal;

template <class T>
class fifo_in_accessor : public accessor, public sc_core::sc_fifo_in_if<T> {
 public:
  fifo_in_accessor(context& owner, fifo_in_portal<T>& at, const std::string& port_name)
      : accessor(owner, at, port_name), portal_(&at) {}

  void read(T& value) override {
    while (!nb_read(value)) sc_core::wait(written_);
  }
  T read() override {
    T value{};
    read(value);
    return value;
  }
  bool nb_read(T& value) override {
    if (!is_open() || !portal_->static_port->nb_read(value)) return false;
    owner().recheck();
    return true;
  }
  const sc_core::sc_event& data_written_event() const override { return written_; }
  int num_available() const override { return is_open() ? portal_->static_port->num_available() : 0; }
  const sc_core::sc_event& default_event() const override { return written_; }

  void follow() {
    if (is_open()) written_.notify();
  }
  std::string holding() const override;

 protected:
  void opened() override {
    if (num_available() > 0) written_.notify(sc_core::SC_ZERO_TIME);
  }
  void closed() override {}
  bool reattach(portal& to) override {
    auto* p = dynamic_cast<fifo_in_portal<T>*>(&to);
    if (p != nullptr) portal_ = p;
    return p != nullptr;
  }

 private:
  fifo_in_portal<T>* portal_;
  sc_core::sc_event written_;
};

template <class T>
class fifo_out_accessor : public accessor, public sc_core::sc_fifo_out_if<T> {
 public:
  fifo_out_accessor(context& owner, fifo_out_portal<T>& at, const std::string& port_name)
      : accessor(owner, at, port_name), portal_(&at) {}

  void write(const T& value) override {
    while (!nb_write(value)) sc_core::wait(read_);
  }
  bool nb_write(const T& value) override {
    if (!is_open() || !portal_->static_port->nb_write(value)) return false;
    wrote_at_ = sc_core::sc_delta_count();
    owner().recheck();
    return true;
  }
  const sc_core::sc_event& data_read_event() const override { return read_; }
  int num_free() const override { return is_open() ? portal_->static_port->num_free() : 0; }
  const sc_core::sc_event& default_event() const override { return read_; }

  void follow() {
    if (is_open()) read_.notify();
  }
  std::string holding() const override;
  const sc_core::sc_event* let_go() const override;

 protected:
  void opened() override {
    if (num_free() > 0) read_.notify(sc_core::SC_ZERO_TIME);
  }
  void closed() override {}
  bool reattach(portal& to) override {
    auto* p = dynamic_cast<fifo_out_portal<T>*>(&to);
    if (p != nullptr) portal_ = p;
    return p != nullptr;
  }

 private:
  fifo_out_portal<T>* portal_;
  sc_core::sc_event read_;
  sc_dt::uint64 wrote_at_ = ~sc_dt::uint64{0};
};

/// sc_fifo_in<T>: from the static FIFO to the active module.
template <class T>
class fifo_in_portal : public portal {
 public:
  sc_core::sc_fifo_in<T> static_port{"static_port"};

  explicit fifo_in_portal(const sc_core::sc_module_name& name) : portal(name) {
    SC_HAS_PROCESS(fifo_in_portal);
    SC_METHOD(follow);
    sensitive << static_port.data_written();
    dont_initialize();
  }
  /// \throws error see portal::make_accessor
  void bind_dynamic(sc_core::sc_fifo_in<T>& port) { port.bind(make_accessor<fifo_in_accessor<T>>(port, *this)); }
  void set_rule(fifo_rule rule) { rule_ = rule; }
  fifo_rule rule() const { return rule_; }

 private:
  void follow() {
    if (auto* a = open_accessor()) static_cast<fifo_in_accessor<T>*>(a)->follow();
  }
  fifo_rule rule_ = fifo_rule::empty;
};

/// sc_fifo_out<T>: from the active module to the static FIFO.
template <class T>
class fifo_out_portal : public portal {
 public:
  sc_core::sc_fifo_out<T> static_port{"static_port"};

  explicit fifo_out_portal(const sc_core::sc_module_name& name) : portal(name) {
    SC_HAS_PROCESS(fifo_out_portal);
    SC_METHOD(follow);
    sensitive << static_port.data_read();
    dont_initialize();
  }
  /// \throws error see portal::make_accessor
  void bind_dynamic(sc_core::sc_fifo_out<T>& port) { port.bind(make_accessor<fifo_out_accessor<T>>(port, *this)); }
  /// The rule `empty` needs a channel that can be asked for what it holds, as sc_fifo can.
  void set_rule(fifo_rule rule) { rule_ = rule; }
  fifo_rule rule() const { return rule_; }

 private:
  void follow() {
    if (auto* a = open_accessor()) static_cast<fifo_out_accessor<T>*>(a)->follow();
  }
  fifo_rule rule_ = fifo_rule::empty;
};

template <class T>
std::string fifo_in_accessor<T>::holding() const {
  if (!is_open() || portal_->rule() != fifo_rule::empty) return {};
  const int count = num_available();
  return count == 0 ? std::string() : std::string(portal_->name()) + ": " + std::to_string(count) + " item(s) not read";
}

template <class T>
std::string fifo_out_accessor<T>::holding() const {
  if (!is_open() || portal_->rule() != fifo_rule::empty) return {};
  const auto* channel = dynamic_cast<const sc_core::sc_fifo_in_if<T>*>(portal_->static_port[0]);
  const int count = channel == nullptr ? 0 : channel->num_available();
  if (count == 0 && wrote_at_ != sc_core::sc_delta_count()) return {};
  return std::string(portal_->name()) + ": result(s) not fetched by the static side";
}

template <class T>
const sc_core::sc_event* fifo_out_accessor<T>::let_go() const {
  return &portal_->static_port->data_read_event();
}

template <class T>
struct portal_for<sc_core::sc_fifo_in<T>> {
  using type = fifo_in_portal<T>;
};
template <class T>
struct portal_for<sc_core::sc_fifo_out<T>> {
  using type = fifo_out_portal<T>;
};

}  // namespace cchip::rc

#endif
