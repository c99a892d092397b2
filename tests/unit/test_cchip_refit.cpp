// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iostream>
#include <map>
#include <models/cchip_refit.hpp>
#include <optional>

#include "bench.hpp"
#include "bv_tools.hpp"
#include "refit_frames.hpp"

using namespace cchip;
using namespace cchip::test;
using bvh::NodeKind;

namespace {

/// How memory behaves; chances in per cent.
struct Behaviour {
  int beat = 100;                          ///< of a beat of a read, an accepted beat of a write, an answer, on a clock
  int latency = 0;                         ///< most clocks before the first beat
  std::optional<std::uint32_t> bad_read;   ///< line whose read ends with an error
  std::optional<std::uint32_t> bad_write;  ///< line whose write does
  unsigned bad_code = 1;
  std::optional<std::uint32_t> lost;        ///< line whose read is answered only when `found` is set
  std::optional<std::uint32_t> lost_write;  ///< line whose write is
};

struct End {
  RefitCode code{};
  std::uint32_t line = 0;
  std::uint32_t lines = 0;
};

template <class Config>
class RefitBench {
 public:
  static constexpr int width = Config::DATA_W;
  static constexpr std::size_t beats = 512 / Config::DATA_W;

  RefitBench(sim::Simulation<typename Config::Model>& simulation, Random& random)
      : simulation_(simulation), top_(simulation.top()), random_(random) {
    top_.limit = 0;
    idle();
    reset();
  }

  void reset() {
    idle();
    top_.s_valid = 0;
    top_.s_abort = 0;
    top_.m_ready = 0;
    reads_ = {};
    write_.clear();
    answer_.reset();
    simulation_.reset();
  }

  void command(std::uint32_t lines, std::uint32_t root) {
    command(static_cast<std::uint32_t>(random_() % 0xFF000000U), lines, root);
  }
  void command(std::uint32_t at, std::uint32_t lines, std::uint32_t root) {
    top_.s_valid = 1;
    top_.s_base = base = at;
    top_.s_lines = lines;
    top_.s_root = root;
    for (int n = 0; top_.s_ready == 0; ++n) {
      REQUIRE(n < 10);
      step();
    }
    step();
    top_.s_valid = 0;
  }

  End end(std::uint64_t most) {
    std::uint64_t waited = 0;
    while (top_.m_valid == 0) {
      if (++waited > most) throw sim::SimulationError("a refit does not end");
      step();
    }
    const End result{static_cast<RefitCode>(top_.m_code), top_.m_line, top_.m_lines};
    for (int n = 0; n < 3; ++n) {  // it stays until it is taken
      step();
      REQUIRE(top_.m_valid == 1);
      REQUIRE(top_.m_code == static_cast<unsigned>(result.code));
    }
    top_.m_ready = 1;
    step();
    top_.m_ready = 0;
    return result;
  }

