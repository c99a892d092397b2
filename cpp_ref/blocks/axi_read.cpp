// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/blocks/axi_read.hpp>

namespace cchip::model {

void AxiRead::clock(const Inputs& in) {
  // decisions, from the present state
  const Addresses now = decide(in.arready);
  const std::optional<Failure> fail = next_failure(now.refuse);
  const auto came = rready_ && in.beat && in.beat->id < reads_.size() ? in.beat : std::nullopt;
  const auto found = found_ ? (failing_ ? found_ : std::nullopt) : late(scan_) ? std::optional(scan_) : std::nullopt;
  if (!found_) scan_ = (scan_ + 1) % reads_.size();
  clock_outstanding();

  clock_ticks();
  clock_answer();
  clock_place();
  clock_addresses(now);
  clock_requests(in.requests, now.load);
  refused_ = now.refuse;
  tick_ = timeout_.expired();
  timeout_.clock(timeout_.expired(), in.limit);
  found_ = found;

  // the read channel's place: a beat, or a failure, for which rready was 0
  failed_ = failing_;
  beat_ = came;
  failing_ = fail;
  rready_ = !fail;
}

void AxiRead::reset(std::uint32_t limit) {
  for (auto& queue : queues_) queue.reset();
  for (auto& read : reads_) read = Read{};
  outstanding_.assign(reads_.size(), false);
  next_.reset();
  head_.reset();
  address_.reset();
  issued_.reset();
  taken_.reset();
  place_.reset();
  answer_.reset();
  found_.reset();
  failing_.reset();
  failed_.reset();
  beat_.reset();
  served_ = queues_.size() - 1;
  timeout_.clock(true, limit);
  scan_ = 0;
  rready_ = any_outstanding_ = address_awaited_ = head_owed_ = was_dead_ = refused_ = tick_ = false;
}

AxiRead::Addresses AxiRead::decide(bool arready) const {
  Addresses now;
  now.dead = address_ && !address_awaited_;
  now.issue = head_ && !head_owed_ && (!address_ || (arready && address_awaited_));
  now.refuse = head_ && head_owed_ && !failing_ && !found_ && !refused_;
  now.load = !head_ || now.issue || refused_;
  now.taken = address_ && arready;
  now.next_owed = next_.m_valid() && reads_[next_.m_data().id].owed;
  return now;
}

std::optional<AxiRead::Failure> AxiRead::next_failure(bool refuse) const {
  if (found_ && !failing_) return Failure{*found_, ReadCode::timeout};
  if (refuse) return Failure{head_->id, ReadCode::owed};
  return std::nullopt;
}

void AxiRead::clock_outstanding() {
  for (std::size_t id = 0; id < reads_.size(); ++id)
    outstanding_[id] = reads_[id].owed || taken_ == id || (address_ && address_->id == id);
  any_outstanding_ =
      address_ || taken_ || std::any_of(reads_.begin(), reads_.end(), [](const Read& read) { return read.owed; });
}

void AxiRead::clock_ticks() {
  if (!tick_) return;
  for (Read& read : reads_) read.ticks = read.live ? std::min(read.ticks + 1, 2) : 0;
}

void AxiRead::clock_answer() {
  answer_.reset();
  if (!place_) return;
  if (place_->failure) {
    answer_failure(*place_->failure, place_->was);
  } else {
    answer_beat(place_->beat, place_->was);
  }
}

void AxiRead::answer_failure(const Failure& failure, const Read& was) {
  if (failure.code == ReadCode::timeout) {
    if (!was.live) return;
    reads_[failure.id].live = false;
    if (address_ && address_->id == failure.id) address_awaited_ = false;
  }
  answer_ = Answer{failure.id / slots_, failure.id % slots_, true, failure.code, std::nullopt, {}};
}

void AxiRead::answer_beat(const Beat& beat, const Read& was) {
  if (!was.owed) return;
  Read& read = reads_[beat.id];
  const bool last_one = read.count + 1 == beats_;
  read.bad = read.bad || !beat.okay;
  if (was.live) {
    const bool last = beat.last || last_one;
    const ReadCode code = read.bad || beat.last != last_one ? ReadCode::bus : ReadCode::ok;
    answer_ = Answer{beat.id / slots_, beat.id % slots_, last, code, read.count, beat.data};
    if (last) read.live = false;
  }
  ++read.count;
  if (beat.last) read.owed = false;
}

void AxiRead::clock_place() {
  // the next beat or failure sees what this one did, and not yet what happens to addresses on this clock
  place_.reset();
  if (failed_) place_ = Place{failed_, {}, reads_[failed_->id]};
  if (beat_) place_ = Place{{}, *beat_, reads_[beat_->id]};
  if (taken_) {
    Read& read = reads_[*taken_];
    read.owed = true;
    read.count = 0;
    read.bad = false;
  }
  if (issued_) {
    reads_[*issued_].live = true;
    reads_[*issued_].ticks = 0;
  }
}

void AxiRead::clock_addresses(const Addresses& now) {
  head_owed_ = now.dead || (now.load ? was_dead_ || now.next_owed : head_owed_);
  was_dead_ = now.dead;
  taken_ = now.taken ? std::optional(address_->id) : std::nullopt;
  issued_ = now.issue ? std::optional(head_->id) : std::nullopt;
  if (now.taken) address_.reset();
  if (now.issue) {
    address_ = head_;
    address_awaited_ = true;
  }
  if (now.load) head_ = next_.m_valid() ? std::optional(next_.m_data()) : std::nullopt;
}

void AxiRead::clock_requests(const std::vector<std::optional<Request>>& requests, bool load_head) {
  const std::size_t clients = queues_.size();
  const bool turn = next_.s_ready();
  std::optional<std::size_t> granted;
  for (std::size_t i = 1; i <= clients && !granted; ++i) {
    if (queues_[(served_ + i) % clients].m_valid()) granted = (served_ + i) % clients;
  }
  Address next;
  if (granted) {
    const Request& request = queues_[*granted].m_data();
    next = Address{*granted * slots_ + request.slot, request.line};
    if (turn) served_ = *granted;
  }
  next_.clock(granted.has_value(), next, load_head);
  for (std::size_t i = 0; i < clients; ++i) {
    const auto& request = requests[i];
    queues_[i].clock(request.has_value(), request.value_or(Request{}), turn && granted == i);
  }
}

}  // namespace cchip::model
