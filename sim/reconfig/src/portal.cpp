// SPDX-License-Identifier: Apache-2.0
#define SC_INCLUDE_DYNAMIC_PROCESSES
#include <algorithm>
#include <cchip/rc/portal.hpp>

namespace cchip::rc {
namespace {

constexpr edge all_edges[] = {edge::any, edge::rise, edge::fall};
constexpr std::size_t index(edge e) { return static_cast<std::size_t>(e); }

}  // namespace

accessor::accessor(context& owner, portal& at, std::string port_name)
    : owner_(owner), portal_(nullptr), port_name_(std::move(port_name)) {
  attach(at);
}

accessor::~accessor() {
  if (portal_ == nullptr) return;
  auto& list = portal_->attached_;
  list.erase(std::remove(list.begin(), list.end(), this), list.end());
  if (portal_->open_ == this) portal_->open_ = nullptr;
  if (portal_->claimed_by_ == &owner_) portal_->claimed_by_ = nullptr;
}

void accessor::attach(portal& to) {
  if (portal_ != nullptr) {
    auto& list = portal_->attached_;
    list.erase(std::remove(list.begin(), list.end(), this), list.end());
  }
  portal_ = &to;
  to.attached_.push_back(this);
  for (const edge e : all_edges) {
    if (watched_[index(e)]) to.watch(e);
  }
}

void accessor::watch(edge e) const {
  watched_[index(e)] = true;
  if (portal_ != nullptr) portal_->watch(e);
}

void accessor::open() {
  if (portal_ == nullptr || open_) return;
  open_ = true;
  portal_->open_ = this;
  opened_.notify(sc_core::SC_ZERO_TIME);
  portal_->module_opened_.notify(sc_core::SC_ZERO_TIME);
  opened();
}

void accessor::close() {
  if (portal_ == nullptr || !open_) return;
  open_ = false;
  portal_->open_ = nullptr;
  closed();
}

portal::~portal() {
  for (accessor* a : attached_) {
    a->portal_ = nullptr;
    a->open_ = false;
  }
}

void accessor::wait_for_opening_or(const sc_core::sc_event& event) {
  if (last_waited_for_ != &event) {
    waits_.emplace_back();
    waits_.back() |= opened_;
    waits_.back() |= event;
    last_waited_for_ = &event;
  }
  sc_core::wait(waits_.back());
}

bool portal::takes_calls() const { return open_ != nullptr && !open_->owner().can_leave(); }

void portal::wait_until_it_takes_calls() {
  while (!takes_calls()) {
    if (open_ == nullptr) {
      sc_core::wait(module_opened_);
    } else {
      sc_core::wait(sc_core::SC_ZERO_TIME);  // it is about to close
    }
  }
}

void portal::keep(context& owner, std::unique_ptr<accessor> made) { owner.accessors_.push_back(std::move(made)); }

context& portal::owner_of(const sc_core::sc_object& port) const {
  const std::string what = std::string(name()) + ": port " + port.name();
  if (sc_core::sc_get_status() != sc_core::SC_ELABORATION) {
    throw error(what + " is bound during simulation; bind all ports before sc_start()");
  }
  context* owner = context::of(&port);
  if (owner == nullptr) {
    throw error(what + " belongs to no reconfigurable module; derive its module with cchip::rc::reconfigurable<>");
  }
  for (const auto& a : owner->accessors_) {
    if (a->port_name() == port.name()) {
      throw error(what + " is bound to portal " + (a->at() == nullptr ? "?" : a->at()->name()) +
                  " already; a port has one portal");
    }
  }
  return *owner;
}

void following_portal::watch(edge e) {
  if (watched_[index(edge::any)] || watched_[index(e)]) return;
  watched_[index(e)] = true;
  if (elaborated_) listen(e);
}

void following_portal::refresh() {
  if (std::find(watched_.begin(), watched_.end(), true) != watched_.end()) refresh_.notify(sc_core::SC_ZERO_TIME);
}

void following_portal::end_of_elaboration() {
  SC_HAS_PROCESS(following_portal);
  SC_METHOD(pass_on);
  sensitive << refresh_;
  dont_initialize();
  elaborated_ = true;
  for (const edge e : all_edges) {
    if (watched_[index(e)]) listen(e);
  }
}

void following_portal::listen(edge e) {
  sc_core::sc_spawn_options options;
  options.spawn_method();
  options.dont_initialize();
  options.set_sensitivity(&static_event(e));
  sc_core::sc_spawn([this] { pass_on(); }, sc_core::sc_gen_unique_name("follow"), &options);
}

void following_portal::pass_on() {
  if (accessor* a = open_accessor()) a->follow();
}

}  // namespace cchip::rc
