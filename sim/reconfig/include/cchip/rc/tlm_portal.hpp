// SPDX-License-Identifier: Apache-2.0
/// \file
/// Portals for TLM-2.0 sockets of modules with the blocking interface: tlm_initiator_portal for a module's initiator
/// socket, tlm_target_portal for its target socket. b_transport() holds the module from call to return.
/// transport_dbg() passes an open portal and moves 0 bytes through a closed one. Direct memory pointers are never
/// granted, because they would bypass the portal. The nonblocking interface is an error.
#ifndef CCHIP_RC_TLM_PORTAL_HPP
#define CCHIP_RC_TLM_PORTAL_HPP

#include <cchip/rc/portal.hpp>
#include <string>
#include <systemc>
#include <tlm>
#include <type_traits>

namespace cchip::rc {

/// What a call from the static side gets when the portal is closed or about to close. No call begins when deactivation
/// of the module is requested and nothing holds it.
enum class tlm_rule {
  refuse,  ///< TLM_GENERIC_ERROR_RESPONSE at once
  wait     ///< it waits for the next activation
};

namespace detail {

[[noreturn]] inline void only_blocking(const std::string& where) {
  throw error(where + ": nonblocking transport does not pass portals; use b_transport()");
}

/// Forward interface without the functions that portals do not pass.
template <class Types>
class forward_blocking : public tlm::tlm_fw_transport_if<Types> {
 public:
  using payload = typename Types::tlm_payload_type;
  using phase = typename Types::tlm_phase_type;
  tlm::tlm_sync_enum nb_transport_fw(payload&, phase&, sc_core::sc_time&) override { only_blocking(where()); }
  bool get_direct_mem_ptr(payload&, tlm::tlm_dmi& dmi) override {
    dmi.init();
    dmi.allow_none();
    return false;
  }

 private:
  virtual std::string where() const = 0;
};

/// Backward interface, unused.
template <class Types>
class backward_blocking : public tlm::tlm_bw_transport_if<Types> {
 public:
  using payload = typename Types::tlm_payload_type;
  using phase = typename Types::tlm_phase_type;
  tlm::tlm_sync_enum nb_transport_bw(payload&, phase&, sc_core::sc_time&) override { only_blocking(where()); }
  void invalidate_direct_mem_ptr(sc_dt::uint64, sc_dt::uint64) override {}

 private:
  virtual std::string where() const = 0;
};

/// Counts the calls in progress.
template <class Portal>
class call_accessor : public accessor_of<Portal> {
 public:
  using accessor_of<Portal>::accessor_of;
  call_accessor(context& owner, Portal& at, const std::string& port_name) : accessor_of<Portal>(owner, at, port_name) {}
  std::string holding() const override {
    if (calls_ == 0) return {};
    return std::string(this->typed_portal().name()) + ": " + std::to_string(calls_) +
           " call(s) of b_transport not returned";
  }

 protected:
  template <class Interface, class Payload>
  void call(Interface& target, Payload& payload, sc_core::sc_time& delay) {
    struct under_way {
      call_accessor& a;
      explicit under_way(call_accessor& accessor) : a(accessor) { ++a.calls_; }
      ~under_way() {
        --a.calls_;
        a.owner().recheck();
      }
    } const guard(*this);
    target.b_transport(payload, delay);
    payload.set_dmi_allowed(false);
  }

 private:
  int calls_ = 0;
};

}  // namespace detail

template <unsigned Width, class Types>
class tlm_initiator_portal;
template <unsigned Width, class Types>
class tlm_target_portal;

/// The static target as one module sees it. A call into a portal that is closed or about to close waits for the next
/// activation.
template <unsigned Width, class Types>
class tlm_initiator_accessor : public detail::call_accessor<tlm_initiator_portal<Width, Types>>,
                               public detail::forward_blocking<Types> {
 public:
  using payload = typename Types::tlm_payload_type;
  using detail::call_accessor<tlm_initiator_portal<Width, Types>>::call_accessor;
  void b_transport(payload& data, sc_core::sc_time& delay) override {
    this->owner().possible_deactivation();
    this->call(*this->typed_portal().static_port[0], data, delay);
  }
  unsigned transport_dbg(payload& data) override {
    return this->is_open() ? this->typed_portal().static_port->transport_dbg(data) : 0;
  }

 private:
  std::string where() const override { return this->port_name(); }
};

/// Between the initiator sockets of modules and one static target.
template <unsigned Width, class Types>
class tlm_initiator_portal : public portal, private detail::backward_blocking<Types> {
 public:
  tlm::tlm_initiator_socket<Width, Types> static_port{"static_port"};
  using module_socket =
      tlm::tlm_base_initiator_socket_b<Width, tlm::tlm_fw_transport_if<Types>, tlm::tlm_bw_transport_if<Types>>;

