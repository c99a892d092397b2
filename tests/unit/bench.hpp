// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the clock-exact tests of the modules share.
#ifndef CCHIP_TESTS_UNIT_BENCH_HPP
#define CCHIP_TESTS_UNIT_BENCH_HPP

#include <catch2/catch.hpp>
#include <cchip/internal/model/sat.hpp>
#include <cchip/internal/model/stream.hpp>
#include <cchip/machines/pair_port.hpp>
#include <cchip/sim/bits.hpp>
#include <cchip/sim/simulation.hpp>
#include <cchip/sim/wave_on_failure.hpp>
#include <cchip/stimulus/boundary.hpp>
#include <cctype>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace cchip::stimulus {}
namespace cchip::test {

using namespace stimulus;

using Random = std::mt19937_64;

/// An agent from two functions.
class Bench : public sim::Agent {
 public:
  using Action = std::function<void(const sim::ClockInfo&)>;
  Bench(Action drive, Action sample) : drive_(std::move(drive)), sample_(std::move(sample)) {}
  void drive(const sim::ClockInfo& now) override { drive_(now); }
  void sample(const sim::ClockInfo& now) override { sample_(now); }

 private:
  Action drive_;
  Action sample_;
};

/// Name of the running test case as part of a file name.
inline std::string test_name() {
  std::string name = Catch::getResultCapture().getCurrentTestName();
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

/// Runs the body with two seeds of what the RTL leaves undefined at power-up (and of the stimulus); a failure
/// leaves a waveform.
template <class Body>
void for_two_power_ups(Body&& body) {
  sim::SimulationOptions options;
  sim::with_wave_on_failure(test_name(), body, options);
  ++options.seed;
  sim::with_wave_on_failure(test_name() + "_2", body, options);
}

/// The same with a simulation of `Model` and random numbers of its seed.
template <class Model, class Body>
void for_two_power_ups(Body&& body) {
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    Random random(options.seed);
    sim::Simulation<Model> simulation(options);
    body(simulation, random);
  });
}

/// \throws sim::SimulationError got differs from expected
template <class Got, class Expected>
void expect(const char* what, const Got& got, const Expected& expected) {
  if (got == expected) return;
  throw sim::SimulationError(std::string(what) + " is " + sim::to_text(got) + ", expected " + sim::to_text(expected));
}

/// The default settings of a test, with a name and some numbers changed.
template <class Settings>
Settings changed(const char* name, std::initializer_list<std::pair<int Settings::*, int>> changes) {
  Settings settings;
  settings.name = name;
  for (const auto& [field, value] : changes) settings.*field = value;
  return settings;
}

inline bool chance(Random& random, int percent) { return static_cast<int>(random() % 100) < percent; }

/// A limit for something that must have `least` clocks: 0 (a default, which must be enough), near `least`, or far away.
inline std::uint32_t any_limit(Random& random, std::uint32_t least) {
  switch (random() % 5) {
    case 0:
      return 0;
    case 1:
      return ~std::uint32_t{0};
    case 2:
      return least;
    case 3:
      return 1U << 20;
    default:
      return least + static_cast<std::uint32_t>(random() % (3 * std::uint64_t{least}));
  }
}

/// Signed numbers of `width` bits at which errors are likely.
inline std::vector<std::int64_t> extremes(int width) {
  const std::int64_t half = std::int64_t{1} << (width - 1);
  return {-half, -half + 1, -1, 0, 1, half - 1};
}

/// Signed number of `width` (up to 64) bits: a boundary value, a small one or any other.
inline std::int64_t random_word(Random& random, int width) {
  if (random() % 4 == 0) return model::wrap(random() % 5 - 2, width);
  const std::int64_t half = width == 64 ? INT64_MAX : (std::int64_t{1} << (width - 1)) - 1;
  return stimulus::draw(random, -half - 1, half);
}
inline model::Word3 random_word3(Random& random, int width) {
  return {random_word(random, width), random_word(random, width), random_word(random, width)};
}

template <class Port>
void set_word3(Port& port, int width, const model::Word3& value) {
  for (int d = 0; d < 3; ++d) sim::set_signed(port, width * d, width, value[static_cast<std::size_t>(d)]);
}
/// Vector `index` of a row of vectors.
template <class Port>
model::Word3 get_word3(const Port& port, int width, int index = 0) {
  const int lsb = 3 * width * index;
  return {sim::get_signed(port, lsb, width), sim::get_signed(port, lsb + width, width),
          sim::get_signed(port, lsb + 2 * width, width)};
}

inline Vec3i random_point(Random& random, int coord_w) {
  const auto w = random_word3(random, coord_w);
  return {static_cast<int>(w[0]), static_cast<int>(w[1]), static_cast<int>(w[2])};
}
inline GridPrimitive random_primitive(Random& random, std::size_t vertices, int coord_w) {
  GridPrimitive p;
  p.kind = vertices == 4 ? Kind::quad : Kind::tri;
  for (std::size_t i = 0; i < vertices; ++i) p.v[i] = random_point(random, coord_w);
  return p;
}
template <class Port>
void set_primitive(Port& port, const GridPrimitive& p, int coord_w) {
  sim::set_vertices(port, p.v, static_cast<int>(p.vertex_count()), coord_w);
}
inline model::Word3 to_word3(const Vec3i& v) { return {v.x(), v.y(), v.z()}; }

/// Dot product without a limit on intermediate sums.
inline sim::Int128 wide_dot(const model::Word3& a, const model::Word3& b) {
  sim::Int128 sum = 0;
  for (std::size_t d = 0; d < 3; ++d) sum += sim::Int128{a[d]} * b[d];
  return sum;
}

}  // namespace cchip::test

#endif
