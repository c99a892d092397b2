// SPDX-License-Identifier: Apache-2.0
#include "chip_scaling.hpp"

#include <Vcchip_chip.h>
#include <Vchip_256.h>
#include <Vchip_512.h>
#include <fmt/format.h>

#include <cchip/cpu_device.hpp>
#include <cchip/driver/chip_driver.hpp>
#include <cchip/driver/chip_host.hpp>
#include <cchip/machines/chips_machine.hpp>
#include <map>
#include <stdexcept>

#include "measure.hpp"
#include "mesh_pairs.hpp"

namespace cchip::testing {
namespace {

/// Queries of one class between two objects, and the CPU device's answers.
struct Batch {
  const Object* a = nullptr;
  const Object* b = nullptr;
  std::vector<PosePair> poses;
  std::vector<char> hits;
};

struct Measured {
  double clocks = 0;        ///< a query
  double read_percent = 0;  ///< clocks on which the bus carries a beat of a read
  double write_percent = 0;
  std::size_t wrong = 0;
};

template <class Model, int DATA_W>
Measured measure(unsigned count, std::uint64_t seed, const Batch& batch) {
  const auto chips = std::make_shared<sim::ChipsOnMemory<Model, DATA_W>>(count, sim::without_timeout(seed));
  ChipDriverOptions driver;
  driver.query_log2 = 5;  // as open_simulated_chip(); also for one chip, so that only their number differs
  const auto device = make_chip_device(open_chips(sim::machines_of(chips), driver));
  // images are written, and each chip's cache knows the top of the trees
  collide(*device, *batch.a, *batch.b, std::vector<PosePair>(count, batch.poses[0]));
  const auto& bus = chips->bus();
  const std::uint64_t clocks = bus.clocks(), reads = bus.read_beats(), writes = bus.write_beats();
  const std::vector<CollisionResult> got = collide(*device, *batch.a, *batch.b, batch.poses);
  const auto spent = static_cast<double>(bus.clocks() - clocks);
  Measured result;
  result.clocks = spent / static_cast<double>(batch.poses.size());
  result.read_percent = 100 * static_cast<double>(bus.read_beats() - reads) / spent;
  result.write_percent = 100 * static_cast<double>(bus.write_beats() - writes) / spent;
  for (std::size_t i = 0; i < got.size(); ++i) result.wrong += got[i].hit != (batch.hits[i] != 0) ? 1 : 0;
  return result;
}

Measured measure(int width, unsigned count, std::uint64_t seed, const Batch& batch) {
  switch (width) {
    case 128:
      return measure<Vcchip_chip, 128>(count, seed, batch);
    case 256:
      return measure<Vchip_256, 256>(count, seed, batch);
    case 512:
      return measure<Vchip_512, 512>(count, seed, batch);
    default:
      throw std::invalid_argument("no chip with a bus of " + std::to_string(width) + " bit; 128, 256 or 512");
  }
}

}  // namespace

int run_scaling(const ScalingOptions& options) {
  const auto cpu = open_cpu_device({1, {}});
  std::map<std::pair<int, unsigned>, std::map<PoseClass, GeometricMean>> clocks, reads;
  std::size_t queries = 0, wrong = 0;
  const PoseClass classes[] = {PoseClass::touch, PoseClass::far};
  fmt::print(
      "| meshes | class | bus, bit | chips | clocks a query | times | read bus, % | write bus, % | queries/s at {:g} "
      "MHz |\n"
      "|---|---|---|---|---|---|---|---|---|\n",
      options.chip_mhz);
  for (const std::string& name : options.pairs) {
    const MeshPair meshes = mesh_pair(name);
    const Object a(meshes.a), b(meshes.b);
    PoseMaker maker(*cpu, a, b, options.seed);
    std::vector<Approach> approaches;
    for (std::size_t i = 0; i < options.poses; ++i) approaches.push_back(maker.approach());
    for (const PoseClass c : classes) {
      Batch batch{&a, &b, {}, {}};
      for (const Approach& approach : approaches) batch.poses.push_back(maker.pose(approach, c));
      for (const CollisionResult& x : collide(*cpu, a, b, batch.poses)) batch.hits.push_back(x.hit ? 1 : 0);
      for (const int width : options.widths) {
        double of_first = 0;
        for (const unsigned chips : options.chips) {
          const Measured x = measure(width, chips, options.seed, batch);
          if (of_first == 0) of_first = x.clocks;
          queries += batch.poses.size();
          wrong += x.wrong;
          clocks[{width, chips}][c].add(x.clocks);
          reads[{width, chips}][c].add(x.read_percent);
          fmt::print("| {} | {} | {} | {} | {:.1f} | {:.2f} | {:.0f} | {:.1f} | {:.0f} |\n", name, name_of(c), width,
                     chips, x.clocks, of_first / x.clocks, x.read_percent, x.write_percent,
                     options.chip_mhz * 1e6 / x.clocks);
          std::fflush(stdout);
        }
      }
    }
  }
  fmt::print(
      "\n| bus, bit | chips | touch: clocks a query | read bus, % | far: clocks a query | read bus, % |\n"
      "|---|---|---|---|---|---|\n");
  for (const int width : options.widths) {
    for (const unsigned chips : options.chips) {
      const std::pair<int, unsigned> key(width, chips);
      fmt::print("| {} | {} | {:.1f} | {:.0f} | {:.1f} | {:.0f} |\n", width, chips,
                 clocks[key][PoseClass::touch].value(), reads[key][PoseClass::touch].value(),
                 clocks[key][PoseClass::far].value(), reads[key][PoseClass::far].value());
    }
  }
  fmt::print("queries={} differences={}\n", queries, wrong);
  return queries != 0 && wrong == 0 ? 0 : 3;
}

}  // namespace cchip::testing
