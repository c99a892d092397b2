// SPDX-License-Identifier: Apache-2.0
// Ten deformed meshes through cchip_refit_axi: clocks a face, and every line of memory against the functional model.
// Beside that what a refit by Object::moved() and a new Object take on this CPU.
#include <Vrefit_axi_128.h>
#include <Vrefit_axi_64.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cchip/blocks/refit.hpp>
#include <cchip/machines/simulated_refit.hpp>
#include <cchip/program/seed.hpp>
#include <chrono>
#include <exception>
#include <iostream>

#include "refit_shapes.hpp"

namespace cchip::testing {
namespace {

struct Narrow {
  using Model = Vrefit_axi_64;
  static constexpr int DATA_W = 64;
};
struct Wide {
  using Model = Vrefit_axi_128;
  static constexpr int DATA_W = 128;
};
constexpr std::uint32_t base = 0x10000;
constexpr std::uint64_t most_clocks = 100000000;

struct Settings {
  std::uint64_t latency = 60;
  std::uint64_t write_latency = 40;
  int repeats = 20;
  std::uint64_t seed = sim::seed_from_environment();
};

struct Totals {
  std::size_t lines = 0;
  std::size_t mismatches = 0;
};

template <class Config>
class Engine {
 public:
  explicit Engine(const Settings& settings) : machine_(sim::without_timeout(settings.seed)) {
    machine_.memory().options.latency = settings.latency;
    machine_.memory().options.write_latency = settings.write_latency;
  }

  /// \returns clocks
  std::uint64_t run(const std::vector<Line>& image, const model::RefitCommand& command, Totals& totals) {
    std::vector<Line> expected = image;
    if (model::refit_image(expected, command).code != RefitCode::ok)
      throw std::runtime_error("the model refuses an image");
    machine_.place(base, image);
    const RefitEnd end = machine_.refit(base, command.lines, command.root, most_clocks);
    if (end.code != RefitCode::ok)
      throw std::runtime_error(
          fmt::format("the engine ends with code {} at line {}", static_cast<int>(end.code), end.line));
    const std::vector<Line> got = machine_.lines(base, expected.size());
    totals.lines += got.size();
    for (std::size_t n = 0; n < got.size(); ++n) totals.mismatches += got[n] == expected[n] ? 0 : 1;
    return end.clocks;
  }

 private:
  sim::SimulatedRefit<Config> machine_;
};

/// Seconds of the fastest of some runs.
template <class Action>
double least_time(int repeats, Action&& action) {
  double least = 1e300;
  for (int i = 0; i < repeats; ++i) {
    const auto from = std::chrono::steady_clock::now();
    action();
    least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count());
  }
  return least;
}

int run(const Settings& settings) {
  fmt::print("seed={} latency={} write_latency={}\n", settings.seed, settings.latency, settings.write_latency);
  fmt::print("{:<17} {:<6} {:>6} {:>6} {:>7} {:>14} {:>14} {:>12}\n", "mesh", "motion", "faces", "nodes", "leaves",
             "clocks/face,64", "clocks/face,128", "anew/moved");
  std::mt19937_64 random(settings.seed);
  Engine<Narrow> narrow(settings);
  Engine<Wide> wide(settings);
  Totals totals;
  for (const Shape& shape : ten_shapes()) {
    const Object object(shape.mesh);
    const auto faces = static_cast<double>(shape.mesh.faces.size());
    for (const Deformation deformation : {Deformation::small, Deformation::large}) {
      const Mesh behind = deformed(shape.mesh, deformation, random);
      const Object moved = object.moved(behind.vertices);
      const Motion motion(object, moved);
      const bvh::HeaderLine header = motion.after.header();
      const std::vector<Line> image = motion.handed_over();
      const model::RefitCommand command{header.lines, header.root};
      const std::uint64_t clocks_64 = narrow.run(image, command, totals);
      const std::uint64_t clocks_128 = wide.run(image, command, totals);
      const double refit = least_time(settings.repeats, [&] { (void)object.moved(behind.vertices); });
      const double anew = least_time(settings.repeats, [&] { (void)Object(behind); });
      fmt::print("{:<17} {:<6} {:>6} {:>6} {:>7} {:>14.1f} {:>15.1f} {:>12.1f}\n", shape.name,
                 deformation == Deformation::small ? "small" : "large", shape.mesh.faces.size(), header.inner,
                 header.leaves, static_cast<double>(clocks_64) / faces, static_cast<double>(clocks_128) / faces,
                 anew / refit);
    }
  }
  fmt::print("lines={} mismatches={}\n", totals.lines, totals.mismatches);
  return totals.mismatches == 0 ? 0 : 3;
}

}  // namespace
}  // namespace cchip::testing

int main(int argc, char** argv) {
  cchip::testing::Settings settings;
  CLI::App app("Clocks a face of the refit engine for ten deformed meshes, and its memory against the model.");
  app.add_option("--latency", settings.latency, "clocks from an address to its first beat, at least")
      ->check(CLI::PositiveNumber);
  app.add_option("--write-latency", settings.write_latency, "clocks from a write to its response, at least");
  app.add_option("--repeats", settings.repeats, "runs on the CPU of which the fastest counts")
      ->check(CLI::PositiveNumber);
  app.add_option("--seed", settings.seed, "seed of the deformations (default: CCHIP_SEED, or 1)");
  CLI11_PARSE(app, argc, argv);
  try {
    return cchip::testing::run(settings);
  } catch (const std::exception& error) {
    std::cerr << "cchip_refit_bench: " << error.what() << std::endl;
    return 1;
  }
}
