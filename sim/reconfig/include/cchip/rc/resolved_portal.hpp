// SPDX-License-Identifier: Apache-2.0
/// \file
/// Portals for resolved logic: sc_in_rv, sc_out_rv, sc_inout_rv and sc_in_resolved, sc_out_resolved, sc_inout_resolved.
///
/// What several processes of a module write is resolved inside the module's accessor; the static signal sees the portal
/// as one driver. While the portal is closed, also before any module was loaded, it drives 'Z', so it has no influence.
#ifndef CCHIP_RC_RESOLVED_PORTAL_HPP
#define CCHIP_RC_RESOLVED_PORTAL_HPP

#include <cchip/rc/signal_portal.hpp>
#include <systemc>
#include <vector>

namespace cchip::rc {
namespace detail {

inline sc_dt::sc_logic resolved(const std::vector<sc_dt::sc_logic>& drivers) {
  auto result = sc_dt::Log_Z;
  for (const sc_dt::sc_logic& driver : drivers) result = sc_core::sc_logic_resolution_tbl[result][driver.value()];
  return {result};
}

template <int W>
sc_dt::sc_lv<W> resolved(const std::vector<sc_dt::sc_lv<W>*>& drivers) {
  sc_dt::sc_lv<W> result;
  sc_core::sc_lv_resolve<W>::resolve(result, drivers);
  return result;
}

}  // namespace detail

/// Channel is sc_signal_resolved or sc_signal_rv: the ports check that, and it keeps a value for each process.
template <class T, class Channel>
class resolved_accessor : public driving_accessor<T, Channel> {
 public:
  using driving_accessor<T, Channel>::driving_accessor;
  void write(const T& value) override {
    Channel::write(value);
    this->show(detail::resolved(this->m_val_vec));
  }
};

template <int W>
using in_rv_portal =
    sensing_portal<sc_dt::sc_lv<W>, sc_core::sc_in_rv<W>, input_accessor<sc_dt::sc_lv<W>, sc_core::sc_signal_rv<W>>>;
template <int W>
using out_rv_portal = driving_portal<sc_dt::sc_lv<W>, sc_core::sc_out_rv<W>,
                                     resolved_accessor<sc_dt::sc_lv<W>, sc_core::sc_signal_rv<W>>>;
template <int W>
using inout_rv_portal = driving_portal<sc_dt::sc_lv<W>, sc_core::sc_inout_rv<W>,
                                       resolved_accessor<sc_dt::sc_lv<W>, sc_core::sc_signal_rv<W>>>;

using in_resolved_portal = sensing_portal<sc_dt::sc_logic, sc_core::sc_in_resolved,
                                          input_accessor<sc_dt::sc_logic, sc_core::sc_signal_resolved>>;
using out_resolved_portal = driving_portal<sc_dt::sc_logic, sc_core::sc_out_resolved,
                                           resolved_accessor<sc_dt::sc_logic, sc_core::sc_signal_resolved>>;
using inout_resolved_portal = driving_portal<sc_dt::sc_logic, sc_core::sc_inout_resolved,
                                             resolved_accessor<sc_dt::sc_logic, sc_core::sc_signal_resolved>>;

template <int W>
struct portal_for<sc_core::sc_in_rv<W>> {
  using type = in_rv_portal<W>;
};
template <int W>
struct portal_for<sc_core::sc_out_rv<W>> {
  using type = out_rv_portal<W>;
};
template <int W>
struct portal_for<sc_core::sc_inout_rv<W>> {
  using type = inout_rv_portal<W>;
};
template <>
struct portal_for<sc_core::sc_in_resolved> {
  using type = in_resolved_portal;
};
template <>
struct portal_for<sc_core::sc_out_resolved> {
  using type = out_resolved_portal;
};
template <>
struct portal_for<sc_core::sc_inout_resolved> {
  using type = inout_resolved_portal;
};

}  // namespace cchip::rc

#endif
