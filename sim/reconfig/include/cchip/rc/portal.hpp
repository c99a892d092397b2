// SPDX-License-Identifier: Apache-2.0
/// \file
/// What all portals have in common. A portal connects one static channel with the like ports of any number of
/// reconfigurable modules, of which one at a time may be active. It passes everything to and from the active module and
/// nothing to and from the others.
#ifndef CCHIP_RC_PORTAL_HPP
#define CCHIP_RC_PORTAL_HPP

#include <array>
#include <cchip/rc/context.hpp>
#include <list>
#include <string>
#include <systemc>
#include <vector>

namespace cchip::rc {

/// Kinds of events of a signal; others have `any` only.
enum class edge { any, rise, fall };
using edge_set = std::array<bool, 3>;

/// The end of a portal at one port of one module; the port is bound to it. Belongs to the module.
class accessor : public holder {
 public:
  ~accessor() override;
  accessor(const accessor&) = delete;
  accessor& operator=(const accessor&) = delete;

  context& owner() const { return owner_; }
  /// The portal it is attached to; nullptr after the portal's destruction.
  portal* at() const { return portal_; }
  bool is_open() const { return open_; }
  /// Full name of the port.
  const std::string& port_name() const { return port_name_; }
  std::string holding() const override { return {}; }

 protected:
  accessor(context& owner, portal& at, std::string port_name);
  /// Called in an update phase, before or at the start of simulation for a module that begins active: notify events
  /// with SC_ZERO_TIME, write nothing.
  virtual void opened() {}
  /// Start of simulation, in every state.
  virtual void started() {}
  virtual void closed() {}
  /// The static side has notified its event while this accessor is open.
  virtual void follow() {}
  /// Something waits for such events of the static side from now on.
  void watch(edge e = edge::any) const;
  /// Returns whether this accessor can work with the portal `to`; if so, it is attached to it from now on.
  virtual bool reattach(portal& to) = 0;
  /// Waits for the next opening or an event of the static side.
  void wait_for_opening_or(const sc_core::sc_event& event);

 private:
  friend class context;
  friend class control;
  friend class following_portal;
  friend class portal;
  void open();
  void close();
  void attach(portal& to);

  context& owner_;
  portal* portal_;
  std::string port_name_;
  bool open_ = false;
  mutable edge_set watched_{};
  sc_core::sc_event opened_;
  const sc_core::sc_event* last_waited_for_ = nullptr;
  std::list<sc_core::sc_event_or_list> waits_;  // the last one for that event; processes may wait for the others
};

/// An accessor of portals of type Portal.
template <class Portal>
class accessor_of : public accessor {
 protected:
  accessor_of(context& owner, Portal& at, const std::string& port_name)
      : accessor(owner, at, port_name), portal_(&at) {}
  Portal& typed_portal() const { return *portal_; }
  bool reattach(portal& to) override {
    auto* p = dynamic_cast<Portal*>(&to);
    if (p != nullptr) portal_ = p;
    return p != nullptr;
  }

 private:
  Portal* portal_;
};

class portal_group_base;

/// portal_for<sc_in<T>>::type is in_portal<T>, and so on.
template <class Port, class Enable = void>
struct portal_for;

class portal : public sc_core::sc_module {
 public:
  ~portal() override;
  /// The module whose accessor is open, nullptr: closed.
  context* active_module() const { return open_ == nullptr ? nullptr : &open_->owner(); }
  /// The loaded module that the portal is reserved for, nullptr: none.
  context* loaded_module() const { return claimed_by_; }
  /// The group that it belongs to, nullptr: none.
  portal_group_base* group() const { return group_; }

 protected:
  explicit portal(const sc_core::sc_module_name&) {}
  accessor* open_accessor() const { return open_; }
  virtual void watch(edge) {}
  /// A module is active here and not about to be deactivated.
  bool takes_calls() const;
  void wait_until_it_takes_calls();
  /// Makes an accessor for a port of a reconfigurable module, which keeps it.
  /// \throws error the port is not in a reconfigurable module, is in two portals, or simulation has begun
  template <class Accessor, class Port, class Portal>
  Accessor& make_accessor(Port& port, Portal& self) {
    context& owner = owner_of(port);
    auto made = std::make_unique<Accessor>(owner, self, std::string(port.name()));
    Accessor& result = *made;
    keep(owner, std::move(made));
    return result;
  }

 private:
  friend class accessor;
  friend class context;
  friend class portal_group_base;
  static void keep(context& owner, std::unique_ptr<accessor> made);
  context& owner_of(const sc_core::sc_object& port) const;

  std::vector<accessor*> attached_;
  accessor* open_ = nullptr;
  context* claimed_by_ = nullptr;
  portal_group_base* group_ = nullptr;
  sc_core::sc_event module_opened_;
};

/// A portal that passes events on. Where nothing in a module waits for them, it does not listen and adds no delta.
class following_portal : public portal {
 public:
  // for accessors
  /// Runs follow() of the open accessor in the next delta if something waits.
  void refresh();
  virtual const sc_core::sc_event& static_event(edge e = edge::any) const = 0;

 protected:
  using portal::portal;
  void watch(edge e) override;
  void end_of_elaboration() override;

 private:
  void listen(edge e);
  void pass_on();

  edge_set watched_{};
  bool elaborated_ = false;
  sc_core::sc_event refresh_;
};

}  // namespace cchip::rc

#endif
