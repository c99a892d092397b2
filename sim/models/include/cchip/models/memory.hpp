// SPDX-License-Identifier: Apache-2.0
/// \file
/// Clock-exact models of the blocks in rtl/memory. Moore machines, like those in stream.hpp.
#ifndef CCHIP_MODELS_MEMORY_HPP
#define CCHIP_MODELS_MEMORY_HPP

#include <algorithm>
#include <array>
#include <cchip/model/stream.hpp>
#include <cchip/wire/definitions.hpp>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace cchip::model {

/// 64 bytes, or the part of them that a beat carries; the lowest address first.
using LineData = std::array<std::uint32_t, 16>;

/// cchip_axi_read: lines for several clients from a memory that answers in any order.
class AxiRead {
 public:
  struct Request {
    std::size_t slot = 0;
    std::uint64_t line = 0;  ///< address / 64
  };
  struct Beat {
    std::size_t id = 0;
    LineData data{};
    bool okay = true;
    bool last = false;
  };
  struct Inputs {
    std::uint32_t limit = 0;
    std::vector<std::optional<Request>> requests;  ///< one for each client
    bool arready = false;
    std::optional<Beat> beat;  ///< rvalid = 1
  };
  struct Address {
    std::size_t id = 0;
    std::uint64_t line = 0;
  };
  struct Answer {
    std::size_t client = 0;
    std::size_t slot = 0;
    bool last = false;
    ReadCode code = ReadCode::ok;     ///< defined if last
    std::optional<std::size_t> beat;  ///< without: an answer without data
    LineData data{};
  };

  /// \param beats of a line
  AxiRead(std::size_t clients, std::size_t slots, std::size_t beats)
      : slots_(slots),
        beats_(beats),
        queues_(clients, Fifo<Request>(slots)),
        reads_(clients * slots),
        outstanding_(reads_.size()) {}

  const std::optional<Answer>& answer() const { return answer_; }
  const std::optional<Address>& address() const { return address_; }
  bool rready() const { return rready_; }
  bool any_outstanding() const { return any_outstanding_; }
  /// Of each ID: its address is on offer, or memory owes it a response.
  const std::vector<bool>& outstanding() const { return outstanding_; }

  void clock(const Inputs& in) {
    for (std::size_t id = 0; id < reads_.size(); ++id)
      outstanding_[id] = reads_[id].owed || taken_ == id || (address_ && address_->id == id);
    // decisions, from the present state
    const bool dead = address_ && !address_awaited_;
    const bool issue = head_ && !head_owed_ && (!address_ || (in.arready && address_awaited_));
    const bool refuse = head_ && head_owed_ && !failing_ && !found_;
    const bool taken = address_ && in.arready;
    const bool next_owed = next_.m_valid() && reads_[next_.m_data().id].owed;
    std::optional<Failure> fail;
    if (found_ && !failing_) {
      fail = Failure{*found_, ReadCode::timeout};
    } else if (refuse) {
      fail = Failure{head_->id, ReadCode::owed};
    }
    const auto found = found_ ? (failing_ ? found_ : std::nullopt) : late(scan_) ? std::optional(scan_) : std::nullopt;
    const std::size_t scan = found_ ? scan_ : (scan_ + 1) % reads_.size();
    const auto place_beat = rready_ && in.beat && in.beat->id < reads_.size() ? in.beat : std::nullopt;
    any_outstanding_ =
        address_ || taken_ || std::any_of(reads_.begin(), reads_.end(), [](const Read& read) { return read.owed; });

    if (timeout_.expired()) {
      for (Read& read : reads_) read.ticks = read.live ? std::min(read.ticks + 1, 2) : 0;
    }
    answer_.reset();
    if (place_) answer_place(*place_);

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

    // addresses
    const bool load = !head_ || issue || refuse;
    head_owed_ = dead || (load ? was_dead_ || next_owed : head_owed_);
    was_dead_ = dead;
    taken_ = taken ? std::optional(address_->id) : std::nullopt;
    issued_ = issue ? std::optional(head_->id) : std::nullopt;
    if (taken) address_.reset();
    if (issue) {
      address_ = head_;
      address_awaited_ = true;
    }
    if (load) head_ = next_.m_valid() ? std::optional(next_.m_data()) : std::nullopt;
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
    next_.clock(granted.has_value(), next, load);
    for (std::size_t i = 0; i < clients; ++i) {
      const auto& request = in.requests[i];
      queues_[i].clock(request.has_value(), request.value_or(Request{}), turn && granted == i);
    }

    // time
    timeout_.clock(timeout_.expired(), in.limit);
    scan_ = scan;
    found_ = found;

    // the read channel
    failed_ = failing_;
    beat_ = place_beat;
    failing_ = fail;
    rready_ = !fail;
  }

