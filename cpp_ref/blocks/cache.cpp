// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/blocks/cache.hpp>
#include <iterator>
#include <utility>

namespace cchip::model {

Cache::Cache(const Shape& shape)
    : shape_(shape),
      fill_(shape.misses, shape.beats),
      entries_(shape.sets),
      data_(2 * shape.sets),
      retried_(2 * shape.places) {
  reset();
}

void Cache::clock(const Inputs& in) {
  const Decisions now = decide();
  const bool serves = ports_[0].serve || ports_[1].serve;
  CacheFill::Inputs to_fill;
  to_fill.serving = serving();
  to_fill.free_take = now.granted.has_value();
  if (read_) to_fill.allocate = CacheFill::Allocation{read_->place, allocate_frame_};
  to_fill.beat = std::exchange(beat_, in.beat);
  to_fill.outstanding = in.outstanding;
  to_fill.free = rests(0);

  clock_turn();
  std::array<Step, 2> first;
  for (std::size_t p = 0; p < 2; ++p) {
    const Request decided = ports_[p].decided.value_or(Request{});
    const bool again = answer(p, now);
    first[p] = enter(p, in.requests[p], again, decided);
    clock_waiters(p, now, first[p].kind == Kind::serve);
    clock_steps(p, in.locks);
  }
  const Step& fill5 = ports_[0].steps[4];
  if (fill5.kind == Kind::own) {
    to_fill.filled = CacheFill::Fill{fill5.slot, fill5.code, 2 * set_of(fill5) + fill5.way};
    if (fill5.code == ReadCode::ok) data_[to_fill.filled->frame] = fill_.data(fill5.slot);
  }
  clock_entries(now);
  was_running_ = running_;
  walk_enters_ = walk_valid_;
  entering_set_ = walk_set_;
  clock_walk(in.invalidate, now);
  served_ = serves;

  read_.reset();
  if (now.granted) {
    const Step& step = ports_[*now.granted].steps[5];
    read_ = Request{*fill_.free_slot(), step.line};
    allocate_frame_ = 2 * set_of(step) + *step.victim;
  }
  fill_.clock(to_fill);
  for (std::size_t p = 0; p < 2; ++p) {
    auto& steps = ports_[p].steps;
    steps = {first[p], steps[0], steps[1], steps[2], steps[3], steps[4]};
  }
}

void Cache::reset() {
  for (Port& port : ports_) port = Port(shape_.places);
  fill_.reset();
  change_.reset();
  read_.reset();
  answers_ = {};
  beat_.reset();
  counts_ = {};
  oldest_ = 0;
  age_ = 0;
  alone_ = was_alone_ = false;
  retried_.assign(retried_.size(), false);
  favour_ = running_ = ready_ = walk_valid_ = false;
  look_ = seen_retried_ = was_running_ = walk_enters_ = served_ = false;
  state_ = State::clear;
  walk_set_ = 0;
  left_ = shape_.sets - 1;
}

/// Ports that have not served all who wait.
bool Cache::serving() const {
  return !ports_[0].wake.empty() || !ports_[1].wake.empty() ||
         ((fill_.fill(rests(0)) || !takes(0)) && ports_[0].serve) || ((walk_enters_ || !takes(1)) && ports_[1].serve);
}

/// Stage 6.
Cache::Decisions Cache::decide() {
  Decisions now;
  std::array<bool, 2> want{};  // a frame
  for (std::size_t p = 0; p < 2; ++p) {
    Step& step = ports_[p].steps[5];
    step.stale = step.stale || changes(step);
    now.fresh[p] = step.kind == Kind::look && !step.stale;
    now.wait[p] = now.fresh[p] && step.wait;
    now.hit[p] = now.fresh[p] && step.match && !step.wait;
    want[p] = now.fresh[p] && !step.match && step.victim && fill_.free_slot() && !fill_.exhausted() &&
              (!was_alone_ || was_oldest_ == p * shape_.places + step.place);
  }
  const Step& fill6 = ports_[0].steps[5];
  const Step& walk6 = ports_[1].steps[5];
  now.kill = fill6.kind == Kind::own && fill6.code != ReadCode::ok;
  const bool drops = walk6.forget[0] || walk6.forget[1];
  now.walk_seen = walk6.kind == Kind::own;
  now.walk_next = now.walk_seen && !walk6.stale && !(now.kill && drops);
  now.walk_write = now.walk_next && drops;
  if (want[0] && !now.walk_write && !(want[1] && favour_)) now.granted = 0;
  if (want[1] && !now.kill && !(want[0] && !favour_)) now.granted = 1;
  if (want[0] && want[1]) favour_ = !favour_;
  return now;
}

/// Whose turn it is of those that are looked up again.
void Cache::clock_turn() {
  was_alone_ = alone_;  // stage 6 goes by what was so a clock before
  was_oldest_ = oldest_;
  // a flag is read on one clock, and acted upon on the next
  const bool retried = std::exchange(seen_retried_, retried_[oldest_]);
  look_ = !look_;
  if (look_) return;
  if (retried) {
    alone_ = age_ == 31;
    age_ = std::min(age_ + 1, 31);
  } else {
    oldest_ = (oldest_ + 1) % retried_.size();
    age_ = 0;
    alone_ = false;
  }
}

/// Stage 7. Returns whether its request is to be looked up again, as stage 6 decided on the last clock.
bool Cache::answer(std::size_t p, const Decisions& now) {
  const Step& step = ports_[p].steps[5];
  const bool grant = now.granted == p;
  const bool exhausted = fill_.exhausted();
  const bool again = step.kind == Kind::look && (step.stale || (!step.match && !grant && !exhausted));
  Port& port = ports_[p];
  if (port.decided) retried_[p * shape_.places + port.decided->place] = port.looks_again;
  port.decided.reset();
  if (step.kind == Kind::look) port.decided = Request{step.place, step.line};
  answers_[p].reset();
  if (now.hit[p]) answers_[p] = Answer{step.place, ReadCode::ok, step.data};
  if (now.fresh[p] && !step.match && exhausted) answers_[p] = Answer{step.place, ReadCode::owed, {}};
  if (step.kind == Kind::serve) answers_[p] = Answer{step.place, step.code, step.data};
  counts_[p] = Counts{now.hit[p], grant, now.wait[p], again};
  return std::exchange(port.looks_again, again);
}

/// Stage 0: who has this clock.
Cache::Step Cache::enter(std::size_t p, const std::optional<Request>& ask, bool again, const Request& again7) {
  Port& port = ports_[p];
  const std::optional<CacheFill::Fill> fill = fill_.fill(rests(0));
  const bool own = p == 0 ? fill.has_value() : walk_enters_;
  const bool go = takes(p) && was_running_ && !own && !port.serve;
  const bool late = port.late.m_valid();
  const bool use_again = port.again.m_valid() && (port.again_first || !late);
  const bool use_late = !use_again && late;
  const bool use_ask = !use_again && !late && ask;
  if (go && port.again.m_valid()) port.again_first = !use_again;
  Step step;
  if (own) {
    step.kind = Kind::own;
    step.line = entering_set_;
    if (p == 0) {
      step.line = fill->frame / 2;
      step.way = fill->frame % 2;
      step.slot = fill->slot;
      step.code = fill->code;
    }
  } else if (port.serve && takes(p)) {
    step = *port.serve;
  } else if (go && (use_again || use_late || use_ask)) {
    const Request& request = use_again ? port.again.m_data() : use_late ? port.late.m_data() : *ask;
    step.kind = Kind::look;
    step.place = request.place;
    step.line = request.line;
  }
  port.late.clock(ask && !(go && use_ask), ask.value_or(Request{}), go && !use_again);
  port.again.clock(again, again7, go && use_again);
  return step;
}

/// Who waits for a line in flight; whose line has come; who is served next.
void Cache::clock_waiters(std::size_t p, const Decisions& now, bool served) {
  Port& port = ports_[p];
  const auto& line = fill_.serves();
  if (!port.serve || served) {
    port.serve.reset();
    if (!port.wake.empty()) {
      port.serve = Step();  // clang 14 knows no emplace() without arguments inside the class
      port.serve->kind = Kind::serve;
      port.serve->place = *port.wake.begin();
      port.serve->line = line->frame / 2;
      port.serve->way = line->frame % 2;
      port.serve->code = line->code;
      port.wake.erase(port.wake.begin());
    }
  }
  if (fill_.collect()) {
    for (const auto& [place, slot] : port.asleep) {
      if (slot == line->slot) port.wake.insert(place);
    }
    for (const std::size_t place : port.wake) port.asleep.erase(place);
  }
  const Step& step6 = port.steps[5];
  const bool grant = now.granted == p;
  if (port.sleeps) port.asleep[port.sleeps->first] = port.sleeps->second;
  port.sleeps.reset();
  if (now.wait[p] || grant) port.sleeps.emplace(step6.place, grant ? *fill_.free_slot() : step6.wait_slot);
}

/// Stages 1 to 5: the entries are read in 1.
void Cache::clock_steps(std::size_t p, const std::vector<Range>& locks) {
  auto& steps = ports_[p].steps;
  steps[0].entries = entries_[set_of(steps[0])];
  for (std::size_t s = 0; s < 5; ++s) steps[s].stale = steps[s].stale || changes(steps[s]);
  for (const Range& range : locks) steps[0].locks = steps[0].locks || range.has(steps[0].line);
  look_up(steps[3]);
  judge(steps[4]);
  steps[4].data = data_[2 * set_of(steps[4]) + steps[4].way];
}

/// Stage 4.
void Cache::look_up(Step& step) const {
  for (std::size_t w = 0; w < 2; ++w) {
    const std::size_t slot = step.entries[w].slot;
    step.holds[w] = fill_.holds(slot, 2 * set_of(step) + w);
    step.filled[w] = fill_.filled(slot);
  }
}

/// Stage 5.
void Cache::judge(Step& step) const {
  std::array<bool, 2> may{};
  step.victim.reset();
  for (std::size_t w = 0; w < 2; ++w) {
    const Entry& entry = step.entries[w];
    const bool holds = step.holds[w];
    step.forget[w] = entry.valid && walk_range_.has(entry.line);
    may[w] = !holds && !entry.locked;
    if (step.kind != Kind::look || !entry.valid || entry.line != step.line) continue;
    step.match = true;
    step.way = w;
    if (holds && !step.filled[w]) {
      step.wait = true;
      step.wait_slot = entry.slot;
    }
  }
  const auto& [a, b] = step.entries;
  if (may[0] || may[1]) {
    step.victim = !may[0] ? 1 : !may[1] ? 0 : !a.valid ? 0 : !b.valid ? 1 : a.turn != b.turn ? 1 : 0;
    const Entry& other = step.entries[1 - *step.victim];
    step.locks = step.locks && !other.locked;
    step.turn = (*step.victim == 0) != other.turn;
  }
}

/// The change of the entries that this clock shows comes into force, and the next one is made.
void Cache::clock_entries(const Decisions& now) {
  if (change_) {
    for (std::size_t w = 0; w < 2; ++w) {
      if (change_->ways[w]) entries_[change_->set][w] = change_->entries[w];
    }
  }
  change_.reset();
  const Step& fill6 = ports_[0].steps[5];
  const Step& walk6 = ports_[1].steps[5];
  if (!running_) {
    change_ = Change{walk_set_, {true, true}, {}};
  } else if (now.kill) {
    change_ = Change{set_of(fill6), {fill6.way == 0, fill6.way == 1}, {}};
    change_->entries[fill6.way].slot = fill6.slot;
  } else if (now.walk_write) {
    change_ = Change{set_of(walk6), {walk6.forget[0], walk6.forget[1]}, walk6.entries};
    for (Entry& entry : change_->entries) entry.valid = entry.locked = false;
  } else if (now.granted) {
    const Step& step = ports_[*now.granted].steps[5];
    change_ = Change{set_of(step), {*step.victim == 0, *step.victim == 1}, {}};
    change_->entries[*step.victim] = Entry{true, step.locks, step.turn, *fill_.free_slot(), step.line};
  }
}

/// The walk of an invalidation: one set after the other. It is over when the reads that were in flight at its last set
/// have answered.
void Cache::clock_walk(const std::optional<Range>& invalidate, const Decisions& now) {
  const bool last = left_ == 0;
  if (state_ == State::reads) {
    if (old_.empty() && !served_) state_ = State::answers;
    for (auto slot = old_.begin(); slot != old_.end();) slot = fill_.held(*slot) ? std::next(slot) : old_.erase(slot);
    clocks_ = 7;
    return;
  }
  old_.clear();
  for (std::size_t slot = 0; slot < shape_.misses; ++slot) {
    if (fill_.held(slot)) old_.insert(slot);
  }
  walk_valid_ = false;
  switch (state_) {
    case State::clear:
      next_set();
      if (last) {
        state_ = State::idle;
        running_ = ready_ = true;
      }
      break;
    case State::idle:
      if (!invalidate) break;
      walk_range_ = *invalidate;
      walk_set_ = invalidate->first % shape_.sets;
      left_ = std::min<std::uint64_t>(invalidate->last - invalidate->first, shape_.sets - 1);
      ready_ = false;
      state_ = State::ask;
      break;
    case State::ask:
      walk_valid_ = true;
      state_ = State::see;
      break;
    case State::see:
      if (!now.walk_seen) break;
      state_ = now.walk_next && last ? State::reads : State::ask;
      if (now.walk_next) next_set();
      break;
    default:
      if (clocks_-- != 0) break;
      state_ = State::idle;
      ready_ = true;
  }
}

void Cache::next_set() {
  walk_set_ = (walk_set_ + 1) % shape_.sets;
  left_ = (left_ + shape_.sets - 1) % shape_.sets;
}

}  // namespace cchip::model
