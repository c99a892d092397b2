// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/blocks/cache.hpp>
#include <map>
#include <models/cchip_cache.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

using model::Cache;
using model::LineData;

constexpr int log2(std::size_t n) { return n <= 1 ? 0 : 1 + log2((n + 1) / 2); }

/// Words that tell their line and how often it has been written.
std::uint32_t word_at(std::uint64_t line, std::uint64_t version, std::size_t word) {
  return static_cast<std::uint32_t>((line * 977 + version * 16 + word) * 0x9E3779B97F4A7C15U >> 32);
}

/// Chances in per cent, but for `invalidate`, per thousand.
struct Behaviour {
  const char* name = "mixed";
  int ask = 60;        ///< of a request per port and clock
  int sets = 0;        ///< that the lines are of; 0: all
  int tags = 4;        ///< lines of a set
  int latency = 60;    ///< clocks until memory may answer
  int beat = 100;      ///< of a beat on a clock
  int error = 0;       ///< of a line
  int invalidate = 0;  ///< of a command on a clock, after a line has been written
  int locks = 0;
  int gate = 0;     ///< memory rests until that many reads wait or nothing else happens for that long, then answers all
  int silence = 0;  ///< clocks for which a response is outstanding after a time-out or refusal, at most
};
using B = Behaviour;
const std::vector<B> behaviours = {
    changed<B>("hits", {{&B::ask, 100}, {&B::tags, 1}, {&B::latency, 10}}),
    B{},
    changed<B>("one set", {{&B::ask, 100}, {&B::sets, 1}, {&B::tags, 3}, {&B::latency, 20}}),
    changed<B>("two sets", {{&B::ask, 50},
                            {&B::sets, 2},
                            {&B::tags, 5},
                            {&B::latency, 5},
                            {&B::beat, 60},
                            {&B::error, 5},
                            {&B::invalidate, 3},
                            {&B::locks, 1}}),
    changed<B>("three sets", {{&B::ask, 80},
                              {&B::sets, 3},
                              {&B::latency, 30},
                              {&B::beat, 80},
                              {&B::error, 20},
                              {&B::invalidate, 20},
                              {&B::locks, 1}}),
    changed<B>("errors", {{&B::ask, 80}, {&B::tags, 2}, {&B::latency, 40}, {&B::beat, 50}, {&B::error, 50}}),
    changed<B>("written", {{&B::ask, 30},
                           {&B::sets, 4},
                           {&B::tags, 3},
                           {&B::latency, 10},
                           {&B::beat, 90},
                           {&B::error, 2},
                           {&B::invalidate, 100},
                           {&B::locks, 1}}),
    changed<B>("slow", {{&B::ask, 10},
                        {&B::tags, 6},
                        {&B::latency, 200},
                        {&B::beat, 20},
                        {&B::error, 5},
                        {&B::invalidate, 5},
                        {&B::locks, 1}}),
    changed<B>("burst", {{&B::ask, 100}, {&B::tags, 9}}),
    changed<B>("silent",
               {{&B::latency, 20}, {&B::beat, 80}, {&B::error, 30}, {&B::invalidate, 2}, {&B::silence, 2000}}),
};

template <class Config>
class CacheBench {
 public:
  static constexpr std::size_t places = Config::PLACES;
  static constexpr std::size_t misses = Config::MISSES;
  static constexpr std::size_t beats = 512 / Config::DATA_W;
  static constexpr std::size_t words = Config::DATA_W / 32;
  static constexpr std::size_t sets = 8 * Config::CACHE_KB;
  static constexpr int line_w = Config::LINE_W;

  CacheBench(sim::Simulation<typename Config::Model>& simulation, Random& random)
      : simulation_(simulation), top_(simulation.top()), random_(random), model_({sets, places, misses, beats}) {}

  void run(const Behaviour& how, int clocks) {
    how_ = how;
    locks_.assign(Config::LOCKS, Cache::Range{});
    if (how.locks) {
      for (auto& range : locks_) {
        range.first = random_line();
        range.last = range.first + random_() % sets;
      }
    }
    reset();
    for (int clock = 0; clock < clocks; ++clock) step(clock == 0 ? 0 : how.ask);
    drain();
  }