  void reset(std::uint32_t limit) {
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
    rready_ = any_outstanding_ = address_awaited_ = head_owed_ = was_dead_ = false;
  }

 private:
  struct Read {
    bool live = false;  // the client waits
    bool owed = false;  // memory has beats to send
    int ticks = 0;      // seen while live, at most 2
    std::size_t count = 0;
    bool bad = false;
  };
  struct Failure {
    std::size_t id;
    ReadCode code;
  };
  struct Place {  // a beat or a failure, with what was known of its read when it came
    std::optional<Failure> failure;
    Beat beat;
    Read was;
  };

  bool late(std::size_t id) const { return reads_[id].live && reads_[id].ticks == 2; }

  void answer_place(const Place& place) {
    if (!place.failure) {
      answer_beat(place.beat, place.was);
      return;
    }
    const Failure& failure = *place.failure;
    if (failure.code == ReadCode::timeout) {
      if (!place.was.live) return;
      reads_[failure.id].live = false;
      if (address_ && address_->id == failure.id) address_awaited_ = false;
    }
    answer_ = Answer{failure.id / slots_, failure.id % slots_, true, failure.code, std::nullopt, {}};
  }

  void answer_beat(const Beat& beat, const Read& was) {
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

  std::size_t slots_;
  std::size_t beats_;
  std::vector<Fifo<Request>> queues_;
  std::vector<Read> reads_;
  std::vector<bool> outstanding_;
  std::size_t served_ = 0;
  SkidBuffer<Address> next_;
  std::optional<Address> head_, address_;
  bool head_owed_ = false;  // or an address in front of it was given up
  bool was_dead_ = false;
  bool address_awaited_ = false;
  std::optional<std::size_t> issued_, taken_;  // on the last clock
  std::optional<Answer> answer_;
  Timeout timeout_{defs::memory_limit_default};
  bool rready_ = false, any_outstanding_ = false;
  std::size_t scan_ = 0;
  std::optional<std::size_t> found_;
  std::optional<Failure> failing_, failed_;
  std::optional<Beat> beat_;
  std::optional<Place> place_;
};

/// cchip_axi_write: writes of several clients, within a line each, into a memory that answers in order.
class AxiWrite {
 public:
  struct Beat {
    std::uint64_t address = 0;  ///< in beats; counts on the first beat of a write
    LineData data{};
    std::uint64_t strobes = 0;
    bool last = false;
  };
  struct Response {
    bool own = true;  ///< the ID is 0
    bool okay = true;
  };
  struct Inputs {
    std::uint32_t limit = 0;
    std::vector<std::optional<Beat>> beats;  ///< offered, one for each client
    bool awready = false;
    bool wready = false;
    std::optional<Response> response;  ///< bvalid = 1
  };
  struct Address {
    std::uint64_t address = 0;  ///< in beats
    std::size_t beats = 0;
  };
  struct Data {
    std::optional<LineData> data;  ///< without: the client of the write has been answered, nothing is written
    std::uint64_t strobes = 0;
    bool last = false;
  };
  struct Answer {
    std::size_t client = 0;
    WriteCode code = WriteCode::ok;
  };

