// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/blocks/axi_write.hpp>
#include <utility>

namespace cchip::model {

void AxiWrite::clock(const Inputs& in) {
  const Decisions now = decide();
  // what the next clock does with a beat
  const bool pops = take_ && beats_.m_valid() && (data_.s_ready() || !now.awaited);
  const bool sends = send_ && data_.s_ready() && (beats_.m_valid() || !now.awaited);
  const bool busy = std::exchange(pops_, pops) || sends_;
  sends_ = sends;
  if (busy) pops_ = sends_ = false;
  clock_answer(now);
  clock_responses(now, in);
  clock_channels(now, in);
  clock_head(now);
  clock_waiting(now, in.limit);
  clock_clients(in.beats, now);
}

void AxiWrite::reset(std::uint32_t limit) {
  *this = AxiWrite(clients_, line_, outstanding_);
  timeout_.clock(true, limit);
}

AxiWrite::Decisions AxiWrite::decide() const {
  Decisions now;
  now.awaited = !waiting_.empty();
  now.counts = response_ && addresses_taken_ != 0 && bursts_taken_ != 0;
  now.answered = now.counts && dropped_ == 0;
  now.timeout = !now.answered && now.awaited && waiting_.front().ticks == 2;

  now.pop = pops_;
  now.send = sends_;
  const bool free = !take_ || (now.pop && take_->left == 0);
  now.refuse = writes_.m_valid() && free && dropped_ != 0 && !now.awaited;
  now.issue = writes_.m_valid() && free && dropped_ == 0 && waiting_.size() < outstanding_ && addresses_.s_ready();
  now.refused = now.pop && take_->left == 0 && take_->refused;
  return now;
}

void AxiWrite::clock_answer(const Decisions& now) {
  any_outstanding_ = now.awaited || dropped_ != 0;
  answer_.reset();
  if (now.refused) {
    answer_ = Answer{take_->client, WriteCode::owed};
  } else if (now.answered) {
    answer_ = Answer{waiting_.front().client, *response_ ? WriteCode::ok : WriteCode::bus};
  } else if (now.timeout) {
    answer_ = Answer{waiting_.front().client, WriteCode::timeout};
  }
}

void AxiWrite::clock_responses(const Decisions& now, const Inputs& in) {
  if (address_taken_) ++addresses_taken_;
  if (burst_taken_) ++bursts_taken_;
  if (now.counts) {
    --addresses_taken_;
    --bursts_taken_;
  }
  address_taken_ = awvalid() && in.awready;
  burst_taken_ = wvalid() && data().last && in.wready;
  response_.reset();
  if (bready_ && in.response && in.response->own) response_ = in.response->okay;
  bready_ = true;
}

void AxiWrite::clock_channels(const Decisions& now, const Inputs& in) {
  const Address address = writes_.m_valid() ? writes_.m_data().address : Address{};
  addresses_.clock(now.issue, address, in.awready);
  Data word;
  if (now.awaited && beats_.m_valid()) word = beats_.m_data();
  word.last = now.send && *send_ == 0;
  data_.clock(now.send, word, in.wready);
}

void AxiWrite::clock_head(const Decisions& now) {
  if (now.pop) {
    if (take_->left == 0) {
      take_.reset();
    } else {
      --take_->left;
    }
  }
  if (now.send) {
    if (*send_ == 0) {
      send_.reset();
    } else {
      --*send_;
    }
  }
  if (now.issue || now.refuse) {
    const Write& write = writes_.m_data();
    take_ = Take{write.address.beats - 1, now.refuse, write.client};
    if (now.issue) send_ = write.address.beats - 1;
  }
}

void AxiWrite::clock_waiting(const Decisions& now, std::uint32_t limit) {
  if (timeout_.expired()) {
    for (Waiting& one : waiting_) one.ticks = std::min(one.ticks + 1, 2);
  }
  timeout_.clock(timeout_.expired(), limit);
  if (now.answered || now.timeout) waiting_.pop_front();
  if (now.issue) waiting_.push_back(Waiting{writes_.m_data().client, 0});
  if (now.timeout) ++dropped_;
  if (now.counts && !now.answered) --dropped_;
}

void AxiWrite::clock_clients(const std::vector<std::optional<Beat>>& beats, const Decisions& now) {
  writes_.clock(in_ && in_->last, current_, now.issue || now.refuse);
  beats_.clock(in_.has_value(), in_.value_or(Data{}), now.pop);
  in_.reset();
  const bool room = held_ <= 13;
  if (now.pop) --held_;
  if (ready_ && beats[*ready_]) {
    const Beat& beat = *beats[*ready_];
    if (!begun_) current_ = Write{*ready_, {beat.address, 0}};
    ++current_.address.beats;
    const bool last = beat.last || (current_.address.address + current_.address.beats) % line_ == 0;
    in_ = Data{beat.data, beat.strobes, last};
    begun_ = !last;
    ++held_;
  }
  if (!begun_) choose_turn(beats, room);
  ready_ = room ? turn_ : std::nullopt;
}

void AxiWrite::choose_turn(const std::vector<std::optional<Beat>>& beats, bool room) {
  turn_.reset();
  for (std::size_t i = 1; i <= clients_ && !turn_; ++i) {
    if (beats[(served_ + i) % clients_]) turn_ = (served_ + i) % clients_;
  }
  if (room && turn_) served_ = *turn_;
}

}  // namespace cchip::model
