// SPDX-License-Identifier: Apache-2.0
#define SC_INCLUDE_DYNAMIC_PROCESSES
#include <algorithm>
#include <cchip/rc/control.hpp>
#include <memory>
#include <typeinfo>

namespace cchip::rc {
namespace {

/// Keeps the lock of a control while it lives, also if its process is cancelled meanwhile.
class locked {
 public:
  explicit locked(control& c) : control_(c) { control_.lock(); }
  ~locked() { control_.unlock(); }
  locked(const locked&) = delete;
  locked& operator=(const locked&) = delete;

 private:
  control& control_;
};

bool before_simulation() { return sc_core::sc_get_status() < sc_core::SC_START_OF_SIMULATION; }

}  // namespace

module_set& module_set::operator+=(const module_set& other) {
  for (context* module : other.modules_) {
    if (std::find(modules_.begin(), modules_.end(), module) == modules_.end()) modules_.push_back(module);
  }
  return *this;
}

control::~control() {
  for (context* module : modules_) module->control_ = nullptr;
}

void control::drop(context& module) {
  modules_.erase(std::remove(modules_.begin(), modules_.end(), &module), modules_.end());
  module.control_ = nullptr;
}

void control::add(const module_set& set) {
  for (context* module : set.modules()) {
    if (module->control_ != nullptr && module->control_ != this) {
      throw error(std::string(name()) + ": " + module->full_name() + " belongs to control " + module->control_->name() +
                  "; remove it there first");
    }
  }
  for (context* module : set.modules()) {
    if (module->control_ == nullptr) modules_.push_back(module);
    module->control_ = this;
  }
}

void control::remove(const module_set& set) {
  for (context* module : set.modules()) {
    if (module->control_ != this || module->now() != state::unloaded) {
      throw error(std::string(name()) + ": " + module->full_name() + " is " +
                  (module->control_ != this ? "not in this control" : to_name(module->now())) +
                  "; only its own unloaded modules can be removed");
    }
  }
  for (context* module : set.modules()) drop(*module);
}

void control::load(const module_set& set) { run(action::load, set); }
void control::activate(const module_set& set) { run(action::activate, set); }
void control::deactivate(const module_set& set) { run(action::deactivate, set); }
void control::unload(const module_set& set) { run(action::unload, set); }

void control::check(action a, const module_set& set) const {
  const std::string what = std::string(name()) + ": " + to_name(a);
  for (const context* module : set.modules()) {
    if (module->control_ != this)
      throw error(what + " " + module->full_name() + ", which is not in this control; add() it");
  }
  if (before_simulation()) return;
  const sc_core::sc_process_handle self = sc_core::sc_get_current_process_handle();
  const sc_core::sc_curr_proc_kind kind = self.proc_kind();
  if (sc_core::sc_get_status() != sc_core::SC_RUNNING ||
      (kind != sc_core::SC_THREAD_PROC_ && kind != sc_core::SC_CTHREAD_PROC_)) {
    throw error(what + " is not called from a thread; actions take time, call them from an SC_THREAD");
  }
  for (const context* module : set.modules()) {
    if (module->is_own(self)) {
      throw error(what + " " + module->full_name() + " is called by " + self.name() +
                  ", which ends with the module's deactivation; call it from a process outside");
    }
  }
}

void control::run(action a, const module_set& set) {
  check(a, set);
  if (before_simulation()) {
    for (context* module : set.modules()) set_initial(a, *module);
    return;
  }
  const locked guard(*this);
  if (set.modules().size() == 1) {
    run_one(a, *set.modules().front());
  } else {
    run_side_by_side(a, set);
  }
}

void control::run_side_by_side(action a, const module_set& set) {
  // shared: the calling process may be cancelled before the others have ended
  struct Join {
    std::size_t open = 0;
    std::string errors;
    sc_core::sc_event done;
  };
  const auto join = std::make_shared<Join>();
  join->open = set.modules().size();
  for (context* module : set.modules()) {
    const auto one = [this, a, module, join] {
      try {
        run_one(a, *module);
      } catch (const error& e) {
        join->errors += (join->errors.empty() ? "" : "\n") + std::string(e.what());
      }
      if (--join->open == 0) join->done.notify();
    };
    sc_core::sc_spawn(one, sc_core::sc_gen_unique_name(to_name(a)));
  }
  while (join->open != 0) sc_core::wait(join->done);
  if (!join->errors.empty()) throw error(join->errors);
}

void control::run_one(action a, context& module) {
  const auto time = [this, &module](action step) { return takes_time(module, step); };
  const bool wants_load = a == action::load || a == action::activate;
  const bool wants_deactivate = a == action::deactivate || a == action::unload;
  if (wants_load && module.now() == state::unloaded) module.load(time(action::load));
  if (a == action::activate && module.now() == state::inactive) module.activate(time(action::activate));
  if (wants_deactivate && module.now() == state::active) module.deactivate(time(action::deactivate), timeout_);
  if (a == action::unload && module.now() == state::inactive) module.unload(time(action::unload));
}

void control::set_initial(action a, context& module) {
  switch (a) {
    case action::load:
      if (module.now() == state::unloaded) module.set_initial(state::inactive);
      break;
    case action::activate:
      module.set_initial(state::active);
      break;
    case action::deactivate:
      if (module.now() == state::active) module.set_initial(state::inactive);
      break;
    case action::unload:
      module.set_initial(state::unloaded);
      break;
  }
}

void control::move(context& module, portal_group_base& to) {
  const std::string what = std::string(name()) + ": move " + module.full_name() + " to " + to.name();
  std::vector<std::pair<accessor*, portal*>> plan;
  for (const auto& a : module.accessors_) {
    portal_group_base* from = a->at() == nullptr ? nullptr : a->at()->group();
    if (from == nullptr || typeid(*from) != typeid(to)) continue;
    const auto& list = from->portals();
    const auto place = std::find(list.begin(), list.end(), a->at()) - list.begin();
    plan.emplace_back(a.get(), to.portals()[static_cast<std::size_t>(place)]);
  }
  if (plan.size() != to.portals().size()) {
    throw error(what +
                ": its ports are not bound to one group of the same type; bind it with portal_group::bind_dynamic");
  }
  const locked guard(*this);
  if (module.now() != state::unloaded) unload(module);
  for (const auto& [from, portal] : plan) {
    from->attach(*portal);
    from->reattach(*portal);
  }
}

bool control::is_mine() const {
  if (!is_locked()) return false;
  const sc_core::sc_process_handle self = sc_core::sc_get_current_process_handle();
  if (!self.valid() || !owner_.valid()) return self == owner_;
  const sc_core::sc_object* o = self.get_process_object();
  while (o != nullptr && o != owner_.get_process_object()) o = o->get_parent_object();
  return o != nullptr;
}

bool control::lock(const sc_core::sc_time& limit) {
  const sc_core::sc_time start = sc_core::sc_time_stamp();
  while (is_locked() && !is_mine()) {
    const sc_core::sc_time waited = sc_core::sc_time_stamp() - start;
    if (waited >= limit) return false;
    if (limit == sc_core::sc_max_time()) {
      sc_core::wait(unlocked_ | owner_.terminated_event());
    } else {
      sc_core::wait(limit - waited, unlocked_ | owner_.terminated_event());
    }
  }
  if (!is_locked()) {
    owner_ = sc_core::sc_get_current_process_handle();
    depth_ = 0;
  }
  ++depth_;
  return true;
}

void control::unlock() {
  if (!is_mine()) throw error(std::string(name()) + ": unlock() by a process that has not locked it");
  if (--depth_ == 0) unlocked_.notify();
}

bool control::is_locked() const { return depth_ > 0 && !(owner_.valid() && owner_.terminated()); }

}  // namespace cchip::rc
