// SPDX-License-Identifier: Apache-2.0
// The paper's experiment: triangles, then quads, in turn; overhead of the swaps against queries per swap.
#include <fmt/format.h>

#include <array>
#include <cchip/internal/wire/bitstream.hpp>

#include "swap_chip.hpp"

namespace cchip::testing {
namespace {

namespace regs = chip_registers;

/// Clocks of batches of `queries` of triangle objects and of quad objects in turn.
struct CurvePoint {
  double clocks = 0;  ///< of a batch, mean
  double swaps = 0;   ///< of a batch
  double swap_clocks = 0;
  double worked = 0;  ///< clocks of TRANSFER of a batch on which the box test worked
};

SwapChip make_curve_chip(unsigned slots, const CurveSettings& settings) {
  ChipDriverOptions driver;
  driver.memory_bytes = std::uint64_t{1} << 25U;
  driver.bitstream = [&](std::uint8_t slot, ModuleId id) {
    const std::size_t bytes = id == ModuleId::tri_tri     ? settings.triangle_bytes
                              : id == ModuleId::quad_quad ? settings.quad_bytes
                                                          : (settings.triangle_bytes + settings.quad_bytes) / 8 * 4;
    return make_bitstream(slot, id, make_payload(slot, id, bytes, 1));
  };
  return make_swap_chip(slots, {}, driver, settings.seed);
}

/// The swap in progress ends: it belongs to its batch, also if no query of it had to wait.
void end_swaps(SwapChip& chip, unsigned slots) {
  for (std::uint32_t slot = 0; slot < slots;) {
    const std::uint32_t status = chip.machine->read_register(regs::slot_status::offset(slot));
    if ((status & regs::slot_status::phase_mask) == 0) {
      ++slot;
    } else {
      chip.machine->proceed();
      slot = 0;
    }
  }
}

CurvePoint measure_curve(unsigned slots, std::size_t queries, const CurveSettings& settings) {
  SwapChip chip = make_curve_chip(slots, settings);
  const Object triangles_a(make_body(6, 0.3, 3)), triangles_b(make_torus(1, 0.4, 36, 24));
  const Object quads_a(make_torus(0.8, 0.3, 24, 18, Kind::quad)), quads_b(make_torus(1, 0.4, 36, 24, Kind::quad));
  Random random(settings.seed);
  const MixedObjects poses;
  CurvePoint point;
  std::size_t batches = 0;
  std::array<std::uint64_t, 2> before = {};
  for (std::size_t round = 0; round < settings.rounds + 1; ++round) {
    // the first round loads what is there from then on, and fills the cache
    for (const bool quads : {false, true}) {
      std::vector<PosePair> batch;
      for (std::size_t i = 0; i < (round == 0 ? 1 : queries); ++i) batch.push_back(poses.draw(random).pose);
      const Object& a = quads ? quads_a : triangles_a;
      const Object& b = quads ? quads_b : triangles_b;
      const std::uint64_t from = chip.clocks();
      const std::uint32_t swaps = chip.machine->read_register(regs::swaps::offset);
      collide(*chip.device, a, b, batch, {}, [](std::size_t, const CollisionResult&) {});
      end_swaps(chip, slots);
      if (round == 0) continue;
      ++batches;
      point.clocks += static_cast<double>(chip.clocks() - from);
      if (chip.machine->read_register(regs::swaps::offset) == swaps) continue;
      ++point.swaps;
      for (std::uint32_t phase = 0; phase < regs::phase_clocks::count; ++phase)
        point.swap_clocks += chip.machine->read_register(regs::phase_clocks::offset(phase));
    }
    if (round == 0) before = *chip.overlap;
  }
  const auto n = static_cast<double>(batches);
  point.worked = static_cast<double>((*chip.overlap)[1] - before[1]) / n;
  for (double* x : {&point.clocks, &point.swaps, &point.swap_clocks}) *x /= n;
  return point;
}

/// A batch of `queries` each of triangles, of triangles against quads and of quads: three modules, each for its part.
/// With two slots the host asks for the next one while the one before works. \returns clocks, swaps of a batch
CurvePoint measure_three(unsigned slots, std::size_t queries, const CurveSettings& settings) {
  SwapChip chip = make_curve_chip(slots, settings);
  const std::array<Object, 3> objects = {Object(make_body(6, 0.3, 3)), Object(make_torus(1, 0.4, 36, 24)),
                                         Object(make_torus(1, 0.4, 36, 24, Kind::quad))};
  const Object quads(make_torus(0.8, 0.3, 24, 18, Kind::quad));
  Random random(settings.seed);
  const MixedObjects poses;
  CurvePoint point;
  for (std::size_t round = 0; round < settings.rounds + 1; ++round) {
    std::vector<CollisionQuery> batch;
    std::vector<PosePair> placed;
    const std::size_t each = round == 0 ? 1 : queries;
    for (std::size_t i = 0; i < 3 * each; ++i) placed.push_back(poses.draw(random).pose);
    for (std::size_t i = 0; i < 3 * each; ++i) {
      const std::size_t part = i / each;
      const Object& first = part == 2 ? quads : objects[0];
      const Object& second = part == 1 ? objects[2] : objects[part];
      batch.push_back({&first, &placed[i].a, &second, &placed[i].b});
    }
    const std::uint64_t from = chip.clocks();
    const std::uint32_t swaps = chip.machine->read_register(regs::swaps::offset);
    collide(*chip.device, batch);
    end_swaps(chip, slots);
    if (round == 0) continue;
    point.clocks += static_cast<double>(chip.clocks() - from) / static_cast<double>(settings.rounds);
    point.swaps += static_cast<double>(chip.machine->read_register(regs::swaps::offset) - swaps) /
                   static_cast<double>(settings.rounds);
  }
  return point;
}

}  // namespace

int run_three(const CurveSettings& settings) {
  fmt::print("{:>8} {:>14} {:>7} {:>14} {:>7}\n", "queries", "one slot", "swaps", "two slots", "swaps");
  for (const std::size_t queries : settings.queries) {
    const CurvePoint one = measure_three(1, queries, settings);
    const CurvePoint two = measure_three(2, queries, settings);
    fmt::print("{:>8} {:>14.1f} {:>7.2f} {:>14.1f} {:>7.2f}\n", queries, one.clocks, one.swaps, two.clocks, two.swaps);
    std::fflush(stdout);
  }
  return 0;
}

int run_curve(const CurveSettings& settings) {
  // eq. (4): a word of 8 bit takes 2 clocks, 100 MHz and a port of 50 MHz
  const double equation4 = static_cast<double>(settings.triangle_bytes + settings.quad_bytes);
  fmt::print("eq. (4): {:.0f} clocks a swap, mean of both bitstreams\n", equation4);
  fmt::print("{:>8} {:>14} {:>14} {:>7} {:>12} {:>11} {:>11} {:>12}\n", "queries", "both stay", "one slot", "swaps",
             "swap clocks", "overhead %", "eq. (5) %", "box tests");
  for (const std::size_t queries : settings.queries) {
    const CurvePoint both = measure_curve(2, queries, settings);
    const CurvePoint one = measure_curve(1, queries, settings);
    fmt::print("{:>8} {:>14.1f} {:>14.1f} {:>7.2f} {:>12.1f} {:>11.3f} {:>11.3f} {:>12.1f}\n", queries, both.clocks,
               one.clocks, one.swaps, one.swap_clocks, 100 * (one.clocks - both.clocks) / both.clocks,
               100 * equation4 / both.clocks, one.worked);
    if (both.swaps != 0) fmt::print("both stay, yet {:.2f} swaps a batch\n", both.swaps);
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace cchip::testing
