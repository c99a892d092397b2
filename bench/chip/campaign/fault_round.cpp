// SPDX-License-Identifier: Apache-2.0
// The faults, when they begin and what they do.
#include "fault_round.hpp"

namespace cchip::testing {

void FaultRound::run() {
  from_ = bench_.queries().size();
  bench_.machine().memory().options = any_memory(random_);
  set(regs::memory_limit::offset, slow_limit);
  bench_.edit = [this](std::size_t number, Line& line) { maybe_corrupt(number, line); };
  add(batch);
  const std::uint64_t end = bench_.clocks() + round_clocks;
  bool stopped = false;
  while (!stopped && !reset_ && (bench_.unanswered() > 0 || !pending_.empty()) && bench_.clocks() < end) {
    begin_faults();
    stopped = !bench_.step();
    act();
  }
  judge(stopped, bench_.clocks() >= end);
  restore(stopped);
}

void FaultRound::add(std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    Query query = objects_.query(random_);
    query.mode = all_ ? QueryMode::all : QueryMode::first;
    bench_.submit(query);
    Expectation e;
    e.query = query;
    expected_.push_back(e);
    ++totals_.queries;
  }
}

void FaultRound::begin_faults() {
  const std::size_t answered = batch - std::min<std::size_t>(batch, bench_.unanswered());
  for (auto p = pending_.begin(); p != pending_.end();) {
    const bool now = p->phase == 0 || (p->phase == 1 && answered >= batch / 4) ||
                     (p->phase == 2 && bench_.unanswered() <= batch / 4);
    if (!now) {
      ++p;
      continue;
    }
    phase_of_[p->fault] = p->phase;
    active_.insert(p->fault);
    begin(p->fault);
    p = pending_.erase(p);
  }
}

void FaultRound::begin(Fault fault) {
  // what needs queries that have not been read yet gets some
  const bool needs_more = fault == Fault::query_error || fault == Fault::query_silence || fault == Fault::descriptor ||
                          fault == Fault::garbage || fault == Fault::read_error || fault == Fault::read_silence ||
                          fault == Fault::read_late || fault == Fault::open_limit || fault == Fault::step_limit;
  if (needs_more && phase_of_[fault] == 2) add(6);
  if (phase_of_[fault] == 2 && bench_.unanswered() == 0) add(6);
  switch (fault) {
    case Fault::read_silence:
      silent_ = 1 + random_() % 3;
      break;
    case Fault::read_late:
      late_ = 1 + random_() % 4;
      break;
    case Fault::full_ring:
    case Fault::slow_consumer:
      stops_ = fault == Fault::full_ring ? 1 : 6;
      stop_for_ = fault == Fault::full_ring ? stop_clocks_ : 200 + random_() % 5000;
      break;
    case Fault::descriptor:
      corrupt_ = 1 + random_() % 4;
      break;
    case Fault::garbage:
      bench_.hold = true;
      break;
    case Fault::open_limit:
      open_limit_ = static_cast<std::uint32_t>(random_() % 3);
      set(regs::open_limit::offset, open_limit_);
      open_limit_ = std::max(open_limit_, 1U);
      hit(fault);
      break;
    case Fault::step_limit:
      set(regs::step_limit::offset, static_cast<std::uint32_t>(random_() % 150));
      hit(fault);
      break;
    case Fault::soft_reset:
      reset_in_ = random_() % 2 == 0 ? random_() % 40 : random_() % 3000;
      break;
    default:
      break;
  }
  auto& memory = bench_.machine().memory();
  const std::uint64_t images = std::min(objects_.line_a, objects_.line_b);
  memory.read_fault = [this, images](std::uint64_t line) {
    const bool image = line >= images;
    if (image && active(Fault::read_error) && percent(random_, 3)) {
      hit(Fault::read_error);
      return sim::AxiFault::slave_error;
    }
    if (image && active(Fault::read_silence) && silent_ > 0 && percent(random_, 20)) {
      --silent_;
      lost_response_ = true;
      hit(Fault::read_silence);
      return sim::AxiFault::silence;
    }
    if (!image && active(Fault::query_error) && !ring_hit_) {
      ring_hit_ = true;
      hit(Fault::query_error);
      return sim::AxiFault::slave_error;
    }
    if (!image && active(Fault::query_silence) && !ring_hit_) {
      ring_hit_ = lost_response_ = true;
      hit(Fault::query_silence);
      return sim::AxiFault::silence;
    }
    return sim::AxiFault::none;
  };
  memory.write_fault = [this](std::uint64_t) {
    if (active(Fault::write_error) && !write_hit_) {
      write_hit_ = true;
      hit(Fault::write_error);
      return sim::AxiFault::slave_error;
    }
    if (active(Fault::write_silence) && !write_hit_) {
      write_hit_ = lost_response_ = true;
      hit(Fault::write_silence);
      return sim::AxiFault::silence;
    }
    return sim::AxiFault::none;
  };
}

