// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/blocks/axi_read.hpp>
#include <deque>
#include <models/cchip_axi_read.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

using model::LineData;

/// What memory holds: words that tell their address.
std::uint32_t word_at(std::uint64_t line, std::size_t word) {
  return static_cast<std::uint32_t>((line * 16 + word) * 0x9E3779B97F4A7C15U >> 32);
}

/// How memory behaves; chances in per cent.
struct Behaviour {
  const char* name = "errors";
  int ready = 80;         ///< arready on a clock
  int valid = 80;         ///< a beat on a clock
  int in_order = 0;       ///< whole lines, in the order of their addresses
  int error = 5;          ///< of rresp, on a beat
  int wrong_length = 10;  ///< of a line
  int lost = 0;           ///< of a line: not answered before `silence` ends
  int unasked = 10;       ///< an unrequested beat on a clock
  /// periods without any address taken or beat: they begin on a clock with 1 / 2^silence; 0: none
  int silence = 0;
  int limit = 100000;
  int changes = 0;  ///< the limit changes: up, down, to the default and to the highest
};
using B = Behaviour;
const std::vector<B> behaviours = {
    changed<B>("fast", {{&B::ready, 100},
                        {&B::valid, 100},
                        {&B::in_order, 1},
                        {&B::error, 0},
                        {&B::wrong_length, 0},
                        {&B::unasked, 0}}),
    changed<B>(
        "in order",
        {{&B::ready, 50}, {&B::valid, 60}, {&B::in_order, 1}, {&B::error, 0}, {&B::wrong_length, 0}, {&B::unasked, 0}}),
    changed<B>("any order", {{&B::error, 0}, {&B::wrong_length, 0}, {&B::unasked, 0}}),
    changed<B>("slow", {{&B::ready, 10}, {&B::valid, 10}, {&B::error, 0}, {&B::wrong_length, 0}, {&B::unasked, 0}}),
    B{},
    changed<B>("late", {{&B::ready, 60},
                        {&B::valid, 60},
                        {&B::error, 2},
                        {&B::wrong_length, 5},
                        {&B::lost, 10},
                        {&B::unasked, 2},
                        {&B::limit, 150}}),
    changed<B>("silent", {{&B::ready, 60},
                          {&B::error, 1},
                          {&B::wrong_length, 2},
                          {&B::lost, 5},
                          {&B::unasked, 1},
                          {&B::silence, 9},
                          {&B::limit, 200}}),
    changed<B>("no time", {{&B::ready, 60},
                           {&B::error, 1},
                           {&B::wrong_length, 2},
                           {&B::lost, 5},
                           {&B::unasked, 1},
                           {&B::silence, 8},
                           {&B::limit, 3}}),
    changed<B>("changes", {{&B::ready, 60},
                           {&B::error, 1},
                           {&B::wrong_length, 2},
                           {&B::lost, 5},
                           {&B::unasked, 1},
                           {&B::silence, 8},
                           {&B::limit, 60},
                           {&B::changes, 1}}),
};

struct Owed {
  std::size_t id;
  std::uint64_t line;
  std::size_t beats;  // that memory is going to send
  std::size_t sent = 0;
  bool error = false;  // has been sent
  bool lost = false;
};

template <class Config>
class ReadBench {
 public:
  static constexpr std::size_t clients = Config::CLIENTS;
  static constexpr std::size_t slots = Config::SLOTS;
  static constexpr std::size_t beats = 512 / Config::DATA_W;
  static constexpr std::size_t words = Config::DATA_W / 32;
  static constexpr int log2(std::size_t n) { return n <= 1 ? 0 : 1 + log2((n + 1) / 2); }

  ReadBench(sim::Simulation<typename Config::Model>& simulation, Random& random)
      : simulation_(simulation), top_(simulation.top()), random_(random), model_(clients, slots, beats) {}

  void run(const Behaviour& how, int percent, int clocks) {
    how_ = how;
    reset(2);
    for (int clock = 0; clock < clocks; ++clock) {
      const bool again = clock == clocks / 3;  // of memory, too; while reads are under way one clock is enough
      if (again) reset(1);
      step(clock == 0 || again ? 0 : percent);
    }
    for (Owed& read : owed_) read.lost = false;
    how_.silence = how_.lost = how_.unasked = 0;
    how_.changes = false;
    top_.limit = how.limit;
    silent_ = 0;
    how_.ready = how_.valid = 60;
    for (int clock = 0; clock < 40000 && (open() != 0 || !owed_.empty() || model_.any_outstanding()); ++clock) step(0);
    REQUIRE(open() == 0);
    for (int clock = 0; clock < 4; ++clock) step(0);
    REQUIRE(top_.any_outstanding == 0);
  }

  std::array<std::uint64_t, 4> answers{};  ///< of each code
  std::uint64_t beats_dropped = 0;
  std::uint64_t most_open = 0;