  /// \param beats of a line
  AxiWrite(std::size_t clients, std::size_t beats, std::size_t outstanding)
      : clients_(clients), line_(beats), outstanding_(outstanding) {}

  /// Client whose beat is taken.
  const std::optional<std::size_t>& ready() const { return ready_; }
  const std::optional<Answer>& answer() const { return answer_; }
  bool awvalid() const { return addresses_.m_valid(); }
  const Address& address() const { return addresses_.m_data(); }
  bool wvalid() const { return data_.m_valid(); }
  const Data& data() const { return data_.m_data(); }
  bool bready() const { return bready_; }
  bool any_outstanding() const { return any_outstanding_; }

  void clock(const Inputs& in) {
    // what becomes of the writes in flight
    const bool counts = response_ && addresses_taken_ != 0 && bursts_taken_ != 0;
    const bool answered = counts && dropped_ == 0;
    const bool timeout = !answered && !waiting_.empty() && waiting_.front().ticks == 2;

    // the head of the queues
    const bool awaited = !waiting_.empty();
    const bool pop = take_ && beats_.m_valid() && (data_.s_ready() || !awaited);
    const bool send = send_ && data_.s_ready() && (beats_.m_valid() || !awaited);
    const bool free = !take_ || (pop && take_->left == 0);
    const bool refuse = writes_.m_valid() && free && dropped_ != 0 && !awaited;
    const bool issue =
        writes_.m_valid() && free && dropped_ == 0 && waiting_.size() < outstanding_ && addresses_.s_ready();
    const bool refused = pop && take_->left == 0 && take_->refused;
    const Write write = writes_.m_valid() ? writes_.m_data() : Write{};
    const Data word = beats_.m_valid() ? beats_.m_data() : Data{};

    any_outstanding_ = awaited || dropped_ != 0;
    answer_.reset();
    if (refused) {
      answer_ = Answer{take_->client, WriteCode::owed};
    } else if (answered) {
      answer_ = Answer{waiting_.front().client, *response_ ? WriteCode::ok : WriteCode::bus};
    } else if (timeout) {
      answer_ = Answer{waiting_.front().client, WriteCode::timeout};
    }

    // to memory
    const bool address_taken = awvalid() && in.awready;
    const bool burst_taken = wvalid() && data().last && in.wready;
    addresses_.clock(issue, write.address, in.awready);
    data_.clock(send, Data{awaited ? word.data : std::nullopt, awaited ? word.strobes : 0, send && *send_ == 0},
                in.wready);
    if (pop) {
      if (take_->left == 0) {
        take_.reset();
      } else {
        --take_->left;
      }
    }
    if (send) {
      if (*send_ == 0) {
        send_.reset();
      } else {
        --*send_;
      }
    }
    if (issue || refuse) take_ = Take{write.address.beats - 1, refuse, write.client};
    if (issue) send_ = write.address.beats - 1;

    // time
    if (timeout_.expired()) {
      for (Waiting& one : waiting_) one.ticks = std::min(one.ticks + 1, 2);
    }
    timeout_.clock(timeout_.expired(), in.limit);
    if (answered || timeout) waiting_.pop_front();
    if (issue) waiting_.push_back(Waiting{write.client, 0});
    if (timeout) ++dropped_;
    if (counts && !answered) --dropped_;

    // from memory
    if (address_taken_) ++addresses_taken_;
    if (burst_taken_) ++bursts_taken_;
    if (counts) {
      --addresses_taken_;
      --bursts_taken_;
    }
    address_taken_ = address_taken;
    burst_taken_ = burst_taken;
    response_.reset();
    if (bready_ && in.response && in.response->own) response_ = in.response->okay;
    bready_ = true;

    // from the clients
    writes_.clock(in_ && in_->last, current_, issue || refuse);
    beats_.clock(in_.has_value(), in_.value_or(Data{}), pop);
    in_.reset();
    const bool room = held_ <= 13;
    if (pop) --held_;
    if (ready_ && in.beats[*ready_]) {
      const Beat& beat = *in.beats[*ready_];
      if (!begun_) current_ = Write{*ready_, {beat.address, 0}};
      ++current_.address.beats;
      const bool last = beat.last || (current_.address.address + current_.address.beats) % line_ == 0;
      in_ = Data{beat.data, beat.strobes, last};
      begun_ = !last;
      ++held_;
    }
    if (!begun_) {
      turn_.reset();
      for (std::size_t i = 1; i <= clients_ && !turn_; ++i) {
        if (in.beats[(served_ + i) % clients_]) turn_ = (served_ + i) % clients_;
      }
      if (room && turn_) served_ = *turn_;
    }
    ready_ = room ? turn_ : std::nullopt;
  }

