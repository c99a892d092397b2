// SPDX-License-Identifier: Apache-2.0
#include <cchip/machines/simulated_refit.hpp>
#include <iostream>
#include <map>
#include <models/cchip_refit_axi.hpp>

#include "bench.hpp"
#include "refit_frames.hpp"
#include "refit_shapes.hpp"

using namespace cchip;
using namespace cchip::test;
using sim::AxiFault;
using testing::Deformation;

namespace {

constexpr std::uint32_t base = 0xFEFF0000;  // near the highest
constexpr std::uint64_t most_clocks = 2000000;

/// An image as a host hands it over, and what it is to become.
struct Task {
  std::vector<Line> image, expected;
  model::RefitCommand command;
  std::vector<std::uint32_t> nodes;  ///< their lines

  Task(const Mesh& mesh, Deformation deformation, Random& random) {
    const Object object(mesh);
    const testing::Motion motion(object, object.moved(deformed(mesh, deformation, random).vertices));
    image = expected = motion.handed_over();
    command = {motion.after.header().lines, motion.after.header().root};
    REQUIRE(model::refit_image(expected, command).code == RefitCode::ok);
    for (std::uint32_t n = 1; n < image.size(); ++n) {
      if (motion.is_node(n)) nodes.push_back(n);
    }
  }
};

template <class Config>
struct Refit : sim::SimulatedRefit<Config> {
  using Base = sim::SimulatedRefit<Config>;
  using Base::Base;

  RefitEnd run(const Task& task) { return this->refit(base, task.command.lines, task.command.root, most_clocks); }
  void start_of(const Task& task) { this->start(base, task.command.lines, task.command.root); }
  void no_faults() {
    this->memory().options = {5, 5, 0, false, 100, 100, 1};
    this->memory().read_fault = this->memory().write_fault = [](std::uint64_t) { return AxiFault::none; };
    this->top().limit = 0;
  }
  /// A refit without faults: every line is the model's.
  void good(const Task& task) {
    no_faults();
    const RefitEnd end = run(task);
    REQUIRE(static_cast<int>(end.code) == static_cast<int>(RefitCode::ok));
    REQUIRE(end.lines == task.command.lines - 1);
    REQUIRE(this->lines(base, task.expected.size()) == task.expected);
  }
  /// Each line is that of before or that of behind.
  void one_of_both(const Task& task) {
    const std::vector<Line> got = this->lines(base, task.image.size());
    for (std::size_t n = 0; n < got.size(); ++n) REQUIRE((got[n] == task.image[n] || got[n] == task.expected[n]));
  }
};

void same_code(RefitCode got, RefitCode expected) { REQUIRE(static_cast<int>(got) == static_cast<int>(expected)); }

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_refit_axi: memory is the model's in every line, for any mesh and memory",
                        "[unit][cchip_refit_axi]", cchip_refit_axi_configs) {
  for_two_power_ups([](sim::SimulationOptions options) {
    options.timeout_clocks = 0;
    Random random(options.seed);
    Refit<TestType> bench(options);
    std::size_t lines = 0, changed = 0, mismatches = 0;
    for (const testing::Shape& shape : testing::ten_shapes()) {
      for (const Deformation deformation : {Deformation::small, Deformation::large}) {
        INFO(shape.name);
        const Task task(shape.mesh, deformation, random);
        bench.no_faults();
        if (chance(random, 70)) {
          bench.memory().options = {1 + random() % 60,
                                    1 + random() % 60,
                                    random() % 40,
                                    chance(random, 50),
                                    20 + static_cast<unsigned>(random() % 80),
                                    20 + static_cast<unsigned>(random() % 80),
                                    1 + random() % 3};
        }
        bench.place(base, task.image);
        const RefitEnd end = bench.run(task);
        same_code(end.code, RefitCode::ok);
        REQUIRE(end.lines == task.command.lines - 1);
        const std::vector<Line> got = bench.lines(base, task.expected.size());
        lines += got.size();
        for (std::size_t n = 0; n < got.size(); ++n) {
          changed += got[n] == task.image[n] ? 0 : 1;
          mismatches += got[n] == task.expected[n] ? 0 : 1;
        }
      }
    }
    std::cout << "DATA_W=" << TestType::DATA_W << " lines=" << lines << " changed=" << changed
              << " mismatches=" << mismatches << "\n";
    REQUIRE(changed > 4000);
    REQUIRE(mismatches == 0);
  });
}