  void step() {
    idle();
    const std::optional<std::size_t> slot = next_slot();
    if (slot && chance(random_, how.beat)) {
      const Read* read = &*reads_[*slot];
      const bool last = read->beat + 1 == beats;
      top_.s_read_valid = 1;
      top_.s_read_slot = static_cast<CData>(*slot);
      top_.s_read_beat = static_cast<CData>(read->beat);
      top_.s_read_last = last ? 1 : 0;
      top_.s_read_code = static_cast<CData>(read->line == how.bad_read ? how.bad_code : 0U);
      const Line& line = memory.at(index_of(read->line));
      for (int byte = 0; byte < width / 8; ++byte) {
        sim::set_bits(top_.s_read_data, 8 * byte, 8, line[read->beat * width / 8 + static_cast<std::size_t>(byte)]);
      }
    }
    if (answer_ && (how.lost_write != *answer_ || found) && chance(random_, how.beat)) {
      top_.s_write_valid = 1;
      top_.s_write_code = static_cast<CData>(*answer_ == how.bad_write ? how.bad_code : 0U);
    }
    top_.m_write_ready = chance(random_, how.beat) && !stuck ? 1 : 0;
    simulation_.settle();
    if (top_.s_read_valid != 0 && ++reads_[*slot]->beat == beats) reads_[*slot].reset();
    if (top_.m_read_valid != 0) {
      std::optional<Read>& asked = reads_[top_.m_read_slot];
      REQUIRE(!asked);
      ++reads;
      asked = Read{top_.m_read_line - base, 0,
                   how.latency == 0 ? 0 : static_cast<int>(random_() % static_cast<unsigned>(how.latency))};
      REQUIRE(index_of(asked->line) < memory.size());
      if (!reads_[top_.m_read_slot ^ 1U]) older_ = top_.m_read_slot;
    }
    if (top_.s_write_valid != 0) {
      if (top_.s_write_code == 0) memory.at(index_of(*answer_)) = written_;
      answer_.reset();
    }
    if (top_.m_write_valid != 0 && top_.m_write_ready != 0) {
      const std::uint32_t line = top_.m_write_line - base;
      REQUIRE(index_of(line) < memory.size());
      REQUIRE(top_.m_write_beat == write_.size());
      REQUIRE((top_.m_write_last != 0) == (write_.size() + 1 == beats));
      for (int byte = 0; byte < width / 8; ++byte) {
        written_[write_.size() * width / 8 + static_cast<std::size_t>(byte)] =
            static_cast<std::uint8_t>(sim::get_bits(top_.m_write_data, 8 * byte, 8));
      }
      write_.push_back(line);
      if (write_.size() == beats) {
        REQUIRE(!answer_);
        answer_ = line;
        write_.clear();
        ++writes;
      }
    }
    simulation_.rise();
    ++clocks;
  }

  void abort(bool on) { top_.s_abort = on ? 1 : 0; }
  void limit(std::uint32_t clocks_) { top_.limit = clocks_; }

  std::vector<Line> memory;
  std::map<std::uint32_t, std::size_t> places;  ///< of lines in `memory`, if their numbers are not these
  Behaviour how;
  std::uint32_t base = 0;
  bool found = false;
  bool stuck = false;
  std::uint64_t clocks = 0, reads = 0, writes = 0;

 private:
  struct Read {
    std::uint32_t line;
    std::size_t beat;
    int wait;
  };

  /// Slot of the next beat: that of the older read, unless it waits, or unless beats are late and mixed.
  std::optional<std::size_t> next_slot() {
    if (!reads_[older_]) older_ ^= 1U;
    std::array<bool, 2> ready{};
    for (std::size_t n = 0; n < 2; ++n) {
      ready[n] = reads_[n] && (how.lost != reads_[n]->line || found) && reads_[n]->wait-- <= 0;
    }
    const std::size_t younger = older_ ^ 1U;
    if (ready[younger] && (!ready[older_] || (how.beat < 100 && chance(random_, 50)))) return younger;
    return ready[older_] ? std::optional<std::size_t>(older_) : std::nullopt;
  }

  std::size_t index_of(std::uint32_t line) const {
    if (places.empty()) return line;
    const auto place = places.find(line);
    return place == places.end() ? memory.size() : place->second;
  }

  void idle() {
    top_.s_read_valid = 0;
    top_.s_read_slot = static_cast<CData>(random_() % 2);
    top_.s_read_beat = static_cast<CData>(random_() % 8);
    top_.s_read_last = 0;
    top_.s_read_code = 0;
    top_.s_write_valid = 0;
    top_.s_write_code = static_cast<CData>(random_() % 4);
    top_.m_write_ready = 0;
    sim::set_random(top_.s_read_data, width, random_);
  }

  sim::Simulation<typename Config::Model>& simulation_;
  typename Config::Model& top_;
  Random& random_;
  std::array<std::optional<Read>, 2> reads_;  ///< of both slots
  std::size_t older_ = 0;                     ///< slot of the one that was requested first
  std::vector<std::uint32_t> write_;
  std::optional<std::uint32_t> answer_;
  Line written_{};
};

/// A moved object whose leaves hold the mesh exactly.
testing::Frames exact_frames(const Mesh& any, Random& random) {
  const Mesh mesh = testing::snapped(any, 18);
  return testing::frames_of(mesh, testing::snapped(testing::bent(mesh, 0.1, random), 18));
}

/// A number of `bits` bits, often at a boundary, and of any size.
int any_signed(unsigned bits, Random& random) {
  const int half = 1 << (bits - 1);
  return edge(random, -half, half - 1) / (chance(random, 50) ? 1 : 1 << (random() % bits));
}

/// A tree whose lines have numbers up to 2^24 and whose leaves have any origins, steps and corners.
struct AnyTree {
  std::vector<Line> lines;             ///< without gaps between the numbers, as the model takes them
  std::vector<std::uint32_t> numbers;  ///< those that the chip meets
  std::vector<bool> inner;
  std::vector<int> level;       ///< 1: the root
  model::RefitCommand command;  ///< with these