  void reset(std::uint32_t limit) {
    *this = AxiWrite(clients_, line_, outstanding_);
    timeout_.clock(true, limit);
  }

 private:
  static constexpr std::size_t queue_depth = 16;
  struct Write {
    std::size_t client = 0;
    Address address;
  };
  struct Take {
    std::size_t left;  // beats behind the present one
    bool refused;
    std::size_t client;
  };
  struct Waiting {
    std::size_t client;
    int ticks;  // seen, at most 2
  };

  std::size_t clients_;
  std::size_t line_;
  std::size_t outstanding_;
  std::size_t served_ = clients_ - 1;
  std::optional<std::size_t> turn_, ready_;
  bool begun_ = false;
  Write current_;
  std::optional<Data> in_;
  std::size_t held_ = 0;  // beats taken that have not left their queue
  Fifo<Write> writes_{queue_depth};
  Fifo<Data> beats_{queue_depth};
  std::optional<Take> take_;         // whose beats leave the queue
  std::optional<std::size_t> send_;  // beats behind the one to send
  SkidBuffer<Address> addresses_;
  SkidBuffer<Data> data_;
  std::deque<Waiting> waiting_;
  std::size_t dropped_ = 0;  // given up, the response is owed
  bool address_taken_ = false, burst_taken_ = false;
  std::size_t addresses_taken_ = 0, bursts_taken_ = 0;  // without a response
  std::optional<bool> response_;                        // okay
  bool bready_ = false;
  std::optional<Answer> answer_;
  Timeout timeout_{defs::memory_limit_default};
  bool any_outstanding_ = false;
};

/// cchip_cache: lines of 64 bytes, two ways, two ports. Counts what its ports do on each clock.
class Cache {
 public:
  struct Shape {
    std::size_t sets = 1024;
    std::size_t places = 32;
    std::size_t misses = 32;
    std::size_t beats = 4;  ///< of a line
  };
  struct Range {  ///< of lines; empty if first > last
    std::uint64_t first = 1;
    std::uint64_t last = 0;
    bool has(std::uint64_t line) const { return first <= line && line <= last; }
  };
  struct Request {
    std::size_t place = 0;
    std::uint64_t line = 0;
  };
  struct Answer {
    std::size_t place = 0;
    ReadCode code = ReadCode::ok;
    LineData data{};  ///< if the code is ok
  };
  /// An answer of cchip_axi_read.
  struct Beat {
    std::size_t slot = 0;
    std::optional<std::size_t> beat;  ///< without: no data
    bool last = false;
    ReadCode code = ReadCode::ok;
    LineData data{};
  };
  struct Inputs {
    std::array<std::optional<Request>, 2> requests;
    std::vector<Range> locks;
    std::optional<Range> invalidate;  ///< taken if invalidate_ready()
    std::optional<Beat> beat;
    std::vector<bool> outstanding;  ///< of each slot, as cchip_axi_read says
  };
  struct Counts {
    bool hit = false, miss = false, wait = false, again = false;
  };