void FaultRound::act() {
  if (stops_ > 0 && bench_.in_flight() > 0) {
    --stops_;
    hit(active(Fault::full_ring) ? Fault::full_ring : Fault::slow_consumer);
    for (std::uint64_t i = 0; i < stop_for_; ++i) bench_.machine().proceed();
  }
  if (late_ > 0 && bench_.in_flight() > 0) {
    // addresses of this time are answered after the limit; those before and after it are not touched
    auto& options = bench_.machine().memory().options;
    const std::uint64_t usual = options.latency;
    options.latency = 3 * slow_limit;
    hit(Fault::read_late);
    late_hit_ = true;
    --late_;
    for (int i = 0; i < 20; ++i) bench_.machine().proceed();
    options.latency = usual;
  }
  if (active(Fault::garbage) && bench_.hold && bench_.in_flight() == 0) spoil_images();
  if (active(Fault::soft_reset)) {
    if (reset_in_ > 0) {
      --reset_in_;
    } else {
      hit(Fault::soft_reset);
      reset_ = true;
    }
  }
}

void FaultRound::spoil_images() {
  for (int i = 0; i < 6; ++i) {
    bvh::Image& image = random_() % 2 == 0 ? objects_.a : objects_.b;
    Line& line = image.lines[1 + random_() % (image.lines.size() - 1)];
    if (random_() % 2 == 0) {
      for (std::uint8_t& byte : line) byte = static_cast<std::uint8_t>(random_());
    } else {
      line[random_() % line.size()] ^= static_cast<std::uint8_t>(1U << random_() % 8);
    }
  }
  bench_.port().store(static_cast<std::uint32_t>(objects_.line_a), objects_.a.lines);
  bench_.port().store(static_cast<std::uint32_t>(objects_.line_b), objects_.b.lines);
  spoiled_from_ = expected_.size() - bench_.unanswered();
  if (bench_.unanswered() > 0) hit(Fault::garbage);
  bench_.hold = false;
  active_.erase(Fault::garbage);
  garbage_ = true;
}

void FaultRound::maybe_corrupt(std::size_t number, Line& line) {
  if (!active(Fault::descriptor) || corrupt_ == 0) return;
  --corrupt_;
  hit(Fault::descriptor);
  Expectation& e = expected_[number - from_];
  const std::size_t fields = query_field::all.size();
  const std::size_t which = random_() % (fields + 1);
  if (which == fields) {  // bits that must be 0
    line[478 / 8] ^= static_cast<std::uint8_t>(0x40U << random_() % 2);
    e.ends = true;
    e.codes = {QueryCode::bad_descriptor};
    return;
  }
  const Field& field = query_field::all[which];
  const std::size_t index = random_() % field.count;
  const std::int64_t old = get(line, field, index);
  auto value = static_cast<std::int64_t>(random_() >> (64 - field.width));
  const std::string name = field.name;
  if (name == "m") {
    // a map that is far from any legal one, or near the given one: between them the driver is the gate
    value = random_() % 2 == 0 ? ((std::int64_t{1} << 30) + 1 + static_cast<std::int64_t>(random_() % 1000)) *
                                     (random_() % 2 == 0 ? 1 : -1)
                               : old + static_cast<std::int64_t>(random_() % 200) - 100;
  }
  if (name == "tag") {
    value |= std::int64_t{1} << 31;  // of no other query
    bench_.rename(static_cast<std::uint32_t>(value), number);
  }
  put(line, field, value, index);
  e.query = decode_query(line);
  if ((name == "base_a" || name == "base_b") && get(line, field, index) != old) {
    e.ends = true;
    e.codes = {QueryCode::bad_descriptor, QueryCode::memory, QueryCode::corrupt, QueryCode::outside};
  }
}

}  // namespace cchip::testing