  AnyTree(int levels, Random& random) : lines(2), inner(2, true), level(2, 1) {
    const unsigned spread = 1 + static_cast<unsigned>(random() % 24);  // bits of the distances between leaves
    std::array<std::int32_t, 3> centre{};
    for (std::int32_t& x : centre) x = any_signed(24, random);
    std::optional<int> edge;
    const std::size_t axis = random() % 3;
    if (random() % 3 == 0) {
      edge = static_cast<int>(random() % 17);
      for (std::int32_t& x : centre) x = x / 4 / 64 * 64 + (random() % 4 == 0 ? static_cast<int>(random() % 64) : 0);
    }
    const std::size_t most = random() % 3 == 0 ? 90 : 20;
    const bool chain = random() % 8 == 0;         // as deep as there are levels
    std::vector<std::size_t> groups = {0, 1, 2};  // where children of one node begin
    for (std::size_t n = 1; n < lines.size(); ++n) {
      for (std::uint8_t& byte : lines[n]) byte = static_cast<std::uint8_t>(random());
      if (!inner[n]) continue;
      const std::size_t children = lines.size() >= most ? 1 : 1 + random() % 4;
      put(lines[n], bvh::inner_field::children, children - 1);
      put(lines[n], bvh::inner_field::first, lines.size());
      for (std::size_t i = 0; i < children; ++i) {
        const bool more = chain ? i == 0 : lines.size() < most && (i == 0 || random() % 3 == 0);
        const bool node = level[n] < levels && more;
        const auto kind = static_cast<NodeKind>(node ? 0 : 1 + random() % 3);
        put(lines[n], bvh::inner_field::kind, static_cast<int>(kind), i);
        lines.emplace_back();
        inner.push_back(node);
        level.push_back(level[n] + 1);
        kinds_.resize(lines.size());
        kinds_.back() = kind;
      }
      groups.push_back(lines.size());
    }
    for (std::size_t n = 1; n < lines.size(); ++n) {
      if (!inner[n]) make_leaf(lines[n], kinds_[n], centre, spread, edge, axis, random);
    }
    // gaps in front of the root and of the children of each node
    const auto count = static_cast<std::uint32_t>(lines.size());
    const std::uint32_t room = ((1U << 24U) - count) >> (random() % 24);
    std::vector<std::uint32_t> gaps;
    for (std::size_t n = 0; n < groups.size(); ++n) gaps.push_back(static_cast<std::uint32_t>(random() % (room + 1)));
    std::sort(gaps.begin(), gaps.end());
    if (random() % 4 == 0) {  // a root far behind the header
      for (std::uint32_t& gap : gaps) gap = room - (room - gap) / 2;
    }
    gaps.front() = 0;
    numbers.push_back(0);
    for (std::size_t n = 1, group = 0; n < lines.size(); ++n) {
      while (group + 1 < groups.size() && n >= groups[group + 1]) ++group;
      numbers.push_back(static_cast<std::uint32_t>(n) + gaps[group]);
    }
    command = {numbers.back() + 1, numbers[1]};
  }

  /// Clocks of the refit that makes `image`, if memory answers at once.
  std::uint64_t clocks(const std::vector<Line>& image, std::size_t beats) const {
    Schedule at;
    visit(1, 0, image, beats, at);
    return at.write_end + 7;
  }

  /// Nodes name their children by the numbers of the chip.
  std::vector<Line> renumbered(std::vector<Line> image) const {
    for (std::size_t n = 1; n < image.size(); ++n) {
      if (inner[n]) put(image[n], bvh::inner_field::first, numbers[get(image[n], bvh::inner_field::first)]);
    }
    return image;
  }