  explicit Cache(const Shape& shape)
      : shape_(shape),
        arrived_(shape.misses),
        serve_queue_(shape.misses),
        free_(shape.misses),
        entries_(shape.sets),
        data_(2 * shape.sets),
        retried_(2 * shape.places) {
    reset();
  }

  const std::array<std::optional<Answer>, 2>& answers() const { return answers_; }
  const std::array<Counts, 2>& counts() const { return counts_; }
  bool invalidate_ready() const { return ready_; }
  /// Request to memory: the slot is its place.
  const std::optional<Request>& read() const { return read_; }

  void clock(const Inputs& in) {
    // what stage 6 wants
    std::array<bool, 2> want{}, fresh{}, hit{}, wait{};
    for (std::size_t p = 0; p < 2; ++p) {
      Step& step = ports_[p].steps[5];
      step.stale = step.stale || changes(step);
      fresh[p] = step.kind == Kind::look && !step.stale;
      wait[p] = fresh[p] && step.wait;
      hit[p] = fresh[p] && step.match && !step.wait;
      want[p] = fresh[p] && !step.match && step.victim && free_.m_valid() && !exhausted_ &&
                (!alone_ || oldest_ == p * shape_.places + step.place);
    }
    const Step& fill6 = ports_[0].steps[5];
    const Step& walk6 = ports_[1].steps[5];
    const bool kill = fill6.kind == Kind::own && fill6.code != ReadCode::ok;
    const bool forgets = walk6.forget[0] || walk6.forget[1];
    const bool walk_seen = walk6.kind == Kind::own;
    const bool walk_next = walk_seen && !walk6.stale && !(kill && forgets);
    const bool walk_write = walk_next && forgets;
    std::optional<std::size_t> granted;
    if (want[0] && !walk_write && !(want[1] && favour_)) granted = 0;
    if (want[1] && !kill && !(want[0] && !favour_)) granted = 1;
    if (want[0] && want[1]) favour_ = !favour_;

    // the lines in flight: what they show on this clock
    const bool fills = arrived_.m_valid();
    const Arrived fill = fills ? arrived_.m_data() : Arrived{};
    const bool release = serving_ && !collect_ && !collected_ && !woken_;
    const bool woken = !ports_[0].wake.empty() || !ports_[1].wake.empty() || (fills && ports_[0].serve) ||
                       (walk_valid_ && ports_[1].serve);
    const bool next_serves = serve_queue_.m_valid() && (!serving_ || release);

    const bool walks = walk_valid_;
    const bool serves = ports_[0].serve || ports_[1].serve;
    clock_turn();
    std::array<Step, 2> first;
    for (std::size_t p = 0; p < 2; ++p) {
      Port& port = ports_[p];
      Step& step6 = port.steps[5];
      const bool grant = granted == p;
      const bool sleeps = wait[p] || grant;
      const bool again = step6.kind == Kind::look && (step6.stale || (!step6.match && !grant && !exhausted_));
      if (step6.kind == Kind::look) retried_[p * shape_.places + step6.place] = again;
      answers_[p].reset();
      if (hit[p]) answers_[p] = Answer{step6.place, ReadCode::ok, step6.data};
      if (fresh[p] && !step6.match && exhausted_) answers_[p] = Answer{step6.place, ReadCode::owed, {}};
      if (step6.kind == Kind::serve) answers_[p] = Answer{step6.place, step6.code, step6.data};
      counts_[p] = Counts{hit[p], grant, wait[p], again};

      // stage 0
      const auto& ask = in.requests[p];
      const bool own = p == 0 ? fills : walks;
      const bool serve = !own && port.serve;
      const bool go = running_ && !own && !port.serve;
      const bool late = port.late.m_valid();
      const bool use_again = port.again.m_valid() && (port.again_first || !(late || ask));
      const bool use_late = !use_again && late;
      const bool use_ask = !use_again && !late && ask;
      if (go && port.again.m_valid() && (late || ask)) port.again_first = !port.again_first;
      Step& step = first[p];
      if (own) {
        step.kind = Kind::own;
        step.line = p == 0 ? held_[fill.slot].frame / 2 : walk_set_;
        step.way = held_[fill.slot].frame % 2;
        step.slot = fill.slot;
        step.code = fill.code;
      } else if (serve) {
        step = *port.serve;
      } else if (go && (use_again || use_late || use_ask)) {
        const Request& request = use_again ? port.again.m_data() : use_late ? port.late.m_data() : *ask;
        step.kind = Kind::look;
        step.place = request.place;
        step.line = request.line;
      }
      port.late.clock(ask && !(go && use_ask), ask.value_or(Request{}), go && !use_again);
      port.again.clock(again, Request{step6.place, step6.line}, go && use_again);

      // who waits
      if (!port.serve || serve) {
        port.serve.reset();
        if (!port.wake.empty()) {
          port.serve.emplace();
          port.serve->kind = Kind::serve;
          port.serve->place = *port.wake.begin();
          port.serve->line = serving_->frame / 2;
          port.serve->way = serving_->frame % 2;
          port.serve->code = serving_->code;
          port.wake.erase(port.wake.begin());
        }
      }
      if (collect_) {
        for (const auto& [place, slot] : port.asleep) {
          if (slot == serving_->slot) port.wake.insert(place);
        }
        for (const std::size_t place : port.wake) port.asleep.erase(place);
      }
      if (sleeps) port.asleep[step6.place] = grant ? free_.m_number() : step6.wait_slot;

      // stages 1 to 5: the entries are read in 1
      port.steps[0].entries = entries_[set_of(port.steps[0])];
      for (std::size_t s = 0; s < 5; ++s) port.steps[s].stale = port.steps[s].stale || changes(port.steps[s]);
      for (const Range& range : in.locks) port.steps[0].locks = port.steps[0].locks || range.has(port.steps[0].line);
      look_up(port.steps[3]);
      Step& step5 = port.steps[4];
      judge(step5);
      step5.data = data_[2 * set_of(step5) + step5.way];
    }
    const Step fill5 = ports_[0].steps[4];

    // the change of the entries that this clock shows comes into force, and the next one is made
    if (change_) {
      for (std::size_t w = 0; w < 2; ++w) {
        if (change_->ways[w]) entries_[change_->set][w] = change_->entries[w];
      }
    }
    change_.reset();
    if (!running_) {
      change_ = Change{walk_set_, {true, true}, {}};
    } else if (kill) {
      change_ = Change{set_of(fill6), {fill6.way == 0, fill6.way == 1}, {}};
      change_->entries[fill6.way].slot = fill6.slot;
    } else if (walk_write) {
      change_ = Change{set_of(walk6), {walk6.forget[0], walk6.forget[1]}, walk6.entries};
      for (Entry& entry : change_->entries) entry.valid = entry.locked = false;
    } else if (granted) {
      const Step& step = ports_[*granted].steps[5];
      change_ = Change{set_of(step), {*step.victim == 0, *step.victim == 1}, {}};
      change_->entries[*step.victim] = Entry{true, step.locks, step.turn, free_.m_number(), step.line};
    }

    // the walk, before the slots it looks at change
    clock_walk(in.invalidate, walk_seen, walk_next, serves);

    // the slots
    std::optional<std::size_t> released;  // goes back to the pool
    const bool lost = release && (serving_->code == ReadCode::timeout || serving_->code == ReadCode::owed);
    const bool all_lost = lost_.size() == shape_.misses;
    if (release && !lost) released = serving_->slot;
    if (back_) {
      if (!released) {
        released = back_;
        back_.reset();
      }
    } else {
      if (lost_.count(scan_) != 0 && !in.outstanding[scan_]) {
        lost_.erase(scan_);
        back_ = scan_;
      }
      scan_ = (scan_ + 1) % shape_.misses;
    }
    exhausted_ = all_lost;
    if (release) {
      held_[serving_->slot].held = false;
      if (lost) lost_.insert(serving_->slot);
      serving_.reset();
    }
    if (fill5.kind == Kind::own && fill5.code == ReadCode::ok) {
      held_[fill5.slot].filled = true;
      data_[2 * set_of(fill5) + fill5.way] = held_[fill5.slot].data;
    }
    if (read_) {
      held_[read_->place].held = true;
      held_[read_->place].filled = false;
      held_[read_->place].frame = allocate_frame_;
    }
    if (in.beat && in.beat->beat) {
      const std::size_t words = 16 / shape_.beats;
      for (std::size_t w = 0; w < words; ++w) held_[in.beat->slot].data[*in.beat->beat * words + w] = in.beat->data[w];
    }
    const bool take_serve = !serving_;
    if (next_serves) serving_ = serve_queue_.m_data();
    collected_ = collect_;
    collect_ = next_serves;
    woken_ = woken;
    serve_queue_.clock(fill5.kind == Kind::own, Arrived{fill5.slot, fill5.code, 2 * set_of(fill5) + fill5.way},
                       take_serve);
    arrived_.clock(in.beat && in.beat->last, in.beat ? Arrived{in.beat->slot, in.beat->code, 0} : Arrived{}, true);
    read_.reset();
    if (granted) {
      const Step& step = ports_[*granted].steps[5];
      read_ = Request{free_.m_number(), step.line};
      allocate_frame_ = 2 * set_of(step) + *step.victim;
    }
    free_.clock(granted.has_value(), released);

    for (std::size_t p = 0; p < 2; ++p) {
      auto& steps = ports_[p].steps;
      steps = {first[p], steps[0], steps[1], steps[2], steps[3], steps[4]};
    }
  }