  explicit tlm_initiator_portal(const sc_core::sc_module_name& name) : portal(name) {
    static_port.bind(static_cast<tlm::tlm_bw_transport_if<Types>&>(*this));
  }
  /// \throws error see portal::make_accessor
  void bind_dynamic(module_socket& socket) {
    auto& port = socket.get_base_port();
    port.bind(this->template make_accessor<tlm_initiator_accessor<Width, Types>>(port, *this));
  }

 private:
  std::string where() const override { return this->name(); }
};

/// The target socket of one module.
template <unsigned Width, class Types>
class tlm_target_accessor : public detail::call_accessor<tlm_target_portal<Width, Types>>,
                            public detail::backward_blocking<Types> {
 public:
  using payload = typename Types::tlm_payload_type;
  using detail::call_accessor<tlm_target_portal<Width, Types>>::call_accessor;
  using module_socket = typename tlm_target_portal<Width, Types>::module_socket;
  void set_socket(module_socket& socket) { socket_ = &socket; }
  void b_transport(payload& data, sc_core::sc_time& delay) { this->call(socket_->get_base_interface(), data, delay); }
  unsigned transport_dbg(payload& data) { return socket_->get_base_interface().transport_dbg(data); }

 private:
  std::string where() const override { return this->port_name(); }

  module_socket* socket_ = nullptr;
};

/// Between one static initiator and the target sockets of modules.
template <unsigned Width, class Types>
class tlm_target_portal : public portal, private detail::forward_blocking<Types> {
 public:
  using payload = typename Types::tlm_payload_type;
  tlm::tlm_target_socket<Width, Types> static_port{"static_port"};
  using module_socket =
      tlm::tlm_base_target_socket_b<Width, tlm::tlm_fw_transport_if<Types>, tlm::tlm_bw_transport_if<Types>>;

  explicit tlm_target_portal(const sc_core::sc_module_name& name) : portal(name) {
    static_port.bind(static_cast<tlm::tlm_fw_transport_if<Types>&>(*this));
  }
  /// \throws error see portal::make_accessor
  void bind_dynamic(module_socket& socket) {
    auto& port = socket.get_base_port();
    auto& made = this->template make_accessor<tlm_target_accessor<Width, Types>>(port, *this);
    made.set_socket(socket);
    port.bind(made);
  }
  void set_rule(tlm_rule rule) { rule_ = rule; }

 private:
  void b_transport(payload& data, sc_core::sc_time& delay) override {
    if (rule_ == tlm_rule::wait) this->wait_until_it_takes_calls();
    if (this->takes_calls()) {
      open_target()->b_transport(data, delay);
    } else {
      data.set_response_status(tlm::TLM_GENERIC_ERROR_RESPONSE);
    }
  }
  unsigned transport_dbg(payload& data) override {
    auto* a = open_target();
    return a == nullptr ? 0 : a->transport_dbg(data);
  }
  tlm_target_accessor<Width, Types>* open_target() const {
    return static_cast<tlm_target_accessor<Width, Types>*>(this->open_accessor());
  }
  std::string where() const override { return this->name(); }

  tlm_rule rule_ = tlm_rule::refuse;
};

namespace detail {

template <unsigned W, class Types, int N, sc_core::sc_port_policy P>
tlm_initiator_portal<W, Types> portal_of(const tlm::tlm_initiator_socket<W, Types, N, P>&);
template <unsigned W, class Types, int N, sc_core::sc_port_policy P>
tlm_target_portal<W, Types> portal_of(const tlm::tlm_target_socket<W, Types, N, P>&);

}  // namespace detail

/// Also for classes derived from the sockets, such as tlm_utils::simple_initiator_socket.
template <class Socket>
struct portal_for<Socket, std::void_t<decltype(detail::portal_of(std::declval<const Socket&>()))>> {
  using type = decltype(detail::portal_of(std::declval<const Socket&>()));
};

}  // namespace cchip::rc

#endif