 private:
  void reset(int clocks) {
    top_.limit = how_.limit;
    top_.s_valid = 0;
    top_.m_axi_arready = 0;
    top_.m_axi_rvalid = 0;
    simulation_.reset(clocks);
    model_.reset(how_.limit);
    owed_.clear();
    offered_.reset();
    asked_.assign(clients * slots, std::nullopt);
    for (auto& words_of : got_) words_of.clear();
    silent_ = 0;
  }

  std::size_t open() const {
    return static_cast<std::size_t>(
        std::count_if(asked_.begin(), asked_.end(), [](const auto& line) { return line.has_value(); }));
  }

  void step(int percent) {
    model::AxiRead::Inputs in;
    if (how_.changes && chance(random_, 2)) top_.limit = any_limit(random_, how_.limit);
    in.limit = top_.limit;
    if (silent_ > 0) {
      --silent_;
      if (silent_ == 0) {
        for (Owed& read : owed_) read.lost = false;
      }
    } else if (how_.silence != 0 && random_() % (std::uint64_t{1} << how_.silence) == 0) {
      silent_ = 1 + static_cast<int>(random_() % 1000);
    }

    // requests
    in.requests.resize(clients);
    for (std::size_t c = 0; c < clients; ++c) {
      const std::size_t slot = random_() % slots;
      auto& place = asked_[c * slots + slot];
      if (chance(random_, percent) && !place) {
        in.requests[c] = model::AxiRead::Request{slot, random_() >> 6};
        place = in.requests[c]->line;
        sim::set_bits(top_.s_line, static_cast<int>(58 * c), 58, in.requests[c]->line);
        sim::set_bits(top_.s_slot, log2(slots) * static_cast<int>(c), log2(slots), slot);
      } else {
        sim::set_bits(top_.s_line, static_cast<int>(58 * c), 58, random_());
        sim::set_bits(top_.s_slot, log2(slots) * static_cast<int>(c), log2(slots), random_());
      }
      sim::set_bits(top_.s_valid, static_cast<int>(c), 1, in.requests[c] ? 1 : 0);
    }
    most_open = std::max<std::uint64_t>(most_open, open());

    // memory; what was offered stays until it is taken
    in.arready = silent_ == 0 && chance(random_, how_.ready);
    top_.m_axi_arready = in.arready;
    if (!offered_ && silent_ == 0) choose_beat();
    if (!offered_ && chance(random_, how_.unasked)) choose_unasked();
    in.beat = offered_;
    top_.m_axi_rvalid = offered_ ? 1 : 0;
    sim::set_random(top_.m_axi_rdata, Config::DATA_W, random_);
    top_.m_axi_rlast = chance(random_, 50);
    sim::set_bits(top_.m_axi_rresp, 0, 2, random_());
    if (offered_) {
      top_.m_axi_rid = static_cast<CData>(offered_->id);
      top_.m_axi_rlast = offered_->last;
      sim::set_bits(top_.m_axi_rresp, 0, 2, offered_->okay ? 0 : 1 + random_() % 3);
      for (std::size_t w = 0; w < words; ++w)
        sim::set_bits(top_.m_axi_rdata, static_cast<int>(32 * w), 32, offered_->data[w]);
    }
    simulation_.settle();
    compare();
    if (model_.address() && in.arready) take_address();
    if (offered_ && model_.rready()) offered_.reset();
    if (model_.answer()) take_answer(*model_.answer());
    model_.clock(in);
    simulation_.rise();
  }

  void compare() {
    const auto& answer = model_.answer();
    REQUIRE(top_.m_valid == (answer ? 1U << answer->client : 0U));
    if (answer) {
      REQUIRE(top_.m_slot == answer->slot);
      REQUIRE((top_.m_last != 0) == answer->last);
      if (answer->last) REQUIRE(top_.m_code == static_cast<unsigned>(answer->code));
      if (answer->beat) {
        REQUIRE(top_.m_beat == *answer->beat);
        for (std::size_t w = 0; w < words; ++w)
          REQUIRE(sim::get_bits(top_.m_data, static_cast<int>(32 * w), 32) == answer->data[w]);
      }
    }
    const auto& address = model_.address();
    REQUIRE((top_.m_axi_arvalid != 0) == address.has_value());
    if (address) {
      REQUIRE(top_.m_axi_arid == address->id);
      REQUIRE(top_.m_axi_araddr == address->line << 6);
    }
    REQUIRE(top_.m_axi_arlen == beats - 1);
    REQUIRE((top_.m_axi_rready != 0) == model_.rready());
    REQUIRE((top_.any_outstanding != 0) == model_.any_outstanding());
    for (std::size_t id = 0; id < clients * slots; ++id) {
      const bool outstanding = sim::get_bits(top_.outstanding, static_cast<int>(id), 1) != 0;
      REQUIRE(outstanding == model_.outstanding()[id]);
      // independent of the model: a response that memory has still to give is never out of sight once its answer has
      // gone
      if (!asked_[id] && std::any_of(owed_.begin(), owed_.end(), [&](const Owed& read) { return read.id == id; }))
        REQUIRE(outstanding);
    }
  }

