// SPDX-License-Identifier: Apache-2.0
/// \file
/// Port groups and portal groups: all ports of a module bound in one statement (paper 3.3, "Topology").
///
///     auto group_of(tri_tri& m) { return rc::ports(m.clk, m.rst, m.pair, m.result); }
///     rc::portal_group<decltype(group_of(tri))> portals("portals", {"clk", "rst", "pair", "result"});
///     portals.bind_static(clk, rst, pair, result);
///     portals.bind_dynamic(group_of(tri));
///     portals.bind_dynamic(group_of(quad));
#ifndef CCHIP_RC_GROUP_HPP
#define CCHIP_RC_GROUP_HPP

#include <cchip/rc/portal.hpp>
#include <initializer_list>
#include <memory>
#include <string>
#include <systemc>
#include <tuple>
#include <utility>
#include <vector>

namespace cchip::rc {

/// The ports of a module in the order of a portal group.
template <class... Port>
std::tuple<Port&...> ports(Port&... port) {
  return {port...};
}

/// Portals in order, as control::move() sees them.
class portal_group_base : public sc_core::sc_module {
 public:
  const std::vector<portal*>& portals() const { return portals_; }

 protected:
  explicit portal_group_base(const sc_core::sc_module_name&) {}
  void own(portal& p) {
    p.group_ = this;
    portals_.push_back(&p);
  }

 private:
  std::vector<portal*> portals_;
};

template <class Ports>
class portal_group;

template <class... Port>
class portal_group<std::tuple<Port&...>> : public portal_group_base {
 public:
  /// \param names one for each portal; p0, p1, ... if empty
  explicit portal_group(const sc_core::sc_module_name& name, const std::vector<std::string>& names = {})
      : portal_group_base(name), portals_(make(names, std::index_sequence_for<Port...>())) {
    std::apply([this](auto&... p) { (own(*p), ...); }, portals_);
  }

  /// Binds the static sides to channels or ports, in order.
  template <class... Channel>
  void bind_static(Channel&... channel) {
    static_assert(sizeof...(Channel) == sizeof...(Port), "portal_group::bind_static: one channel for each portal");
    std::apply([&](auto&... p) { (p->static_port.bind(channel), ...); }, portals_);
  }
  /// Binds the ports of a module; once for each module.
  /// \throws error see portal::make_accessor; or the ports are not of one module
  void bind_dynamic(std::tuple<Port&...> module_ports) {
    check_one_module(module_ports);
    bind(module_ports, std::index_sequence_for<Port...>());
  }
  template <std::size_t I>
  auto& at() {
    return *std::get<I>(portals_);
  }

 private:
  using Portals = std::tuple<std::unique_ptr<typename portal_for<Port>::type>...>;

  template <std::size_t... I>
  static Portals make(const std::vector<std::string>& names, std::index_sequence<I...>) {
    if (!names.empty() && names.size() != sizeof...(Port)) {
      throw error("portal_group: " + std::to_string(names.size()) + " names for " + std::to_string(sizeof...(Port)) +
                  " portals; give one for each, or none");
    }
    const auto name_of = [&names](std::size_t i) { return names.empty() ? "p" + std::to_string(i) : names[i]; };
    return Portals(std::make_unique<typename portal_for<Port>::type>(name_of(I).c_str())...);
  }
  void check_one_module(const std::tuple<Port&...>& module_ports) const {
    const sc_core::sc_object& first = std::get<0>(module_ports);
    const auto check = [&](const sc_core::sc_object& port) {
      if (context::of(&port) == context::of(&first)) return;
      throw error(std::string(name()) + ": ports " + first.name() + " and " + port.name() +
                  " are of two modules; bind the ports of one at a time");
    };
    std::apply([&](const auto&... port) { (check(port), ...); }, module_ports);
  }
  template <std::size_t... I>
  void bind(std::tuple<Port&...>& module_ports, std::index_sequence<I...>) {
    (std::get<I>(portals_)->bind_dynamic(std::get<I>(module_ports)), ...);
  }

  Portals portals_;
};

}  // namespace cchip::rc

#endif
