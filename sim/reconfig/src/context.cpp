// SPDX-License-Identifier: Apache-2.0
#define SC_INCLUDE_DYNAMIC_PROCESSES
#include <algorithm>
#include <cchip/rc/context.hpp>
#include <cchip/rc/control.hpp>
#include <cchip/rc/portal.hpp>
#include <utility>

namespace cchip::rc {

using sc_core::sc_time;
using sc_core::SC_ZERO_TIME;

namespace {

/// Runs something at the end of its scope, also if the process is cancelled there.
template <class F>
class at_exit {
 public:
  explicit at_exit(F f) : f_(std::move(f)) {}
  ~at_exit() { f_(); }
  at_exit(const at_exit&) = delete;
  at_exit& operator=(const at_exit&) = delete;

 private:
  F f_;
};

}  // namespace

const char* to_name(state s) {
  switch (s) {
    case state::unloaded:
      return "unloaded";
    case state::inactive:
      return "inactive";
    case state::active:
      return "active";
  }
  return "?";
}

const char* to_name(action a) {
  switch (a) {
    case action::load:
      return "load";
    case action::activate:
      return "activate";
    case action::deactivate:
      return "deactivate";
    case action::unload:
      return "unload";
  }
  return "?";
}

/// The module's part in update phases and at the start of simulation.
class context::updater : public sc_core::sc_prim_channel {
 public:
  explicit updater(context& owner) : sc_prim_channel("rc_update"), owner_(owner) {}
  void ask() { request_update(); }
  const char* kind() const override { return "rc_update"; }

 protected:
  void update() override { owner_.update(); }
  void start_of_simulation() override { owner_.start(); }