  void reset() {
    top_.s_valid = 0;
    top_.s_read_valid = 0;
    top_.invalidate_valid = 0;
    for (std::size_t i = 0; i < locks_.size(); ++i) {
      sim::set_bits(top_.lock_first, line_w * static_cast<int>(i), line_w, locks_[i].first);
      sim::set_bits(top_.lock_last, line_w * static_cast<int>(i), line_w, locks_[i].last);
    }
    simulation_.reset();
    model_.reset();
    reads_.clear();
    owed_.assign(misses, 0);
    for (auto& port : asked_) port.assign(places, std::nullopt);
    shown_ = {};
    first_ = {};
  }

  void drain() {
    for (int clock = 0; clock < 200000 && (open() != 0 || !model_.invalidate_ready()); ++clock) step(0);
    REQUIRE(open() == 0);
    REQUIRE(top_.invalidate_ready == 1);
  }

  /// A line on one port, nothing else: the clocks from its request to its answer.
  int fetch(std::size_t port, std::uint64_t line) {
    want_[port] = line;
    int clocks = 0;
    step(0);
    while (open() != 0) {
      step(0);
      ++clocks;
      REQUIRE(clocks < 10000);
    }
    return clocks;
  }
  void invalidate(Cache::Range range) {
    forced_ = range;
    step(0);
    drain();
  }
  void set_locks(Cache::Range first) { locks_[0] = first; }
  /// Memory never answers the first `count` reads of the next run().
  void silent_once(int count) { silent_ = count; }
  void set_memory(int latency, int beat, int error) {
    how_.latency = latency;
    how_.beat = beat;
    how_.error = error;
  }

  std::array<std::uint64_t, 4> answers{};  ///< of each code
  std::uint64_t reads = 0, hits = 0, waits = 0, agains = 0, invalidations = 0, most_reads = 0;
  int slowest = 0;

 private:
  struct Asked {
    std::uint64_t line;
    int clocks = 0;
  };
  struct Read {
    std::size_t slot;
    std::uint64_t line;
    int latency;
    std::size_t sent = 0;
    std::size_t beats = 0;  // before an error
    ReadCode code = ReadCode::ok;
    std::uint64_t version = 0;
    bool forever = false;  // memory never gives the rest
  };

  /// Of an answer whose second beat comes on this clock.
  struct FirstBeat {
    std::uint64_t line, promised;
    std::array<std::uint32_t, 8> beat;
  };

  std::uint64_t random_line() {
    const std::uint64_t set = random_() % (how_.sets == 0 ? sets : static_cast<std::size_t>(how_.sets));
    const std::uint64_t tag = random_() % static_cast<std::uint64_t>(how_.tags);
    return (tag * 0x5DEECE66DU % (std::uint64_t{1} << (line_w - log2(sets)))) * sets + set;
  }
  std::size_t open() const {
    std::size_t n = 0;
    for (const auto& port : asked_) {
      n += static_cast<std::size_t>(
          std::count_if(port.begin(), port.end(), [](const auto& place) { return place.has_value(); }));
    }
    return n;
  }

