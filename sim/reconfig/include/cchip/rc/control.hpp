// SPDX-License-Identifier: Apache-2.0
/// \file
/// Moves modules from state to state, as a configuration controller does.
#ifndef CCHIP_RC_CONTROL_HPP
#define CCHIP_RC_CONTROL_HPP

#include <cchip/rc/context.hpp>
#include <cchip/rc/group.hpp>
#include <systemc>
#include <utility>
#include <vector>

namespace cchip::rc {

/// Modules that are reconfigured together: `tri + quad`.
class module_set {
 public:
  module_set(context& module) : modules_{&module} {}  // NOLINT(google-explicit-constructor): a module is a set
  const std::vector<context*>& modules() const& { return modules_; }
  std::vector<context*> modules() && { return std::move(modules_); }
  module_set& operator+=(const module_set& other);

 private:
  std::vector<context*> modules_;
};
inline module_set operator+(module_set left, const module_set& right) { return left += right; }

/// During simulation its actions block the calling SC_THREAD until they are done for all modules of the set, which are
/// reconfigured side by side. Before sc_start() they take no time, call no hooks and set the initial configuration.
/// Modules that are not in the state that an action begins with are left alone: load() applies to unloaded ones,
/// activate() to unloaded (which it loads first) and inactive ones, deactivate() to active ones, unload() to inactive
/// and active (which it deactivates first) ones.
/// \throws error, every action: a module is not added; it is called from an SC_METHOD, from a process of the module
///         that it would cancel, at the start of simulation or between two sc_start(); a portal of the module is
///         reserved for another loaded one (nothing has changed then); deactivation is not possible in time (the module
///         stays active). In a set, the actions of the other modules are completed and all errors are reported.
class control : public sc_core::sc_module {
 public:
  explicit control(const sc_core::sc_module_name&) {}
  ~control() override;

  /// \throws error a module belongs to another control
  void add(const module_set& set);
  /// \throws error a module is not in this control, or not unloaded
  void remove(const module_set& set);

  void load(const module_set& set);
  void activate(const module_set& set);
  void deactivate(const module_set& set);
  void unload(const module_set& set);
  /// Unloads the module and attaches it to the portals of another group of the same type, where it stays unloaded.
  /// \throws error its portals are not those of such a group
  void move(context& module, portal_group_base& to);

  /// Longest time to wait for the holders of a module, 1 s at first; sc_max_time(): for ever.
  void set_deactivation_timeout(const sc_core::sc_time& timeout) { timeout_ = timeout; }

  /// Locks the control for the calling process, and those that it spawns, until it has called unlock() as often;
  /// actions of other processes wait meanwhile. A process that has ended holds no lock.
  /// \returns false: not free within the limit
  bool lock(const sc_core::sc_time& limit = sc_core::sc_max_time());
  bool trylock() { return lock(sc_core::SC_ZERO_TIME); }
  /// \throws error the calling process does not have the lock
  void unlock();
  bool is_locked() const;

  /// Time of an action: the delay of the module unless a derived class overrides it. Asked at the beginning of each.
  virtual sc_core::sc_time takes_time(const context& module, action a) const { return module.delay(a); }

 private:
  friend class context;
  void drop(context& module);
  bool is_mine() const;
  void run(action a, const module_set& set);
  void run_side_by_side(action a, const module_set& set);
  void run_one(action a, context& module);
  void set_initial(action a, context& module);
  void check(action a, const module_set& set) const;

  std::vector<context*> modules_;
  sc_core::sc_time timeout_{1, sc_core::SC_SEC};
  sc_core::sc_process_handle owner_;
  int depth_ = 0;
  sc_core::sc_event unlocked_;
};

}  // namespace cchip::rc

#endif