  void reset() {
    for (Port& port : ports_) port = Port(shape_.places);
    held_.assign(shape_.misses, Held{});
    free_.reset();
    collect_ = collected_ = woken_ = false;
    arrived_.reset();
    serve_queue_.reset();
    serving_.reset();
    change_.reset();
    read_.reset();
    answers_ = {};
    counts_ = {};
    lost_.clear();
    back_.reset();
    scan_ = oldest_ = 0;
    age_ = 0;
    exhausted_ = alone_ = false;
    retried_.assign(retried_.size(), false);
    favour_ = running_ = ready_ = walk_valid_ = false;
    state_ = State::clear;
    walk_set_ = 0;
    left_ = shape_.sets - 1;
  }

 private:
  enum class Kind { none, look, serve, own };
  enum class State { clear, idle, ask, see, reads, answers };
  struct Entry {
    bool valid = false;
    bool locked = false;
    bool turn = false;
    std::size_t slot = 0;
    std::uint64_t line = 0;
  };
  struct Step {
    Kind kind = Kind::none;
    std::size_t place = 0;
    std::uint64_t line = 0;  // the set alone if kind is serve or own
    std::size_t way = 0;
    std::size_t slot = 0;
    ReadCode code = ReadCode::ok;
    bool stale = false;
    std::array<Entry, 2> entries{};
    std::array<bool, 2> holds{}, filled{};  // of the lines in flight that the entries name
    bool match = false, wait = false;
    std::size_t wait_slot = 0;
    std::optional<std::size_t> victim;
    bool locks = false, turn = false;
    std::array<bool, 2> forget{};
    LineData data{};
  };
  struct Port {
    explicit Port(std::size_t places) : late(places), again(places) {}
    Fifo<Request> late, again;  // found the port taken; to be looked up again
    bool again_first = false;
    std::set<std::size_t> wake;
    std::optional<Step> serve;
    std::map<std::size_t, std::size_t> asleep;  // place, slot of the line it waits for
    std::array<Step, 6> steps;                  // stages 1 to 6
  };
  struct Held {
    bool held = false, filled = false;
    std::size_t frame = 0;  // 2 set + way
    LineData data{};
  };
  struct Arrived {
    std::size_t slot = 0;
    ReadCode code = ReadCode::ok;
    std::size_t frame = 0;
  };
  struct Change {
    std::size_t set = 0;
    std::array<bool, 2> ways{};
    std::array<Entry, 2> entries{};
  };

