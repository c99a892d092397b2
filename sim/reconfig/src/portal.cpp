// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/rc/portal.hpp>

namespace cchip::rc {

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

void following_portal::watch() {
  if (watched_) return;
  watched_ = true;
  refresh();
}

void following_portal::refresh() {
  if (watched_) refresh_.notify(sc_core::SC_ZERO_TIME);
}

void following_portal::end_of_elaboration() {
  watched_early_ = watched_;
  SC_HAS_PROCESS(following_portal);
  SC_METHOD(follow);
  sensitive << refresh_;
  if (watched_early_) sensitive << static_event();
  dont_initialize();
  static_or_refresh_ |= static_event();
  static_or_refresh_ |= refresh_;
}

void following_portal::follow() {
  if (accessor* a = open_accessor()) a->follow();
  if (!watched_early_) next_trigger(static_or_refresh_);
}

}  // namespace cchip::rc