 private:
  context& owner_;
};

context::context(sc_core::sc_module& module) : module_(module), updater_(std::make_unique<updater>(*this)) {}

context::~context() {
  if (control_ != nullptr) control_->drop(*this);
}

context* context::of(const sc_core::sc_object* object) {
  for (auto* o = const_cast<sc_core::sc_object*>(object); o != nullptr; o = o->get_parent_object()) {
    if (auto* found = dynamic_cast<context*>(o)) return found;
  }
  return nullptr;
}

std::string context::held_by() const {
  std::vector<std::string> reasons;  // two portals may give the same
  const auto ask = [&reasons](const holder& h) {
    std::string text = h.holding();
    if (!text.empty() && std::find(reasons.begin(), reasons.end(), text) == reasons.end()) {
      reasons.push_back(std::move(text));
    }
  };
  for (const auto& a : accessors_) ask(*a);
  for (const holder* h : holders_) ask(*h);
  std::string all;
  for (const std::string& text : reasons) all += (all.empty() ? "" : "; ") + text;
  return all;
}

sc_time context::delay(action a) const {
  const auto found = delays_.find(a);
  return found == delays_.end() ? SC_ZERO_TIME : found->second;
}

void context::remove(holder& h) { holders_.erase(std::remove(holders_.begin(), holders_.end(), &h), holders_.end()); }

void context::recheck() {
  if (deactivation_pending()) updater_->ask();
}

void context::possible_deactivation() {
  if (can_leave()) {
    recheck();
    sc_core::wait(SC_ZERO_TIME);
  }
  while (!is_active()) sc_core::wait(activated_);
}

// ---- processes

void context::park_until_activated(process_kind kind) {
  if (is_active()) return;
  while (!is_active()) sc_core::wait(activated_);
  if (kind == process_kind::clocked_thread) sc_core::wait();  // a clocked process starts with an edge
}

std::function<void()> context::method_shell(std::function<void()> body) {
  return [this, body = std::move(body)] {
    if (is_active()) {
      body();
    } else if (!sc_core::sc_get_current_process_b()->dont_initialize()) {
      sc_core::next_trigger(activated_);
    }
  };
}

std::function<void()> context::thread_shell(process_kind kind, std::function<void()> body) {
  return [this, kind, body = std::move(body)] {
    for (;;) {
      park_until_activated(kind);
      body();
      sc_core::wait(deactivated_);  // has returned: waits for the next configuration
    }
  };
}

sc_core::sc_process_handle context::spawn(const char* process_name, process_kind kind, std::function<void()> body) {
  const bool running = sc_core::sc_get_status() == sc_core::SC_RUNNING;
  sc_core::sc_spawn_options options;
  if (kind == process_kind::method) {
    options.spawn_method();
    body = method_shell(std::move(body));
  } else if (running) {
    body = [this, kind, once = std::move(body)] {
      park_until_activated(kind);
      once();
    };
  } else {
    body = thread_shell(kind, std::move(body));
  }
  const auto handle = sc_core::sc_spawn(std::move(body), sc_core::sc_gen_unique_name(process_name), &options);
  const auto ended = [](const sc_core::sc_process_handle& process) { return process.terminated(); };
  spawned_.erase(std::remove_if(spawned_.begin(), spawned_.end(), ended), spawned_.end());
  (running ? spawned_ : processes_).push_back(handle);
  return handle;
}

bool context::is_own(const sc_core::sc_process_handle& process) const {
  const auto has = [&process](const auto& list) { return std::find(list.begin(), list.end(), process) != list.end(); };
  return has(processes_) || has(spawned_);
}

void context::cancel_processes() {
  for (auto& process : std::exchange(spawned_, {})) {
    if (process.valid() && !process.terminated()) process.kill();
  }
  for (auto& process : processes_) process.reset();
}

// ---- actions

void context::claim_portals() {
  for (const auto& a : accessors_) {
    if (a->at() == nullptr) continue;
    const context* other = a->at()->claimed_by_;
    if (other != nullptr && other != this) {
      throw error(full_name() + ": cannot be loaded, portal " + a->at()->name() + " is in use by " +
                  other->full_name() + "; unload that first");
    }
  }
  for (const auto& a : accessors_) {
    if (a->at() != nullptr) a->at()->claimed_by_ = this;
  }
}

void context::release_portals() {
  for (const auto& a : accessors_) {
    if (a->at() != nullptr && a->at()->claimed_by_ == this) a->at()->claimed_by_ = nullptr;
  }
}

void context::reset_all() {
  for (resettable* r : resettables_) r->reset();
}

void context::load(const sc_time& delay) {
  claim_portals();
  const at_exit undo([this] {
    if (state_ == state::unloaded) release_portals();
  });
  if (delay != SC_ZERO_TIME) sc_core::wait(delay);
  state_ = state::inactive;
  on_load();
}

void context::activate(const sc_time& delay) {
  reset_all();
  sc_core::wait(delay);  // a delta at least
  opens_ = true;
  updater_->ask();
  sc_core::wait(activated_);
  on_activate();
}

void context::deactivate(const sc_time& delay, const sc_time& timeout) {
  const sc_time start = sc_core::sc_time_stamp();
  sc_core::wait(SC_ZERO_TIME);  // what is written in this evaluation phase holds the module, too
  leaving_ = true;
  const at_exit given_up([this] { leaving_ = false; });
  updater_->ask();
  while (state_ == state::active) {
    const sc_time waited = sc_core::sc_time_stamp() - start;
    wait_for_holders(timeout == sc_core::sc_max_time() ? timeout : timeout - waited);
    if (state_ != state::active) break;
    const std::string why = held_by();
    if (!why.empty() && sc_core::sc_time_stamp() - start >= timeout) {
      throw error(full_name() + ": cannot be deactivated within " + timeout.to_string() + ", it is held by " + why +
                  "; it stays active");
    }
    updater_->ask();
  }
  cancel_processes();
  if (delay != SC_ZERO_TIME) sc_core::wait(delay);
  on_deactivate();
  reset_all();
}

void context::wait_for_holders(const sc_time& limit) {
  sc_core::sc_event_or_list list;
  list |= deactivated_;
  const auto follow = [&list](const holder& h) {
    if (const sc_core::sc_event* event = h.let_go()) list |= *event;
  };
  for (const auto& a : accessors_) follow(*a);
  for (const holder* h : holders_) follow(*h);
  if (limit == sc_core::sc_max_time()) {
    sc_core::wait(list);
  } else {
    sc_core::wait(limit, list);
  }
}

void context::unload(const sc_time& delay) {
  if (delay != SC_ZERO_TIME) sc_core::wait(delay);
  state_ = state::unloaded;
  release_portals();
  on_unload();
}

void context::become_active() {
  for (const auto& a : accessors_) a->open();
  for (resettable* r : resettables_) r->activated();
  activated_.notify(SC_ZERO_TIME);
}

void context::update() {
  if (opens_) {
    opens_ = false;
    state_ = state::active;
    become_active();
  } else if (can_leave()) {
    state_ = state::inactive;
    for (const auto& a : accessors_) a->close();
    deactivated_.notify(SC_ZERO_TIME);
  }
}

void context::collect_resettables(const sc_core::sc_object& object) {
  for (sc_core::sc_object* child : object.get_child_objects()) {
    if (dynamic_cast<context*>(child) != nullptr) continue;  // has its own
    if (auto* r = dynamic_cast<resettable*>(child)) resettables_.push_back(r);
    collect_resettables(*child);
  }
}

void context::start() {
  collect_resettables(module_);
  for (resettable* r : resettables_) r->store_reset_value();
  for (const auto& a : accessors_) a->started();
  if (state_ != state::unloaded) claim_portals();
  if (state_ == state::active) become_active();
}

}  // namespace cchip::rc