  std::size_t set_of(const Step& step) const { return step.line % shape_.sets; }
  bool changes(const Step& step) const { return change_ && change_->set == set_of(step); }

  /// Stage 4.
  void look_up(Step& step) const {
    for (std::size_t w = 0; w < 2; ++w) {
      const Held& held = held_[step.entries[w].slot];
      step.holds[w] = held.held && held.frame == 2 * set_of(step) + w;
      step.filled[w] = held.filled;
    }
  }
  /// Stage 5.
  void judge(Step& step) const {
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

  /// Whose turn it is of those that are looked up again.
  void clock_turn() {
    if (retried_[oldest_]) {
      alone_ = age_ == 63;
      age_ = std::min(age_ + 1, 63);
    } else {
      oldest_ = (oldest_ + 1) % retried_.size();
      age_ = 0;
      alone_ = false;
    }
  }

  void clock_walk(const std::optional<Range>& invalidate, bool seen, bool next, bool serves) {
    const bool last = left_ == 0;
    if (state_ == State::reads) {
      std::set<std::size_t> old;
      for (const std::size_t slot : old_) {
        if (held_[slot].held) old.insert(slot);
      }
      if (old_.empty() && !serves) state_ = State::answers;
      old_ = old;
      clocks_ = 7;
      return;
    }
    old_.clear();
    for (std::size_t slot = 0; slot < held_.size(); ++slot) {
      if (held_[slot].held) old_.insert(slot);
    }
    walk_valid_ = false;
    switch (state_) {
      case State::clear:
        walk_set_ = (walk_set_ + 1) % shape_.sets;
        left_ = (left_ + shape_.sets - 1) % shape_.sets;
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
        if (!seen) break;
        state_ = next && last ? State::reads : State::ask;
        if (!next) break;
        walk_set_ = (walk_set_ + 1) % shape_.sets;
        left_ = (left_ + shape_.sets - 1) % shape_.sets;
        break;
      default:
        if (clocks_-- != 0) break;
        state_ = State::idle;
        ready_ = true;
    }
  }

  Shape shape_;
  std::array<Port, 2> ports_{Port(2), Port(2)};
  std::vector<Held> held_;
  Fifo<Arrived> arrived_, serve_queue_;
  Pool free_;
  bool collect_ = false, collected_ = false, woken_ = false;
  std::optional<Arrived> serving_;
  std::vector<std::array<Entry, 2>> entries_;
  std::vector<LineData> data_;
  std::optional<Change> change_;
  std::size_t allocate_frame_ = 0;
  std::optional<Request> read_;
  std::array<std::optional<Answer>, 2> answers_;
  std::array<Counts, 2> counts_{};
  bool favour_ = false, running_ = false, ready_ = false, walk_valid_ = false;
  State state_ = State::clear;
  std::size_t walk_set_ = 0;
  std::uint64_t left_ = 0;
  Range walk_range_;
  std::set<std::size_t> old_;
  int clocks_ = 0;
  std::set<std::size_t> lost_;  // slots whose reads memory may still owe
  std::optional<std::size_t> back_;
  std::size_t scan_ = 0;
  bool exhausted_ = false;
  std::vector<bool> retried_;  // of each place, of port 0 first
  std::size_t oldest_ = 0;
  int age_ = 0;
  bool alone_ = false;
};

}  // namespace cchip::model

#endif