  void take_address() {
    const auto& address = *model_.address();
    REQUIRE(std::none_of(owed_.begin(), owed_.end(), [&](const Owed& read) { return read.id == address.id; }));
    Owed read{address.id, address.line, beats};
    if (chance(random_, how_.wrong_length)) read.beats = 1 + random_() % (2 * beats);
    read.lost = chance(random_, how_.lost);
    owed_.push_back(read);
  }

  void choose_beat() {
    if (owed_.empty() || !chance(random_, how_.valid)) return;
    const auto read = owed_.begin() + static_cast<std::ptrdiff_t>(how_.in_order ? 0 : random_() % owed_.size());
    if (read->lost) {
      if (chance(random_, 1)) read->lost = false;
      return;
    }
    model::AxiRead::Beat beat;
    beat.id = read->id;
    beat.okay = !chance(random_, how_.error);
    for (std::size_t w = 0; w < words; ++w) beat.data[w] = word_at(read->line, (read->sent * words + w) % 16);
    beat.last = ++read->sent == read->beats;
    offered_ = beat;
    if (beat.last) owed_.erase(read);
  }

  void choose_unasked() {
    const std::size_t id = random_() % (std::size_t{1} << (log2(clients) + log2(slots)));
    if (std::any_of(owed_.begin(), owed_.end(), [&](const Owed& read) { return read.id == id; })) return;
    // not in the clocks in which its address may be taken: such a beat is one of the line
    if (id < asked_.size() && asked_[id]) return;
    offered_ = model::AxiRead::Beat{id, {}, chance(random_, 50), chance(random_, 50)};
    ++beats_dropped;
  }

  /// Independent of the model's bookkeeping: who asked for what, and what memory holds there.
  void take_answer(const model::AxiRead::Answer& answer) {
    const std::size_t id = answer.client * slots + answer.slot;
    REQUIRE(asked_[id].has_value());
    auto& got = got_[id];
    if (answer.beat) {
      REQUIRE(*answer.beat == got.size() / words);
      for (std::size_t w = 0; w < words; ++w) {
        got.push_back(answer.data[w]);
      }
    }
    if (!answer.last) return;
    ++answers[static_cast<std::size_t>(answer.code)];
    if (answer.code == ReadCode::ok) {
      REQUIRE(got.size() == 16);
      for (std::size_t w = 0; w < 16; ++w) REQUIRE(got[w] == word_at(*asked_[id], w));
    }
    got.clear();
    asked_[id].reset();
  }

  sim::Simulation<typename Config::Model>& simulation_;
  typename Config::Model& top_;
  Random& random_;
  model::AxiRead model_;
  Behaviour how_{};
  int silent_ = 0;
  std::vector<std::optional<std::uint64_t>> asked_;  // line that each place waits for
  std::array<std::vector<std::uint32_t>, clients * slots> got_;
  std::vector<Owed> owed_;
  std::optional<model::AxiRead::Beat> offered_;
};

}  // namespace

TEMPLATE_LIST_TEST_CASE(
    "cchip_axi_read: outputs are the model's on every clock, every request is answered, by its own line",
    "[unit][cchip_axi_read]", cchip_axi_read_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    for (const Behaviour& how : behaviours) {
      for (const int percent : {100, 20}) {
        CAPTURE(how.name, percent);
        ReadBench<TestType> bench(simulation, random);
        bench.run(how, percent, 6000);
        const auto count = [&](ReadCode code) { return bench.answers[static_cast<std::size_t>(code)]; };
        const bool times_out = how.limit < 100000;
        if (how.limit > 100) REQUIRE(count(ReadCode::ok) > (times_out ? 0 : 50));
        const bool faulty = how.error != 0;
        if (!faulty || !times_out) REQUIRE((count(ReadCode::bus) != 0) == faulty);
        REQUIRE((count(ReadCode::timeout) != 0) == times_out);
        // a line that is too long is owed still when the place is used again
        if (times_out) REQUIRE(count(ReadCode::owed) != 0);
        if (!times_out && !faulty) REQUIRE(count(ReadCode::owed) == 0);
        if (percent == 100 && !times_out) REQUIRE(bench.most_open == TestType::CLIENTS * TestType::SLOTS);
      }
    }
  });
}