 private:
  /// The clock, counted from the one behind the command, on which what is next may begin, as the datasheet says.
  struct Schedule {
    std::uint64_t ask = 0;                   ///< the next request
    std::uint64_t beat = 0;                  ///< the next beat of a read
    std::uint64_t take = 0;                  ///< the next line is taken
    std::array<std::uint64_t, 2> room = {};  ///< requests, for want of a place for their line
    std::uint64_t finish = 0;                ///< the next node is finished
    std::uint64_t write_end = 0;             ///< last beat of the last write
    int level = 0;                           ///< of the node finished last
    std::uint64_t found = 0, children = 0;   ///< its step is found; its children
  };

  void visit(std::size_t n, std::uint64_t child, const std::vector<Line>& image, std::size_t beats,
             Schedule& at) const {
    const std::uint64_t asked = std::max(at.ask, at.room[0]);
    at.beat = std::max(asked + 2, at.beat) + beats;
    const std::uint64_t taken = std::max(at.take, at.beat + (inner[n] ? 2 : 0));
    at.room = {at.room[1], taken + 1};
    if (!inner[n]) {
      at.ask = asked + 2;
      // a node of the same level may still need the place of its bounds
      const std::uint64_t free = at.level == level[n] - 1 ? at.found + 16 * std::min(child, at.children) + 2 : 0;
      at.take = std::max(taken + 1, free) + 13 * bvh::vertices_in(kinds_[n]) + 1;
      return;
    }
    at.ask = at.beat + 2;
    at.take = taken + 2;
    const auto first = static_cast<std::size_t>(get(image[n], bvh::inner_field::first));
    const std::uint64_t children = 1 + static_cast<std::uint64_t>(get(image[n], bvh::inner_field::children));
    for (std::size_t i = 0; i < children; ++i) {
      visit(first + i, i, image, beats, at);
    }
    const std::uint64_t begun = std::max(at.take, at.finish);
    at.ask += 2;
    at.take = begun + 15;
    at.level = level[n];
    at.children = children;
    at.found = begun + 17 + static_cast<std::uint64_t>(get(image[n], bvh::inner_field::step));
    at.write_end = at.found + 15 * children + 13 + beats;
    at.finish = at.write_end + 1;
  }

  /// With `edge` boxes are as wide as a node holds with a step of 2^edge, give or take little: at -64 and 63 steps
  /// decides one unit.
  static void make_leaf(Line& line, NodeKind kind, const std::array<std::int32_t, 3>& centre, unsigned spread,
                        std::optional<int> edge, std::size_t axis, Random& random) {
    const auto few = [&](int most) { return number(random, -most, most); };
    for (std::size_t i = 0; i < 3; ++i) {
      std::int32_t from_centre = any_signed(spread, random);
      if (edge && i != axis) {
        from_centre = few(20);
      } else if (edge) {
        from_centre = (64 << *edge) + (random() % 2 == 0 ? few(3) : few(2) * (1 << *edge));
        if (random() % 2 == 0) from_centre = -from_centre;
      }
      put(line, bvh::leaf_field::origin, std::clamp(centre[i] + from_centre, -(1 << 23), (1 << 23) - 1), i);
    }
    // one in 50 may reach beyond what a node holds
    put(line, bvh::leaf_field::extent,
        edge                 ? random() % 3
        : random() % 50 == 0 ? 24
                             : random() % (spread + 1) * 23 / 24);
    put(line, bvh::leaf_field::rounded, random() % 2);
    const Field& field = kind == NodeKind::quad ? bvh::leaf_field::quad : bvh::leaf_field::triangle;
    for (std::size_t i = 0; i < field.count; ++i) {
      put(line, field, edge ? few(1) : any_signed(static_cast<unsigned>(field.width), random), i);
    }
  }

