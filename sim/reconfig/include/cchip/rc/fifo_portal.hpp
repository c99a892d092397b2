// SPDX-License-Identifier: Apache-2.0
/// \file
/// Portals for sc_fifo_in and sc_fifo_out.
///
/// A module that waits at an empty input or a full output can be deactivated, because nothing has been transferred.
/// While the portal is closed, blocking calls wait for the next activation and then continue, non-blocking ones fail,
/// counts are 0. On opening, the module sees one event if there are data or room.
#ifndef CCHIP_RC_FIFO_PORTAL_HPP
#define CCHIP_RC_FIFO_PORTAL_HPP

#include <cchip/rc/portal.hpp>
#include <cchip/rc/transaction.hpp>
#include <limits>
#include <string>
#include <systemc>

namespace cchip::rc {

/// When a FIFO releases its module.
enum class fifo_rule {
  empty,     ///< the paper's, section 3.1: a FIFO that is not empty holds the module
  transfers  ///< that of ReChannel 2: data stay in the FIFO for the next module
};

/// What both directions have in common: rule and filter.
class fifo_portal : public following_portal {
 public:
  void set_rule(fifo_rule rule) { rule_ = rule; }
  fifo_rule rule() const { return rule_; }

  /// Each item that passes counts `weight` transactions; the module is held while the counter is not 0. With +1 at its
  /// inputs and -1 at its outputs, a module can be deactivated once it has given as many results as it has taken
  /// operands. If a deactivation was requested and the counter is 0, the module is deactivated before its next blocking
  /// read. The counter must outlive the simulation.
  void count(transaction_counter& counter, long weight) {
    counter_ = &counter;
    weight_ = weight;
  }
  /// Items that may pass in one activation; after them the FIFO looks empty, or full, to the module.
  void set_limit(long items) { limit_ = items; }

  // for its accessors
  transaction_counter* counter() const { return counter_; }
  long weight() const { return weight_; }
  long limit() const { return limit_; }

 protected:
  using following_portal::following_portal;

 private:
  fifo_rule rule_ = fifo_rule::empty;
  transaction_counter* counter_ = nullptr;
  long weight_ = 0;
  long limit_ = std::numeric_limits<long>::max();
};

/// A FIFO as one module sees it, without its direction.
template <class Portal>
class fifo_accessor : public accessor_of<Portal> {
 public:
  fifo_accessor(context& owner, Portal& at, const std::string& port_name) : accessor_of<Portal>(owner, at, port_name) {}

  std::string holding() const override {
    if (!this->is_open()) return {};
    std::string text = this->typed_portal().rule() == fifo_rule::empty ? not_empty() : std::string();
    const transaction_counter* counter = this->typed_portal().counter();
    return text.empty() && counter != nullptr ? counter->holding() : text;
  }

 protected:
  /// What the rule `empty` waits for, in words.
  virtual std::string not_empty() const = 0;
  virtual bool can_transfer() const = 0;

  bool may_pass() const { return this->is_open() && passed_ < this->typed_portal().limit(); }
  void passed() {
    ++passed_;
    if (transaction_counter* counter = this->typed_portal().counter()) counter->add(this->typed_portal().weight());
    this->owner().recheck();
  }
  /// Waits until a blocking call may succeed.
  void wait_for_chance() { this->wait_for_opening_or(this->typed_portal().static_event()); }
  void leave_if_asked() {
    if (this->typed_portal().counter() != nullptr) this->owner().possible_deactivation();
  }
  const sc_core::sc_event& event() const {
    this->watch();
    return event_;
  }

  void opened() override {
    passed_ = 0;
    if (can_transfer()) this->typed_portal().refresh();
  }
  void follow() override {
    if (may_pass()) event_.notify();
  }

