// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_normaliser.hpp>

#include "transform_tools.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

/// Coordinates of a pair: within `bits` bits of each other, on a grid of 2^zeros that need not hold 0.
std::vector<model::MovedVertex> random_pair(Random& random) {
  std::vector<model::MovedVertex> pair(chance(random, 50) ? 3 : 4);
  const int bits = number(random, 1, 44);
  const int zeros = chance(random, 50) ? 0 : number(random, 0, bits);
  const std::array<std::int64_t, 3> offset = [&] {
    std::array<std::int64_t, 3> made = {};
    if (chance(random, 50)) {
      for (auto& x : made) x = static_cast<std::int64_t>(random() % (std::uint64_t{1} << std::min(zeros, 24)));
    }
    return made;
  }();
  const auto coordinate = [&](int width, std::size_t axis) {
    const std::int64_t range = std::int64_t{1} << std::min(bits, width);
    const std::int64_t most = (std::int64_t{1} << (width - 1)) - 1;
    std::int64_t x = static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(range + 1)) - range / 2;
    if (chance(random, 20)) x = chance(random, 50) ? -range / 2 : range / 2 - (chance(random, 50) ? 1 : 0);
    if (chance(random, 5)) x = chance(random, 50) ? most : -most - 1;
    x = (x >> zeros << zeros) + offset[axis];
    return x < -most - 1 || x > most ? offset[axis] : x;
  };
  const bool open = chance(random, 5);
  const bool origin_lost = chance(random, 50);
  // Any number; or a few steps of 2^k with one bit below them, so that each bit decides alone whether one more is
  // needed.
  const auto some_steps = [&] { return std::int64_t{number(random, 1, 16)} << number(random, 0, 11); };
  const auto one_bit = [&] { return chance(random, 30) ? 0 : std::int64_t{1} << number(random, 0, 15); };
  const std::int64_t error_a = chance(random, 30)   ? 0
                               : chance(random, 40) ? some_steps() | one_bit()
                               : chance(random, 20) ? 32768 + number(random, 0, 1) * number(random, 0, 64)  // the most
                                                    : static_cast<std::int64_t>(random() & 0xFFFF) >> random() % 16;
  const std::int64_t error_b = chance(random, 30) ? 0 : static_cast<std::int64_t>(random() % 33);
  const int lossy = chance(random, 50) ? 0 : 40;
  for (model::MovedVertex& v : pair) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      v.a[axis] = coordinate(45, axis);
      v.b[axis] = coordinate(25, axis);
    }
    v.origin_lost = origin_lost && lossy > 0;
    v.lost_a = chance(random, lossy);
    v.lost_b = chance(random, lossy);
    v.error_a = std::min<std::int64_t>(error_a, 32832);
    v.error_b = error_b;
    v.open = open;
  }
  // The span at the border of a power of two: what the least n depends on.
  if (chance(random, 30)) {
    const std::int64_t span =
        (std::int64_t{1} << number(random, 1, 43)) - number(random, 0, 2) * (1LL << number(random, 0, 30));
    for (model::MovedVertex& v : pair) {
      for (auto& x : v.a) x = std::clamp<std::int64_t>(x, 0, std::max<std::int64_t>(span, 0));
      for (auto& x : v.b) x = std::clamp<std::int64_t>(x, 0, std::max<std::int64_t>(span, 0));
    }
    pair[0].a[0] = 0;
    pair[1].a[0] = std::max<std::int64_t>(span, 0);
  }
  // One bit of one coordinate alone.
  if (chance(random, 30)) {
    model::MovedVertex& v = pair[random() % pair.size()];
    const std::size_t axis = random() % 3;
    if (chance(random, 50)) {
      v.a[axis] ^= std::int64_t{1} << number(random, 0, std::min(bits, 43));
    } else {
      v.b[axis] ^= std::int64_t{1} << number(random, 0, std::min(bits, 23));
    }
  }
  pair.front().first = true;
  pair.back().last = true;
  return pair;
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_normaliser: the model's vertices on every clock", "[unit][cchip_normaliser]",
                        cchip_normaliser_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    constexpr int w = TestType::COORD_W;
    constexpr int passes = TestType::PASSES;
    auto& top = simulation.top();
    std::array<std::size_t, 16> etas = {};
    for (const int percent : {100, 30}) {
      model::Normaliser model(w, passes);
      top.s_valid = 0;
      simulation.reset();
      std::vector<model::MovedVertex> pair;
      std::size_t at = 0;
      int pause = 0;
      for (int clock = 0; clock < 30000; ++clock) {
        // A reset in the middle drops what is inside.
        const bool reset = clock % 5000 == 4999;
        if (at == pair.size() && pause == 0 && chance(random, percent)) {
          pair = random_pair(random);
          at = 0;
        }
        std::optional<model::MovedVertex> s;
        if (at < pair.size() && pause == 0) {
          s = pair[at++];
          pause = passes;
        }
        if (pause > 0) --pause;
        const model::MovedVertex shown = s ? *s : random_pair(random).front();  // anything without s_valid
        top.rst = reset ? 1 : 0;
        top.s_valid = s ? 1 : 0;
        top.s_first = shown.first ? 1 : 0;
        top.s_last = shown.last ? 1 : 0;
        set_word3(top.s_a, 45, shown.a);
        set_word3(top.s_b, 25, shown.b);
        top.s_lost = static_cast<CData>((shown.lost_b ? 4 : 0) | (shown.lost_a ? 2 : 0) | (shown.origin_lost ? 1 : 0));
        top.s_error_a = static_cast<SData>(shown.error_a);
        top.s_error_b = static_cast<CData>(shown.error_b);
        top.s_open = shown.open ? 1 : 0;
        simulation.settle();
        REQUIRE((top.m_valid != 0) == model.m().has_value());
        if (model.m()) {
          const model::GridVertex got{top.m_first != 0, top.m_last != 0, get_point(top.m_a, w), get_point(top.m_b, w),
                                      static_cast<int>(top.m_err)};
          CAPTURE(clock, got.a, model.m()->a, got.b, model.m()->b, got.eta, model.m()->eta);
          REQUIRE(got == *model.m());
          ++etas[static_cast<std::size_t>(got.eta)];
        }
        if (reset) {
          model.reset();
          pair.clear();
          at = 0;
          pause = 0;
        } else {
          model.clock(s);
        }
        simulation.rise();
      }
    }
    for (const std::size_t count : etas) REQUIRE(count > 10);
  });
}