  void step(int percent) {
    Cache::Inputs in;
    in.locks = locks_;
    for (std::size_t p = 0; p < 2; ++p) {
      const std::size_t place = random_() % places;
      auto& asked = asked_[p][place];
      std::uint64_t line = random_line();
      if ((chance(random_, percent) || want_[p]) && !asked) {
        if (want_[p]) line = *want_[p];
        want_[p].reset();
        in.requests[p] = Cache::Request{place, line};
        asked = Asked{line};
      }
      const int bit = static_cast<int>(p);
      sim::set_bits(top_.s_valid, bit, 1, in.requests[p] ? 1 : 0);
      sim::set_bits(top_.s_place, log2(places) * bit, log2(places), place);
      sim::set_bits(top_.s_line, line_w * bit, line_w, line);
    }

    // the host writes a line, then invalidates it; no other module is told
    if (percent != 0 && random_() % 1000 < static_cast<std::uint64_t>(how_.invalidate)) {
      const std::uint64_t line = random_line();
      ++versions_[line];
      if (!pending_) pending_ = Cache::Range{line, line};
      pending_->first = std::min(pending_->first, line);
      pending_->last = std::max(pending_->last, line);
    }
    if (forced_) std::swap(pending_, forced_);
    forced_.reset();
    const Cache::Range shown = pending_.value_or(Cache::Range{random_line(), random_line()});
    sim::set_bits(top_.invalidate_first, 0, line_w, shown.first);
    sim::set_bits(top_.invalidate_last, 0, line_w, shown.last);
    top_.invalidate_valid = pending_ ? 1 : 0;
    in.invalidate = pending_;

    for (int& clocks : owed_) clocks = std::max(clocks - 1, 0);
    in.beat = memory();
    in.outstanding.assign(misses, false);
    for (std::size_t slot = 0; slot < misses; ++slot) in.outstanding[slot] = owed_[slot] != 0;
    for (const Read& read : reads_) in.outstanding[read.slot] = true;
    for (std::size_t slot = 0; slot < misses; ++slot)
      sim::set_bits(top_.s_read_outstanding, static_cast<int>(slot), 1, in.outstanding[slot] ? 1 : 0);
    const auto& beat = in.beat;
    sim::set_random(top_.s_read_data, Config::DATA_W, random_);
    top_.s_read_valid = beat ? 1 : 0;
    top_.s_read_last = static_cast<CData>(random_() & 1);
    sim::set_bits(top_.s_read_slot, 0, log2(misses), beat ? beat->slot : random_());
    sim::set_bits(top_.s_read_beat, 0, 3, random_());
    sim::set_bits(top_.s_read_code, 0, 2, random_());
    if (beat) {
      top_.s_read_last = beat->last;
      if (beat->last) top_.s_read_code = static_cast<CData>(beat->code);
      // an answer without data may show any beat
      in.beat->beat = beat->beat ? *beat->beat : top_.s_read_beat % beats;
      if (!beat->beat) {
        for (std::size_t w = 0; w < words; ++w)
          in.beat->data[w] = static_cast<std::uint32_t>(sim::get_bits(top_.s_read_data, static_cast<int>(32 * w), 32));
        top_.s_read_beat = static_cast<CData>(*in.beat->beat);
      } else {
        top_.s_read_beat = static_cast<CData>(*beat->beat);
        for (std::size_t w = 0; w < words; ++w)
          sim::set_bits(top_.s_read_data, static_cast<int>(32 * w), 32, beat->data[w]);
      }
    }

    simulation_.settle();
    compare();
    watch();
    model_.clock(in);
    simulation_.rise();
  }

  std::optional<Cache::Beat> memory() {
    for (Read& read : reads_) read.latency = std::max(read.latency - 1, 0);
    if (reads_.empty() || !chance(random_, how_.beat)) return std::nullopt;
    if (how_.gate != 0) {  // in order, after a rest
      rested_ = reads_.size() != was_reads_ ? 0 : rested_ + 1;
      was_reads_ = reads_.size();
      open_ = open_ ? true : rested_ >= how_.gate || reads_.size() == misses;
      if (!open_) return std::nullopt;
      if (reads_.size() == 1 && reads_[0].sent + 1 == beats) open_ = false;
    }
    const auto read = reads_.begin() + static_cast<std::ptrdiff_t>(how_.gate != 0 ? 0 : random_() % reads_.size());
    if (read->latency > 0) return std::nullopt;
    Cache::Beat beat;
    beat.slot = read->slot;
    if (read->sent == 0) read->version = versions_[read->line];
    beat.last = read->code == ReadCode::ok ? read->sent + 1 == beats : read->sent == read->beats;
    if (read->code == ReadCode::ok || !beat.last) {
      beat.beat = read->sent;
      for (std::size_t w = 0; w < words; ++w) beat.data[w] = word_at(read->line, read->version, read->sent * words + w);
    }
    beat.code = read->code;
    ++read->sent;
    if (beat.last) {
      if (read->forever) owed_[beat.slot] = 1 << 30;
      if ((beat.code == ReadCode::timeout || beat.code == ReadCode::owed) && how_.silence != 0 && !read->forever)
        owed_[beat.slot] = 1 + static_cast<int>(random_() % static_cast<unsigned>(how_.silence));
      reads_.erase(read);
    }
    return beat;
  }