// No client asks twice, memory is silent for ever: each request ends by itself, and after the silence the place works
// again.
TEMPLATE_LIST_TEST_CASE("cchip_axi_read: a beat on every clock, a silent bus ends in time-outs",
                        "[unit][cchip_axi_read]", cchip_axi_read_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    constexpr std::size_t beats = 512 / TestType::DATA_W;
    auto& top = simulation.top();
    for (const bool taken : {false, true}) {
      constexpr std::uint32_t limit = 40;
      constexpr int ids = TestType::CLIENTS * TestType::SLOTS;
      top.limit = limit;
      top.s_valid = 0;
      top.m_axi_rvalid = 0;
      top.m_axi_arready = taken;
      sim::set_random(top.s_line, 58 * TestType::CLIENTS, random);
      simulation.reset();
      simulation.step();
      int clock = 0;
      int first = 0;
      int timeouts = 0;
      int refused = 0;
      for (; clock < 2 * static_cast<int>(limit) + 8 * ids + 40; ++clock) {
        if (clock < TestType::SLOTS) {
          for (int c = 0; c < TestType::CLIENTS; ++c) {
            sim::set_bits(top.s_slot, ReadBench<TestType>::log2(TestType::SLOTS) * c,
                          ReadBench<TestType>::log2(TestType::SLOTS), static_cast<std::uint64_t>(clock));
          }
        }
        top.s_valid = clock < TestType::SLOTS ? (1 << TestType::CLIENTS) - 1 : 0;
        simulation.settle();
        if (top.m_valid != 0) {
          if (first == 0) first = clock;
          REQUIRE(top.m_last == 1);
          timeouts += top.m_code == static_cast<unsigned>(ReadCode::timeout) ? 1 : 0;
          refused += top.m_code == static_cast<unsigned>(ReadCode::owed) ? 1 : 0;
        }
        simulation.rise();
      }
      REQUIRE(first > static_cast<int>(limit));
      REQUIRE(timeouts == (taken ? ids : 1));
      REQUIRE(refused == (taken ? 0 : ids - 1));
      REQUIRE(top.any_outstanding == 1);
    }

    // as fast as the bus
    ReadBench<TestType> bench(simulation, random);
    bench.run(behaviours[0], 100, 2000);
    const std::uint64_t lines = bench.answers[0];
    INFO(lines << " lines of " << beats << " beats in 2000 clocks");
    if (TestType::SLOTS * TestType::CLIENTS * beats > 16) REQUIRE(lines * beats > 1900);
  });
}

namespace {

/// Clock on which the answer to a read comes whose address is taken and that memory never answers; 0: none in `clocks`.
/// The limit changes on clock `when`; the request is on clock 0.
template <class Config, class Simulation>
int clock_of_timeout(Simulation& simulation, std::uint32_t before, std::uint32_t after, int when, int clocks) {
  auto& top = simulation.top();
  top.limit = before;
  top.s_valid = 0;
  top.m_axi_arready = 1;
  top.m_axi_rvalid = 0;
  simulation.reset();
  if (when < 0) top.limit = after;
  simulation.steps(20);
  for (int clock = 0; clock < clocks; ++clock) {
    top.s_valid = clock == 0 ? 1 : 0;
    if (clock == when) top.limit = after;
    simulation.settle();
    if (top.m_valid != 0) {
      REQUIRE(top.m_code == static_cast<unsigned>(ReadCode::timeout));
      return clock;
    }
    simulation.rise();
  }
  return 0;
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_axi_read: a limit counts from the clock on which it changes, 0 is the default",
                        "[unit][cchip_axi_read]", cchip_axi_read_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random&) {
    constexpr int more = 3 * TestType::CLIENTS * TestType::SLOTS + 12;
    const auto clock_of = [&](std::uint32_t before, std::uint32_t after, int when, int clocks) {
      return clock_of_timeout<TestType>(simulation, before, after, when, clocks);
    };
    for (const int limit : {1, 2, 100}) {
      const auto bound = static_cast<std::uint32_t>(limit);
      for (const std::uint32_t high : {20000U, 0U, ~0U}) {
        CAPTURE(limit, high);
        for (const int when : {-1, 3, 50, 130, 700}) {  // lowered, before and during the read
          CAPTURE(when);
          const int clock = clock_of(high, bound, when, 20000);
          REQUIRE(clock > limit);
          REQUIRE(clock >= when);
          REQUIRE(clock <= std::max(when, 0) + 2 * limit + more);
        }
        if (limit < 100) continue;
        for (int when = 0; when < limit; when += 7) REQUIRE(clock_of(bound, high, when, 3000) == 0);  // raised
      }
    }
    constexpr int standard = defs::memory_limit_default;
    for (const int when : {-1, 60}) {
      const int clock = clock_of(100, 0, when, 10000);
      REQUIRE(clock > standard);
      REQUIRE(clock <= std::max(when, 0) + 2 * standard + more);
    }
  });
}