  std::vector<NodeKind> kinds_;
};

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_refit: numbers of all sizes, of lines, origins, steps and corners",
                        "[unit][cchip_refit]", cchip_refit_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    RefitBench<TestType> bench(simulation, random);
    std::array<int, bvh::step_max + 1> steps{};
    std::array<int, 25> bits{};  // of the number of a line
    std::map<RefitCode, int> codes;
    int deepest = 0;
    for (int n = 0; n < 250; ++n) {
      const AnyTree tree(TestType::LEVELS, random);
      std::vector<Line> expected = tree.lines;
      const auto count = static_cast<std::uint32_t>(expected.size());
      const auto result = model::refit_image(expected, {count, 1}, TestType::LEVELS);
      bench.memory = tree.renumbered(tree.lines);
      bench.places.clear();
      for (std::size_t i = 0; i < tree.numbers.size(); ++i) bench.places[tree.numbers[i]] = i;
      bench.how = {};
      bench.how.beat = n % 2 == 0 ? 100 : 60;
      bench.command(tree.command.lines, tree.command.root);
      const std::uint64_t from = bench.clocks;
      const End end = bench.end(1000000);
      if (n % 2 == 0 && end.code == RefitCode::ok) REQUIRE(bench.clocks - from == tree.clocks(expected, bench.beats));
      REQUIRE(static_cast<int>(end.code) == static_cast<int>(result.code));
      REQUIRE(end.line == tree.numbers[result.line]);
      REQUIRE(end.lines == result.lines);
      REQUIRE((bench.memory == tree.renumbered(expected)));
      ++codes[end.code];
      for (std::uint32_t i = 1; i < count; ++i) {
        unsigned width = 0;
        while (width < 24 && tree.numbers[i] >> width != 0) ++width;
        ++bits[width];
        if (!tree.inner[i] || end.code != RefitCode::ok) continue;
        ++steps[static_cast<std::size_t>(get(expected[i], bvh::inner_field::step))];
        deepest = std::max(deepest, tree.level[i]);
      }
    }
    std::cout << "steps";
    for (const int times : steps) std::cout << " " << times;
    std::cout << " deepest=" << deepest << " ok=" << codes[RefitCode::ok] << " range=" << codes[RefitCode::range]
              << "\n";
    for (const int times : steps) CHECK(times > 0);
    for (std::size_t n = 1; n < bits.size(); ++n) CHECK(bits[n] > 0);
    CHECK(codes[RefitCode::range] > 0);
    CHECK(codes[RefitCode::ok] > 100);
    CHECK(deepest == TestType::LEVELS);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_refit: memory holds what make_image writes for the moved object", "[unit][cchip_refit]",
                        cchip_refit_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    RefitBench<TestType> bench(simulation, random);
    std::uint64_t lines = 0, leaves = 0, mismatches = 0, clocks = 0;
    int slow = 0;
    for (const Mesh& mesh : testing::assorted_meshes(random)) {
      const testing::Frames frames = exact_frames(mesh, random);
      const auto command = testing::command_of(frames.moved);
      if (frames.moved.header().depth > TestType::LEVELS + 1) continue;
      bench.memory = testing::handed_over(frames, true);
      bench.how = {};
      if (slow++ % 2 != 0) {
        bench.how.beat = 40;
        bench.how.latency = 50;
      }
      const std::uint64_t from = bench.clocks;
      bench.reads = bench.writes = 0;
      bench.command(command.lines, command.root);
      const End end = bench.end(2000000);
      REQUIRE(end.code == RefitCode::ok);
      REQUIRE(end.lines == command.lines - 1);
      REQUIRE(bench.reads == command.lines - 1);
      REQUIRE(bench.writes == frames.moved.header().inner);
      if (bench.how.beat == 100) {
        lines += command.lines - 1;
        leaves += frames.moved.header().leaves;
        clocks += bench.clocks - from;
      }
      for (std::size_t n = 0; n < bench.memory.size(); ++n) {
        mismatches += bench.memory[n] == frames.moved.lines[n] ? 0 : 1;
      }
    }
    std::cout << "DATA_W=" << TestType::DATA_W << " lines=" << lines << " leaves=" << leaves
              << " clocks_per_line=" << static_cast<double>(clocks) / static_cast<double>(lines)
              << " mismatches=" << mismatches << "\n";
    REQUIRE(mismatches == 0);
  });
}