  void compare() {
    for (std::size_t p = 0; p < 2; ++p) {
      const int bit = static_cast<int>(p);
      const auto& answer = model_.answers()[p];
      REQUIRE((top_.m_valid >> p & 1) == (answer ? 1 : 0));
      if (answer) {
        REQUIRE(sim::get_bits(top_.m_place, log2(places) * bit, log2(places)) == answer->place);
        REQUIRE(sim::get_bits(top_.m_code, 2 * bit, 2) == static_cast<unsigned>(answer->code));
        REQUIRE_FALSE(shown_[p]);
      }
      // the upper half of the line of a clock before, or the lower half of this one's
      const std::size_t half = shown_[p] ? 8 : 0;
      const auto& line = shown_[p] ? shown_[p] : answer;
      if (line && line->code == ReadCode::ok) {
        REQUIRE(sim::get_bits(top_.m_place, log2(places) * bit, log2(places)) == line->place);
        for (std::size_t w = 0; w < 8; ++w)
          REQUIRE(sim::get_bits(top_.m_data, 256 * bit + static_cast<int>(32 * w), 32) == line->data[half + w]);
      }
      shown_[p] = answer;
      const auto& counts = model_.counts()[p];
      REQUIRE((top_.count_hit >> p & 1) == (counts.hit ? 1 : 0));
      REQUIRE((top_.count_miss >> p & 1) == (counts.miss ? 1 : 0));
      REQUIRE((top_.count_wait >> p & 1) == (counts.wait ? 1 : 0));
      REQUIRE((top_.count_again >> p & 1) == (counts.again ? 1 : 0));
      hits += counts.hit ? 1 : 0;
      waits += counts.wait ? 1 : 0;
      agains += counts.again ? 1 : 0;
    }
    const auto& read = model_.read();
    REQUIRE((top_.m_read_valid != 0) == read.has_value());
    if (read) {
      REQUIRE(top_.m_read_slot == read->place);
      REQUIRE(top_.m_read_line == read->line);
    }
    REQUIRE((top_.invalidate_ready != 0) == model_.invalidate_ready());
  }

  /// What must hold regardless of the model: who asked for what, what memory holds, what the host has been promised.
  void watch() {
    for (std::size_t p = 0; p < 2; ++p) {
      for (auto& place : asked_[p]) {
        if (place) slowest = std::max(slowest, ++place->clocks);
      }
      const int bit = static_cast<int>(p);
      std::array<std::uint32_t, 8> beat{};
      for (std::size_t w = 0; w < 8; ++w)
        beat[w] = static_cast<std::uint32_t>(sim::get_bits(top_.m_data, 256 * bit + static_cast<int>(32 * w), 32));
      if (first_[p]) {
        const auto held = [&](std::uint64_t version) {
          for (std::size_t w = 0; w < 16; ++w) {
            if ((w < 8 ? first_[p]->beat[w] : beat[w - 8]) != word_at(first_[p]->line, version, w)) return false;
          }
          return true;
        };
        bool found = false;
        for (std::uint64_t v = first_[p]->promised; v <= versions_[first_[p]->line] && !found; ++v) found = held(v);
        REQUIRE(found);
        first_[p].reset();
      }
      if ((top_.m_valid >> p & 1) == 0) continue;
      auto& asked = asked_[p][sim::get_bits(top_.m_place, log2(places) * bit, log2(places))];
      REQUIRE(asked.has_value());
      const auto code = static_cast<ReadCode>(sim::get_bits(top_.m_code, 2 * bit, 2));
      ++answers[static_cast<std::size_t>(code)];
      if (code == ReadCode::ok) first_[p] = FirstBeat{asked->line, promised_[asked->line], beat};
      asked.reset();
    }
    if (top_.m_read_valid != 0) {
      ++reads;
      REQUIRE(owed_[top_.m_read_slot] == 0);  // cchip_axi_read would refuse it
      REQUIRE(
          std::none_of(reads_.begin(), reads_.end(), [&](const Read& read) { return read.slot == top_.m_read_slot; }));
      Read read{top_.m_read_slot, top_.m_read_line, how_.latency};
      if (silent_ > 0) {
        --silent_;
        read.code = ReadCode::timeout;
        read.beats = random_() % beats;
        read.forever = true;
      } else if (chance(random_, how_.error)) {
        read.code = static_cast<ReadCode>(1 + random_() % 3);
        read.beats = random_() % beats;
      }
      reads_.push_back(read);
      most_reads = std::max<std::uint64_t>(most_reads, reads_.size());
    }
    if (top_.invalidate_ready != 0) {
      for (const auto& [line, version] : commanded_) promised_[line] = version;
      commanded_.clear();
      if (top_.invalidate_valid != 0) {
        ++invalidations;
        for (const auto& [line, version] : versions_) {
          if (pending_->has(line)) commanded_[line] = version;
        }
        pending_.reset();
      }
    }
  }