TEST_CASE("cchip_refit_axi: memory is what make_image writes for a moved object whose leaves hold it exactly",
          "[unit][cchip_refit_axi]") {
  for_two_power_ups([](sim::SimulationOptions options) {
    options.timeout_clocks = 0;
    Random random(options.seed);
    Refit<refit_axi_128> bench(options);
    bench.no_faults();
    for (const testing::Shape& shape : testing::ten_shapes()) {
      INFO(shape.name);
      const Mesh mesh = testing::snapped(shape.mesh, 18);
      const testing::Frames frames =
          testing::frames_of(mesh, testing::snapped(deformed(mesh, Deformation::large, random), 18));
      bench.place(base, testing::handed_over(frames, true));
      const auto command = testing::command_of(frames.moved);
      same_code(bench.refit(base, command.lines, command.root, most_clocks).code, RefitCode::ok);
      REQUIRE(bench.lines(base, frames.moved.lines.size()) == frames.moved.lines);
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_refit_axi: every fault of memory has its code, and the next refit is right",
                        "[unit][cchip_refit_axi]", cchip_refit_axi_configs) {
  for_two_power_ups([](sim::SimulationOptions options) {
    options.timeout_clocks = 0;
    Random random(options.seed);
    Refit<TestType> bench(options);
    std::map<RefitCode, int> bins;
    const Task task(make_sphere(1, 2), Deformation::large, random);
    const std::uint32_t limit = 100;
    // What memory does at one line of one direction.
    const auto at = [&](bool reads, std::uint32_t line, std::function<AxiFault()> action) {
      bench.no_faults();
      bench.place(base, task.image);
      bench.top().limit = limit;
      (reads ? bench.memory().read_fault : bench.memory().write_fault) = [=](std::uint64_t number) {
        return number == base + line ? action() : AxiFault::none;
      };
    };
    const auto ends = [&](RefitCode code, std::uint32_t line) {
      const RefitEnd end = bench.run(task);
      same_code(end.code, code);
      REQUIRE(end.line == line);
      ++bins[code];
    };
    for (std::uint32_t n = 1 + static_cast<std::uint32_t>(random() % 5); n < task.image.size(); n += 5) {
      for (const bool reads : {true, false}) {
        const std::uint32_t line = reads ? n : task.nodes[random() % task.nodes.size()];
        INFO((reads ? "read of line " : "write of line ") << line);
        at(reads, line, [] { return AxiFault::slave_error; });
        ends(reads ? RefitCode::read : RefitCode::write, line);
        bench.one_of_both(task);
        bench.good(task);

        // An answer after the limit. Until it comes, that direction is refused: reads at the first line, writes at the
        // first node that is done.
        auto& memory = bench.memory();
        at(reads, line, [&memory, reads] {
          (reads ? memory.options.latency : memory.options.write_latency) = 30000;
          return AxiFault::none;
        });
        ends(RefitCode::timeout, line);
        REQUIRE(bench.top().outstanding == 1);
        bench.no_faults();
        const RefitEnd refused = bench.run(task);
        same_code(refused.code, RefitCode::owed);
        REQUIRE(refused.line != 0);  // the masters said so, not the engine, which waits longer than they do
        ++bins[RefitCode::owed];
        bench.settle(40000);
        bench.good(task);

        // No answer at all: until a reset of engine and bus.
        at(reads, line, [] { return AxiFault::silence; });
        ends(RefitCode::timeout, line);
        bench.steps(20 * limit);
        REQUIRE(bench.top().outstanding == 1);
        bench.no_faults();
        same_code(bench.run(task).code, RefitCode::owed);
        bench.reset();
        bench.good(task);
      }
    }
    // Addresses and data are not taken from any clock on; then they are.
    const std::uint64_t clocks = [&] {
      bench.no_faults();
      return bench.run(task).clocks;
    }();
    for (int i = 0; i < 20; ++i) {
      bench.no_faults();
      bench.place(base, task.image);
      bench.top().limit = limit;
      bench.start_of(task);
      bench.steps(1 + random() % (clocks - 100));
      bench.memory().options.ready_percent = 0;
      const RefitEnd end = bench.finish(most_clocks);
      same_code(end.code, RefitCode::timeout);
      REQUIRE(end.clocks < clocks + 10 * limit);
      REQUIRE(bench.top().outstanding == 1);
      bench.no_faults();
      bench.settle(1000);
      bench.good(task);
    }
    for (const RefitCode code : {RefitCode::read, RefitCode::write, RefitCode::timeout, RefitCode::owed})
      REQUIRE(bins[code] > 3);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_refit_axi: abort and reset at any clock, and a reset between two refits",
                        "[unit][cchip_refit_axi]", cchip_refit_axi_configs) {
  for_two_power_ups([](sim::SimulationOptions options) {
    options.timeout_clocks = 0;
    Random random(options.seed);
    Refit<TestType> bench(options);
    const Task task(make_torus(1, 0.4, 8, 5), Deformation::large, random);
    const Task other(make_torus(1, 0.4, 6, 5, Kind::quad), Deformation::small, random);
    bench.place(base, task.image);
    bench.no_faults();
    const std::uint64_t clocks = bench.run(task).clocks;
    int aborted = 0;
    for (int i = 0; i < 30; ++i) {
      bench.place(base, task.image);
      bench.memory().options = {1 + random() % 40, 1 + random() % 40, random() % 40, false, 60, 60, 1};
      bench.start_of(task);
      bench.steps(random() % clocks);
      bench.top().s_abort = 1;
      bench.step();
      bench.top().s_abort = 0;
      const RefitEnd end = bench.finish(3000);
      if (end.code != RefitCode::ok) same_code(end.code, RefitCode::abort);
      aborted += end.code == RefitCode::abort ? 1 : 0;
      bench.one_of_both(task);
      // the bus lives on
      bench.settle(100);
      if (chance(random, 50)) bench.reset_engine();
      bench.good(task);
      bench.reset_engine();
      bench.place(base, other.image);
      bench.good(other);
      // engine and bus, at any clock
      bench.place(base, task.image);
      bench.start_of(task);
      bench.steps(random() % clocks);
      bench.reset();
      bench.one_of_both(task);
      bench.good(task);
    }
    REQUIRE(aborted > 15);
    // an abort without a refit does nothing
    bench.top().s_abort = 1;
    bench.steps(5);
    bench.top().s_abort = 0;
    bench.good(task);
  });
}
