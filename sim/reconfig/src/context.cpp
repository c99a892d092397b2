// SPDX-License-Identifier: Apache-2.0
#define SC_INCLUDE_DYNAMIC_PROCESSES
#include <algorithm>
#include <cchip/rc/context.hpp>
#include <cchip/rc/portal.hpp>

namespace cchip::rc {

using sc_core::sc_time;
using sc_core::SC_ZERO_TIME;

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

context::~context() = default;

context* context::of(const sc_core::sc_object* object) {
  for (auto* o = const_cast<sc_core::sc_object*>(object); o != nullptr; o = o->get_parent_object()) {
    if (auto* found = dynamic_cast<context*>(o)) return found;
  }
  return nullptr;
}

std::string context::held_by() const {
  std::string all;
  const auto ask = [&all](const holder& h) {
    const std::string text = h.holding();
    if (!text.empty()) all += (all.empty() ? "" : "; ") + text;
  };
  for (const auto& a : accessors_) ask(*a);
  for (const holder* h : holders_) ask(*h);
  return all;
}

sc_time context::delay(action a) const {
  const auto found = delays_.find(a);
  return found == delays_.end() ? SC_ZERO_TIME : found->second;
}

void context::remove(holder& h) { holders_.erase(std::remove(holders_.begin(), holders_.end(), &h), holders_.end()); }

void context::possible_deactivation() {
  if (deactivation_pending()) {
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

sc_core::sc_process_handle context::spawn(const char* process_name, process_kind kind, std::function<void()> body) {
  const bool running = sc_core::sc_get_status() == sc_core::SC_RUNNING;
  sc_core::sc_spawn_options options;
  std::function<void()> shell;
  if (kind == process_kind::method) {
    options.spawn_method();
    shell = [this, body = std::move(body)] {
      if (is_active()) {
        body();
      } else {
        sc_core::next_trigger(activated_);
      }
    };
  } else if (running) {
    shell = std::move(body);
  } else {
    shell = [this, kind, body = std::move(body)] {
      for (;;) {
        park_until_activated(kind);
        body();
        sc_core::wait(deactivated_);  // has returned: waits for the next configuration
      }
    };
  }
  const sc_core::sc_process_handle handle =
      sc_core::sc_spawn(std::move(shell), sc_core::sc_gen_unique_name(process_name), &options);
  (running ? spawned_ : processes_).push_back(handle);
  return handle;
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
  next_ = state::inactive;
  if (delay != SC_ZERO_TIME) sc_core::wait(delay);
  state_ = state::inactive;
  on_load();
}

void context::activate(const sc_time& delay) {
  next_ = state::active;
  reset_all();
  sc_core::wait(delay);  // a delta at least
  opens_ = true;
  updater_->ask();
  sc_core::wait(activated_);
  on_activate();
}

void context::deactivate(const sc_time& delay, const sc_time& timeout) {
  const sc_time start = sc_core::sc_time_stamp();
  next_ = state::inactive;
  for (bool asked = false; state_ == state::active; asked = true) {
    const sc_time waited = sc_core::sc_time_stamp() - start;
    const std::string why = asked && waited >= timeout ? held_by() : std::string();
    if (!why.empty()) {
      next_ = state::active;
      throw error(full_name() + ": cannot be deactivated within " + timeout.to_string() + ", it is held by " + why +
                  "; it stays active");
    }
    sc_core::sc_event_or_list list = deactivated_ | again_;
    const auto follow = [&list](const holder& h) {
      if (const sc_core::sc_event* event = h.let_go()) list |= *event;
    };
    for (const auto& a : accessors_) follow(*a);
    for (const holder* h : holders_) follow(*h);
    updater_->ask();
    if (timeout == sc_core::sc_max_time()) {
      sc_core::wait(list);
    } else {
      sc_core::wait(timeout - waited, list);
    }
  }
  // copies: a reset process may end the calling one
  for (const auto& process : std::vector<sc_core::sc_process_handle>(spawned_)) {
    auto handle = process;
    if (handle.valid() && !handle.terminated()) handle.kill();
  }
  spawned_.clear();
  for (auto process : processes_) process.reset();
  if (delay != SC_ZERO_TIME) sc_core::wait(delay);
  on_deactivate();
  reset_all();
}

void context::unload(const sc_time& delay) {
  next_ = state::unloaded;
  if (delay != SC_ZERO_TIME) sc_core::wait(delay);
  state_ = state::unloaded;
  release_portals();
  on_unload();
}

void context::update() {
  if (opens_) {
    opens_ = false;
    state_ = state::active;
    for (const auto& a : accessors_) a->open();
    activated_.notify(SC_ZERO_TIME);
  } else if (deactivation_pending() && held_by().empty()) {
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
  if (state_ != state::unloaded) claim_portals();
  if (state_ != state::active) return;
  for (const auto& a : accessors_) a->open();
  activated_.notify(SC_ZERO_TIME);
}

}  // namespace cchip::rc