  sim::Simulation<typename Config::Model>& simulation_;
  typename Config::Model& top_;
  Random& random_;
  Cache model_;
  Behaviour how_{"one at a time", 0, 0, 1, 1, 100, 0, 0, false};
  std::vector<Cache::Range> locks_ = std::vector<Cache::Range>(Config::LOCKS);
  std::array<std::vector<std::optional<Asked>>, 2> asked_;
  std::array<std::optional<std::uint64_t>, 2> want_;
  std::optional<Cache::Range> pending_, forced_;
  std::vector<Read> reads_;
  int silent_ = 0, rested_ = 0;
  std::size_t was_reads_ = 0;
  bool open_ = false;
  std::vector<int> owed_;  // of each slot, clocks until its response is no longer outstanding
  std::map<std::uint64_t, std::uint64_t> versions_, promised_, commanded_;
  std::array<std::optional<Cache::Answer>, 2> shown_;  // by the model on the clock before
  std::array<std::optional<FirstBeat>, 2> first_;
};

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_cache: outputs are the model's on every clock, every answer is what memory holds",
                        "[unit][cchip_cache]", cchip_cache_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    for (const Behaviour& how : behaviours) {
      CAPTURE(how.name);
      CacheBench<TestType> bench(simulation, random);
      bench.run(how, 6000);
      CAPTURE(bench.reads, bench.hits, bench.waits, bench.agains, bench.invalidations, bench.slowest);
      REQUIRE(bench.answers[0] > (how.silence != 0 ? 10 : 50));
      REQUIRE(bench.reads > 5);
      if (how.sets != 0) REQUIRE(bench.waits > 0);
      // lines of one set on all places: each has its turn
      if (how.sets == 1)
        REQUIRE(bench.slowest < static_cast<int>(CacheBench<TestType>::sets) + 300 + 32 * 2 * TestType::PLACES);
      REQUIRE((bench.invalidations != 0) == (how.invalidate != 0));
      const auto errors = bench.answers[1] + bench.answers[2] + bench.answers[3];
      if (how.error == 0) REQUIRE(errors == 0);
      if (bench.reads * static_cast<unsigned>(how.error) > 1000) REQUIRE(errors != 0);
      if (how.tags == 1 && how.ask == 100 && TestType::PLACES >= 16 && TestType::CACHE_KB == 1)
        REQUIRE(bench.hits > 4000);
    }
  });
}

namespace {

template <class... Configs>
std::vector<std::array<int, 4>> shapes_of(const std::tuple<Configs...>*) {
  return {{Configs::CACHE_KB, Configs::PLACES, Configs::MISSES, Configs::DATA_W}...};
}

}  // namespace

// The fault that only one pair of values shows (a run of lines, one a clock, needs the widest bus and most slots) lies
// off the diagonal of a table.
TEST_CASE("cchip_cache: the configurations of its test meet in every pair of values", "[unit][cchip_cache]") {
  const auto shapes = shapes_of(static_cast<cchip_cache_configs*>(nullptr));
  int pairs = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      for (const auto& a : shapes) {
        for (const auto& b : shapes) {
          CAPTURE(i, j, a[i], b[j]);
          REQUIRE(
              std::any_of(shapes.begin(), shapes.end(), [&](const auto& s) { return s[i] == a[i] && s[j] == b[j]; }));
          ++pairs;
        }
      }
    }
  }
  REQUIRE(pairs > 0);
}

// A run of lines that arrive one a clock keeps port 0 from the last of those who wait for a line. Its frame stays its
// own.
TEMPLATE_LIST_TEST_CASE("cchip_cache: lines that arrive without a gap take no line from those who wait",
                        "[unit][cchip_cache]", cchip_cache_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    for (const int tags : {3, 12}) {
      CacheBench<TestType> bench(simulation, random);
      Behaviour how{"run", 100, 0, tags, 1, 100, 0, 0, false};
      how.gate = 60;
      bench.run(how, 20000);
      REQUIRE(bench.answers[0] > 50);
    }
  });
}