TEST_CASE("cchip_refit: every fault ends the refit with its code, and the next one is right", "[unit][cchip_refit]") {
  using Config = refit_128;
  for_two_power_ups<Config::Model>([](auto& simulation, Random& random) {
    RefitBench<Config> bench(simulation, random);
    std::map<RefitCode, int> bins;
    int resets = 0;
    const testing::Frames frames = exact_frames(testing::soup(16, false, random), random);
    const std::vector<Line> start = testing::handed_over(frames, true);
    const auto command = testing::command_of(frames.moved);
    const auto line_count = static_cast<std::uint32_t>(start.size());
    const auto is_inner = [&](std::uint32_t line) { return frames.tree.nodes[line - 1].kind == NodeKind::inner; };
    // A refit as `how` says, then one without faults that must be right.
    const auto good = [&] {
      bench.how = {};
      bench.how.beat = 70;
      bench.memory = start;
      bench.command(command.lines, command.root);
      REQUIRE(bench.end(1000000).code == RefitCode::ok);
      REQUIRE((bench.memory == frames.moved.lines));
      ++bins[RefitCode::ok];
    };
    const auto expect_end = [&](RefitCode code, std::uint32_t line) {
      const End end = bench.end(1000000);
      REQUIRE(static_cast<int>(end.code) == static_cast<int>(code));
      REQUIRE(end.line == line);
      ++bins[code];
    };
    // until the end is taken; the last write begins less than 20 clocks before
    const std::uint64_t clocks = [&] {
      bench.memory = start;
      bench.command(command.lines, command.root);
      const std::uint64_t from = bench.clocks;
      REQUIRE(bench.end(1000000).code == RefitCode::ok);
      return bench.clocks - from;
    }();
    const std::array<RefitCode, 4> read_codes = {RefitCode::ok, RefitCode::read, RefitCode::timeout, RefitCode::owed};
    const std::array<RefitCode, 4> write_codes = {RefitCode::ok, RefitCode::write, RefitCode::timeout, RefitCode::owed};
    for (std::uint32_t line = 1; line < line_count; ++line) {
      bench.memory = start;  // an error of the bus at every line
      bench.how = {};
      bench.how.bad_code = 1 + line % 3;
      bench.how.bad_read = line;
      bench.command(command.lines, command.root);
      expect_end(read_codes[bench.how.bad_code], line);
      if (is_inner(line)) {
        bench.memory = start;
        bench.how.bad_read.reset();
        bench.how.bad_write = line;
        bench.command(command.lines, command.root);
        expect_end(write_codes[bench.how.bad_code], line);
      }
      good();
      // a bad line: the model says what becomes of it
      bench.how = {};
      bench.memory = start;
      Line& bad = bench.memory[line];
      if (!is_inner(line)) {
        put(bad, bvh::leaf_field::extent, 25 + static_cast<int>(random() % 7));
      } else if (line % 3 == 0) {
        put(bad, bvh::inner_field::first, line - random() % 2);
      } else if (line % 3 == 1) {
        put(bad, bvh::inner_field::first, line_count - get(bad, bvh::inner_field::children));
      } else {
        for (std::uint8_t& byte : bad) byte = static_cast<std::uint8_t>(random());
        put(bad, bvh::inner_field::first, line + 1 + random() % 4);
      }
      std::vector<Line> expected = bench.memory;
      const auto result = model::refit_image(expected, command, Config::LEVELS);
      bench.command(command.lines, command.root);
      const End end = bench.end(1000000);
      REQUIRE(static_cast<int>(end.code) == static_cast<int>(result.code));
      REQUIRE(end.line == result.line);
      REQUIRE(end.lines == result.lines);
      REQUIRE((bench.memory == expected));
      ++bins[end.code];
      // memory that does not answer: a timeout, then nothing until it has answered
      for (const bool reads : {true, false}) {
        if (!reads && !is_inner(line)) continue;
        bench.how = {};
        bench.memory = start;
        bench.limit(40);
        (reads ? bench.how.lost : bench.how.lost_write) = line;
        bench.command(command.lines, command.root);
        expect_end(RefitCode::timeout, line);
        bench.command(command.lines, command.root);
        expect_end(RefitCode::owed, 0);
        bench.found = true;
        for (int n = 0; n < 20; ++n) bench.step();
        bench.found = false;
        bench.limit(0);
        good();
      }
      // abort and reset at any clock
      bench.how = {};
      bench.memory = start;
      bench.command(command.lines, command.root);
      for (auto n = random() % (clocks - 20); n > 0; --n) bench.step();
      bench.abort(true);
      bench.step();
      bench.abort(false);
      const End aborted = bench.end(1000);
      REQUIRE(aborted.code == RefitCode::abort);
      ++bins[aborted.code];
      // neither it nor one that comes while no refit is at work ends the next one
      good();
      bench.abort(true);
      for (int n = 0; n < 3; ++n) bench.step();
      bench.abort(false);
      bench.step();
      good();
      bench.memory = start;
      bench.command(command.lines, command.root);
      for (auto n = random() % (clocks - 20); n > 0; --n) bench.step();
      bench.reset();
      ++resets;
      good();
    }
    for (const auto& [lines, root] : {std::pair<std::uint32_t, std::uint32_t>{line_count, 0},
                                      {line_count, line_count},
                                      {(1U << 24U) + 1, 1},
                                      {0, 1}}) {
      bench.command(lines, root);
      expect_end(RefitCode::command, 0);
    }
    // the highest base whose image ends within 32 bits of lines, and the one above
    for (const std::uint32_t above : {0x00FFFFFFU, 0x00800000U, 0U}) {
      bench.command(0xFF000000U + above, command.lines, command.root);
      expect_end(RefitCode::command, 0);
    }
    bench.how = {};
    bench.memory = start;
    bench.command(0xFEFFFFFFU, command.lines, command.root);
    REQUIRE(bench.end(1000000).code == RefitCode::ok);
    REQUIRE((bench.memory == frames.moved.lines));
    // a chain of nodes that is too deep, and one line that all nodes have as their child
    std::vector<Line> chain(Config::LEVELS + 3);
    for (std::uint32_t n = 1; n < chain.size(); ++n) put(chain[n], bvh::inner_field::first, n + 1);
    bench.how = {};
    bench.memory = chain;
    bench.command(static_cast<std::uint32_t>(chain.size()), 1);
    expect_end(RefitCode::depth, Config::LEVELS + 1);
    for (std::uint32_t n = 1; n < chain.size(); ++n) {
      put(chain[n], bvh::inner_field::children, 1);
      put(chain[n], bvh::inner_field::kind, 1, 0);
      put(chain[n], bvh::inner_field::kind, 1, 1);
    }
    bench.memory = chain;
    bench.command(3, 1);
    expect_end(RefitCode::outside, 1);
    // line 3 is a child of both nodes
    put(chain[1], bvh::inner_field::kind, 0, 0);
    put(chain[2], bvh::inner_field::children, 0);
    chain[3] = {};
    bench.memory = chain;
    bench.command(4, 1);
    expect_end(RefitCode::visits, 3);
    // vertices far outside the frame
    Line node{}, leaf{};
    put(node, bvh::inner_field::first, 2);
    put(node, bvh::inner_field::kind, 1, 0);
    put(leaf, bvh::leaf_field::extent, 24);
    put(leaf, bvh::leaf_field::triangle, (1 << 19) - 1, 0);
    put(leaf, bvh::leaf_field::triangle, -(1 << 19), 3);
    bench.memory = {Line{}, node, leaf};
    bench.memory[2][63] = 0;
    put(bench.memory[2], bvh::leaf_field::origin, (1 << 23) - 1, 1);
    std::vector<Line> far = bench.memory;
    const auto outcome = model::refit_image(far, {3, 1}, Config::LEVELS);
    bench.command(3, 1);
    expect_end(outcome.code, outcome.line);
    REQUIRE((bench.memory == far));
    good();
    std::cout << "resets=" << resets;
    for (const auto& [code, count] : bins) std::cout << " code" << static_cast<int>(code) << "=" << count;
    std::cout << "\n";
    for (const RefitCode code :
         {RefitCode::ok, RefitCode::command, RefitCode::read, RefitCode::write, RefitCode::timeout, RefitCode::outside,
          RefitCode::leaf, RefitCode::range, RefitCode::depth, RefitCode::visits, RefitCode::abort, RefitCode::owed}) {
      REQUIRE(bins[code] > 0);
    }
  });
}