 private:
  long passed_ = 0;
  sc_core::sc_event event_;
};

template <class T>
class fifo_in_portal;
template <class T>
class fifo_out_portal;

template <class T>
class fifo_in_accessor : public fifo_accessor<fifo_in_portal<T>>, public sc_core::sc_fifo_in_if<T> {
 public:
  using fifo_accessor<fifo_in_portal<T>>::fifo_accessor;

  void read(T& value) override {
    this->leave_if_asked();
    while (!nb_read(value)) this->wait_for_chance();
  }
  T read() override {
    T value{};
    read(value);
    return value;
  }
  bool nb_read(T& value) override {
    if (!this->may_pass() || !this->typed_portal().static_port->nb_read(value)) return false;
    this->passed();
    return true;
  }
  int num_available() const override {
    return this->may_pass() ? this->typed_portal().static_port->num_available() : 0;
  }
  const sc_core::sc_event& data_written_event() const override { return this->event(); }
  const sc_core::sc_event& default_event() const override { return this->event(); }

 protected:
  std::string not_empty() const override {
    const int count = num_available();
    if (count == 0) return {};
    return std::string(this->typed_portal().name()) + ": " + std::to_string(count) + " item(s) not read";
  }
  bool can_transfer() const override { return num_available() > 0; }
};

template <class T>
class fifo_out_accessor : public fifo_accessor<fifo_out_portal<T>>, public sc_core::sc_fifo_out_if<T> {
 public:
  using fifo_accessor<fifo_out_portal<T>>::fifo_accessor;

  void write(const T& value) override {
    while (!nb_write(value)) this->wait_for_chance();
  }
  bool nb_write(const T& value) override {
    if (!this->may_pass() || !this->typed_portal().static_port->nb_write(value)) return false;
    wrote_at_ = sc_core::sc_delta_count();
    this->passed();
    return true;
  }
  int num_free() const override { return this->may_pass() ? this->typed_portal().static_port->num_free() : 0; }
  const sc_core::sc_event& data_read_event() const override { return this->event(); }
  const sc_core::sc_event& default_event() const override { return this->event(); }
  const sc_core::sc_event* let_go() const override { return &this->typed_portal().static_event(); }

 protected:
  std::string not_empty() const override {
    const auto* channel = dynamic_cast<const sc_core::sc_fifo_in_if<T>*>(this->typed_portal().static_port[0]);
    const bool empty = channel == nullptr || channel->num_available() == 0;
    if (empty && wrote_at_ != sc_core::sc_delta_count()) return {};
    return std::string(this->typed_portal().name()) + ": result(s) not fetched by the static side";
  }
  bool can_transfer() const override { return num_free() > 0; }

 private:
  sc_dt::uint64 wrote_at_ = ~sc_dt::uint64{0};
};

/// sc_fifo_in<T>: from the static FIFO to the active module.
template <class T>
class fifo_in_portal : public fifo_portal {
 public:
  sc_core::sc_fifo_in<T> static_port{"static_port"};

  explicit fifo_in_portal(const sc_core::sc_module_name& name) : fifo_portal(name) {}
  /// \throws error see portal::make_accessor
  void bind_dynamic(sc_core::sc_fifo_in<T>& port) { port.bind(make_accessor<fifo_in_accessor<T>>(port, *this)); }
  const sc_core::sc_event& static_event(edge = edge::any) const override { return static_port->data_written_event(); }
};

/// sc_fifo_out<T>: from the active module to the static FIFO. The rule `empty` needs a channel that can be asked for
/// what it holds, as sc_fifo can.
template <class T>
class fifo_out_portal : public fifo_portal {
 public:
  sc_core::sc_fifo_out<T> static_port{"static_port"};

  explicit fifo_out_portal(const sc_core::sc_module_name& name) : fifo_portal(name) {}
  /// \throws error see portal::make_accessor
  void bind_dynamic(sc_core::sc_fifo_out<T>& port) { port.bind(make_accessor<fifo_out_accessor<T>>(port, *this)); }
  const sc_core::sc_event& static_event(edge = edge::any) const override { return static_port->data_read_event(); }
};

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