// One read is lost for ever: nothing but that read fails. All are: each request ends with a code.
TEMPLATE_LIST_TEST_CASE("cchip_cache: a slot whose read memory never answers is out of use", "[unit][cchip_cache]",
                        cchip_cache_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    CacheBench<TestType> bench(simulation, random);
    bench.silent_once(1);
    bench.run({"lost", 80, 0, 8, 20, 80, 0, 0, false}, 8000);
    REQUIRE(bench.answers[static_cast<std::size_t>(ReadCode::timeout)] >= 1);
    REQUIRE(bench.answers[static_cast<std::size_t>(ReadCode::owed)] == 0);
    REQUIRE(bench.answers[0] > 50);

    CacheBench<TestType> dead(simulation, random);
    dead.silent_once(TestType::MISSES);
    dead.run({"dead", 80, 0, 8, 20, 80, 0, 0, false}, 8000);
    REQUIRE(dead.answers[static_cast<std::size_t>(ReadCode::owed)] > 100);
    REQUIRE(dead.reads == TestType::MISSES);
  });
}

// Memory answers on the clock after the request.
TEMPLATE_LIST_TEST_CASE("cchip_cache: clocks of a hit and of a miss, a locked line stays, an invalidated one goes",
                        "[unit][cchip_cache]", cchip_cache_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    using Bench = CacheBench<TestType>;
    Bench bench(simulation, random);
    constexpr std::uint64_t sets = Bench::sets;
    const auto line = [](std::uint64_t tag, std::uint64_t set) { return tag * sets + set; };
    bench.set_locks({line(1, 2), line(2, 3)});  // sets 2 and 3: of tags 1 and 2
    bench.reset();
    bench.drain();
    const auto fetches = [&](std::uint64_t of) {
      const auto before = bench.reads;
      bench.fetch(random() % 2, of);
      return bench.reads != before;
    };

    bench.fetch(0, line(0, 1));  // on the clock on which the entries have been cleared a request waits for a moment
    // 7 clocks to memory's request, one for memory, the beats, 21 from the last of them
    for (const std::size_t port : {0, 1}) {
      REQUIRE(bench.fetch(port, line(port, 5)) == 7 + static_cast<int>(Bench::beats) + 21);
      REQUIRE(bench.fetch(0, line(port, 5)) == 7);
      REQUIRE(bench.fetch(1, line(port, 5)) == 7);
    }
    // the way that was filled first is replaced first
    REQUIRE(fetches(line(2, 5)));
    REQUIRE_FALSE(fetches(line(1, 5)));
    REQUIRE(fetches(line(0, 5)));

    // of two lines to lock in a set, the first one stays
    for (const std::uint64_t tag : {0, 1, 2}) REQUIRE(fetches(line(tag, 3)));
    for (std::uint64_t tag = 3; tag < 8; ++tag) REQUIRE(fetches(line(tag, 3)));
    REQUIRE_FALSE(fetches(line(1, 3)));
    REQUIRE(fetches(line(2, 3)));

    // a command invalidates the lines in its range, the locked one too, and no others
    REQUIRE(fetches(line(0, 4)));
    bench.invalidate({line(0, 6), line(1, 2)});
    REQUIRE_FALSE(fetches(line(0, 4)));
    REQUIRE_FALSE(fetches(line(1, 3)));
    bench.invalidate({line(1, 3), line(1, 3)});
    REQUIRE(fetches(line(1, 3)));
    bench.invalidate({line(1, 3), line(1, 2)});  // none
    REQUIRE_FALSE(fetches(line(1, 3)));
    bench.invalidate({0, (std::uint64_t{1} << TestType::LINE_W) - 1});
    REQUIRE(fetches(line(1, 3)));
    REQUIRE(fetches(line(0, 4)));

    // an error is handed on and not kept
    bench.set_memory(1, 100, 100);
    REQUIRE(fetches(line(0, 7)));
    REQUIRE(bench.answers[0] + bench.answers[1] + bench.answers[2] + bench.answers[3] != bench.answers[0]);
    bench.set_memory(1, 100, 0);
    REQUIRE(fetches(line(0, 7)));
    REQUIRE_FALSE(fetches(line(0, 7)));
  });
}
