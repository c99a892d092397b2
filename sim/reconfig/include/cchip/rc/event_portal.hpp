// SPDX-License-Identifier: Apache-2.0
/// \file
/// Portal for events: ports of type sc_port<sc_event_queue_if>. Notifications of the static queue reach the active
/// module in the delta in which they occur. A notification that a module requests while the portal is closed is
/// dropped; a delayed notification that it requested before still arrives.
#ifndef CCHIP_RC_EVENT_PORTAL_HPP
#define CCHIP_RC_EVENT_PORTAL_HPP

#include <cchip/rc/portal.hpp>
#include <string>
#include <systemc>

namespace cchip::rc {

class event_accessor;

class event_portal : public following_portal {
 public:
  sc_core::sc_event_queue_port static_port{"static_port"};

  explicit event_portal(const sc_core::sc_module_name& name) : following_portal(name) {}
  /// \throws error see portal::make_accessor
  void bind_dynamic(sc_core::sc_port_b<sc_core::sc_event_queue_if>& port);
  const sc_core::sc_event& static_event(edge = edge::any) const override { return static_port->default_event(); }
};

/// The static queue as one module sees it.
class event_accessor : public accessor_of<event_portal>, public sc_core::sc_event_queue_if {
 public:
  event_accessor(context& owner, event_portal& at, const std::string& port_name)
      : accessor_of<event_portal>(owner, at, port_name) {}
  const sc_core::sc_event& default_event() const override {
    watch();
    return event_;
  }
  void notify(double time, sc_core::sc_time_unit unit) override { notify(sc_core::sc_time(time, unit)); }
  void notify(const sc_core::sc_time& time) override {
    if (is_open()) typed_portal().static_port->notify(time);
  }
  void cancel_all() override {
    if (is_open()) typed_portal().static_port->cancel_all();
  }

 protected:
  void follow() override { event_.notify(); }

 private:
  sc_core::sc_event event_;
};

inline void event_portal::bind_dynamic(sc_core::sc_port_b<sc_core::sc_event_queue_if>& port) {
  port.bind(make_accessor<event_accessor>(port, *this));
}

template <int N, sc_core::sc_port_policy P>
struct portal_for<sc_core::sc_port<sc_core::sc_event_queue_if, N, P>> {
  using type = event_portal;
};

}  // namespace cchip::rc

#endif
