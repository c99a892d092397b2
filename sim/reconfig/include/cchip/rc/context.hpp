// SPDX-License-Identifier: Apache-2.0
/// \file
/// What turns a closed SystemC module into a reconfigurable one: states, delays, hooks, and what holds the module
/// when its deactivation is requested.
///
///     unloaded --load--> inactive --activate--> active --deactivate--> inactive --unload--> unloaded
///
/// The module itself is not touched: reconfigurable<M> derives from it. It is isolated by portals at its ports
/// (signal_portal.hpp, fifo_portal.hpp, ...) and moved from state to state by a control (control.hpp).
#ifndef CCHIP_RC_CONTEXT_HPP
#define CCHIP_RC_CONTEXT_HPP

#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <systemc>
#include <type_traits>
#include <utility>
#include <vector>

namespace cchip::rc {

enum class state { unloaded, inactive, active };
enum class action { load, activate, deactivate, unload };
const char* to_name(state s);
const char* to_name(action a);

/// What is wrong, where, and what to do.
class error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Something that may prevent the deactivation of a module.
class holder {
 public:
  virtual ~holder() = default;
  /// Why the module cannot be deactivated now, in words with a name; empty: it can.
  virtual std::string holding() const = 0;
  /// Event after which to ask again; none if the holder calls context::recheck() when it releases the module.
  virtual const sc_core::sc_event* let_go() const { return nullptr; }
};

/// Part of a module that goes back to its initial value when the module is configured. Neither function may wait.
class resettable {
 public:
  virtual ~resettable() = default;
  /// Start of simulation: keep the present value.
  virtual void store_reset_value() = 0;
  /// Restores the value kept: before each activation and after each deactivation.
  virtual void reset() = 0;
  /// The module has become active, in an update phase or at the start of simulation.
  virtual void activated() {}
};

class accessor;
class control;
class portal;

/// The reconfigurable side of a module. Errors of its functions are exceptions of type error.
class context {
 public:
  /// \param module the module that this belongs to, under construction
  explicit context(sc_core::sc_module& module);
  virtual ~context();
  context(const context&) = delete;
  context& operator=(const context&) = delete;

  /// The nearest module at or above an object that is reconfigurable, nullptr if there is none.
  static context* of(const sc_core::sc_object* object);

  state now() const { return state_; }
  bool is_active() const { return state_ == state::active; }
  /// Deactivation is requested, but something holds the module.
  bool deactivation_pending() const { return state_ == state::active && leaving_; }
  /// Deactivation is requested, and nothing holds the module: it happens in the next update phase.
  bool can_leave() const { return deactivation_pending() && held_by().empty(); }
  /// Notified one delta after the change.
  const sc_core::sc_event& activated_event() const { return activated_; }
  const sc_core::sc_event& deactivated_event() const { return deactivated_; }
  /// What holds the module, one after the other; empty: nothing.
  std::string held_by() const;

  /// Time that an action takes unless the control sets another; 0 at first.
  void set_delay(action a, const sc_core::sc_time& delay) { delays_[a] = delay; }
  sc_core::sc_time delay(action a) const;

  sc_core::sc_module& module() const { return module_; }
  std::string full_name() const { return module_.name(); }

  /// The holder must outlive the simulation or be removed.
  void add(holder& h) { holders_.push_back(&h); }
  void remove(holder& h);
  /// To be called when a holder may have released the module: the next update phase checks again whether a pending
  /// deactivation is possible.
  void recheck();
  /// Resettable objects below the module are found at the start of simulation; this is for others.
  void add(resettable& r) { resettables_.push_back(&r); }

  /// A possible point of deactivation inside a process of the module: if deactivation is pending and nothing holds the
  /// module, waits until the next activation.
  void possible_deactivation();

  /// Process that starts from its top at each activation and is cancelled at a wait() when the module is deactivated
  /// (stack unwound). Spawned while the simulation runs: starts when the module is active, and ends for good with the
  /// deactivation. Prefer RC_THREAD, RC_METHOD, RC_CTHREAD.
  enum class process_kind { thread, method, clocked_thread };
  sc_core::sc_process_handle spawn(const char* process_name, process_kind kind, std::function<void()> body);

 protected:
  /// Hooks, called after the action. on_load, on_activate, on_deactivate and on_unload may wait. Not called for actions
  /// before the simulation.
  virtual void on_load() {}
  virtual void on_activate() {}
  virtual void on_deactivate() {}
  virtual void on_unload() {}

 private:
  friend class accessor;
  friend class control;
  friend class portal;
  class updater;

  // actions of a control: all of them block the calling process
  void load(const sc_core::sc_time& delay);
  void activate(const sc_core::sc_time& delay);
  void deactivate(const sc_core::sc_time& delay, const sc_core::sc_time& timeout);
  void unload(const sc_core::sc_time& delay);
  void set_initial(state s) { state_ = s; }

  void claim_portals();
  void release_portals();
  void reset_all();
  void cancel_processes();
  void become_active();
  void wait_for_holders(const sc_core::sc_time& limit);
  bool is_own(const sc_core::sc_process_handle& process) const;
  void collect_resettables(const sc_core::sc_object& object);
  void start();   // start of simulation
  void update();  // update phase
  void park_until_activated(process_kind kind);
  std::function<void()> method_shell(std::function<void()> body);
  std::function<void()> thread_shell(process_kind kind, std::function<void()> body);

  sc_core::sc_module& module_;
  state state_ = state::unloaded;
  bool opens_ = false;    // activate() waits for the update phase
  bool leaving_ = false;  // deactivate() is in progress
  sc_core::sc_event activated_;
  sc_core::sc_event deactivated_;
  std::map<action, sc_core::sc_time> delays_;
  std::vector<holder*> holders_;
  std::vector<resettable*> resettables_;
  std::vector<std::unique_ptr<accessor>> accessors_;
  std::vector<sc_core::sc_process_handle> processes_;  // restarted at each activation
  std::vector<sc_core::sc_process_handle> spawned_;    // ended by deactivation
  std::unique_ptr<updater> updater_;
  control* control_ = nullptr;  // the one it was added to
};

/// A closed module M, untouched, made reconfigurable: `rc::reconfigurable<tri_tri> test("test");` Unloaded at first.
/// Constructors: those of M that begin with an sc_module_name. Names that M and context share have to be qualified.
template <class M>
class reconfigurable : public M, public context {
  static_assert(std::is_base_of_v<sc_core::sc_module, M>, "reconfigurable<M>: M is an sc_module");

 public:
  template <class... Args>
  explicit reconfigurable(sc_core::sc_module_name module_name, Args&&... args)
      : M(module_name, std::forward<Args>(args)...),
        context(static_cast<sc_core::sc_module&>(static_cast<M&>(*this))) {}
};

}  // namespace cchip::rc

/// Like SC_THREAD, SC_METHOD and SC_CTHREAD in the constructor of a class derived from cchip::rc::reconfigurable; reset
/// with the configuration. `sensitive <<`, dont_initialize() and reset_signal_is() may follow as usual.
#define CCHIP_RC_PROCESS(function, kind)                                                                    \
  this->sensitive << this->::cchip::rc::context::spawn(#function, ::cchip::rc::context::process_kind::kind, \
                                                       [this] { this->function(); })
#define RC_THREAD(function) CCHIP_RC_PROCESS(function, thread)
#define RC_METHOD(function) CCHIP_RC_PROCESS(function, method)
#define RC_CTHREAD(function, edge)                      \
  CCHIP_RC_PROCESS(function, clocked_thread) << (edge); \
  this->dont_initialize()

#endif
