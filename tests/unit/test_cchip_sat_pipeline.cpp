// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_sat_pipeline.hpp>

#include "pair_tools.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

/// The inputs on one clock; nothing on clocks without a valid beat.
struct BeatIn {
  std::uint64_t user = 0;
  model::AxisBeat beat;
  GridPair pair;
};

bool in_plane(const AxisCode& code) { return code.cls == AxisClass::in_plane_a || code.cls == AxisClass::in_plane_b; }

sim::Int128 along(const WideVector& axis, const Vec3i& to, const Vec3i& from) {
  return axis[0] * (to.x() - from.x()) + axis[1] * (to.y() - from.y()) + axis[2] * (to.z() - from.z());
}

/// By definition: all vertices of the other primitive above or below all own ones (or, in-plane, the start of the
/// edge) by more than `margin` times the axis' 1-norm, on an allowed side.
bool apart(const BeatIn& in, int margin) {
  const AxisCode& code = in.beat.code;
  const bool own_b = code.cls == AxisClass::normal_b || code.cls == AxisClass::in_plane_b;
  const GridPrimitive& own = own_b ? in.pair.b : in.pair.a;
  const GridPrimitive& other = own_b ? in.pair.a : in.pair.b;
  const WideVector axis = axis_of(code, in.pair);
  sim::Int128 least_gap = 0;
  for (const sim::Int128 x : axis) least_gap += (x < 0 ? -x : x) * margin;
  bool above = in.beat.allow_above;
  bool below = in.beat.allow_below;
  for (std::size_t i = 0; i < own.vertex_count(); ++i) {
    if (in_plane(code) && i != code.k) continue;
    for (std::size_t j = 0; j < other.vertex_count(); ++j) {
      const sim::Int128 gap = along(axis, other.v[j], own.v[i]);
      above = above && gap > least_gap;
      below = below && -gap > least_gap;
    }
  }
  return above || below;
}

/// By definition: each vertex of the other primitive certainly on one side of all own ones.
bool clear(const BeatIn& in) {
  const bool own_b = in.beat.code.cls == AxisClass::normal_b || in.beat.code.cls == AxisClass::in_plane_b;
  const GridPrimitive& other = own_b ? in.pair.a : in.pair.b;
  const WideVector axis = axis_of(in.beat.code, in.pair);
  const GridPrimitive& own = own_b ? in.pair.b : in.pair.a;
  sim::Int128 least_gap = 0;
  for (const sim::Int128 x : axis) least_gap += (x < 0 ? -x : x) << model::error_shift(in.beat.err);
  for (std::size_t j = 0; j < other.vertex_count(); ++j) {
    bool above = true;
    bool below = true;
    for (std::size_t i = 0; i < own.vertex_count(); ++i) {
      if (in_plane(in.beat.code) && i != in.beat.code.k) continue;
      const sim::Int128 gap = along(axis, other.v[j], own.v[i]);
      above = above && gap > least_gap;
      below = below && -gap > least_gap;
    }
    if (!above && !below) return false;
  }
  return true;
}

/// By definition: some difference of an other and an own vertex lies beyond the bound, another one below its negative.
bool deep(const BeatIn& in) {
  const bool own_b = in.beat.code.cls == AxisClass::normal_b;
  const GridPrimitive& other = own_b ? in.pair.a : in.pair.b;
  const GridPrimitive& own = own_b ? in.pair.b : in.pair.a;
  const WideVector axis = axis_of(in.beat.code, in.pair);
  sim::Int128 bound = 0;
  for (const sim::Int128 x : axis) bound += (x < 0 ? -x : x) << model::error_shift(in.beat.err);
  bool above = false;
  bool below = false;
  for (std::size_t i = 0; i < own.vertex_count(); ++i) {
    for (std::size_t j = 0; j < other.vertex_count(); ++j) {
      const sim::Int128 gap = along(axis, other.v[j], own.v[i]);
      above = above || gap > bound;
      below = below || -gap > bound;
    }
  }
  return above && below;
}

template <class Config>
class PipelineBench {
 public:
  using Model = typename Config::Model;
  static constexpr int w = Config::COORD_W;
  static constexpr int points = defs::points(Config::VERTS_A, Config::VERTS_B);
  static constexpr model::Shape shape{Config::VERTS_A, Config::VERTS_B};

  explicit PipelineBench(const sim::SimulationOptions& options)
      : random_(options.seed),
        simulation_(options),
        delay_(static_cast<std::size_t>(defs::pipe_latency(Config::SUBSTAGES))),
        bench_([this](const sim::ClockInfo&) { drive(); }, [this](const sim::ClockInfo& now) { sample(now); }) {
    simulation_.add(bench_);
  }

  sim::Simulation<Model>& simulation() { return simulation_; }
  /// Beats to send, one on every clock on which one is due.
  std::function<std::optional<BeatIn>()> source;
  /// Called for each verdict after it was compared.
  std::function<void(const BeatIn&, const model::Verdict&)> on_verdict = [](const BeatIn&, const model::Verdict&) {};

 private:
  void drive() {
    Model& top = simulation_.top();
    const std::optional<BeatIn> before = operands_.q();  // its operands come now
    const std::optional<BeatIn> last = in_;              // its sides come now
    in_ = source();
    top.s_beat_valid = in_ ? 1 : 0;
    sim::set_random(top.s_beat_code, defs::axis_code_w, random_);
    sim::set_random(top.s_beat_allow_above, 1, random_);
    sim::set_random(top.s_beat_allow_below, 1, random_);
    sim::set_random(top.s_beat_user, Config::USER_W, random_);
    sim::set_random(top.s_operand_error_shift, 3, random_);
    sim::set_random(top.s_operand_a, 3 * Config::VERTS_A * w, random_);
    sim::set_random(top.s_operand_b, 3 * Config::VERTS_B * w, random_);
    if (before) {
      top.s_operand_error_shift = static_cast<CData>(model::error_shift(before->beat.err));
      set_primitive(top.s_operand_a, before->pair.a, w);
      set_primitive(top.s_operand_b, before->pair.b, w);
    }
    if (last) {
      top.s_beat_allow_above = last->beat.allow_above ? 1 : 0;
      top.s_beat_allow_below = last->beat.allow_below ? 1 : 0;
    }
    if (!in_) return;
    in_->user = sim::get_bits(top.s_beat_user, 0, Config::USER_W);
    top.s_beat_code = to_bits(in_->beat.code);
  }

  void sample(const sim::ClockInfo& now) {
    Model& top = simulation_.top();
    if (defined_) {
      const std::optional<BeatIn>& out = delay_.q();
      expect("m_verdict_valid", top.m_verdict_valid != 0, out.has_value());
      if (out) compare(*out);
    }
    delay_.clock(in_);
    operands_.clock(in_);
    if (now.in_reset) {
      delay_.reset();
      defined_ = true;
    }
  }

  void compare(const BeatIn& in) {
    Model& top = simulation_.top();
    const model::Verdict v = model::sat_pipeline(shape, in.beat, in.pair.a, in.pair.b, w);
    expect("m_verdict_user", sim::get_bits(top.m_verdict_user, 0, Config::USER_W), in.user);
    expect("m_verdict_separated", top.m_verdict_separated != 0, v.compare.separated);
    expect("m_verdict_certain_gap", top.m_verdict_certain_gap != 0, v.compare.certain_gap);
    for (unsigned i = 0; i < static_cast<unsigned>(points); ++i) {
      expect("m_verdict_negative", (top.m_verdict_negative >> i & 1) != 0, v.compare.negative[i]);
      expect("m_verdict_zero", (top.m_verdict_zero >> i & 1) != 0, v.compare.zero[i]);
    }
    expect("m_verdict_certain", top.m_verdict_certain != 0, v.compare.certain);
    expect("m_verdict_clear", top.m_verdict_clear != 0, v.compare.clear);
    expect("m_verdict_deep", top.m_verdict_deep != 0, v.compare.deep);
    for (unsigned d = 0; d < 3; ++d) {
      expect("m_verdict_axis_negative", (top.m_verdict_axis_negative >> d & 1) != 0, v.axis_negative[d]);
      expect("m_verdict_axis_zero", (top.m_verdict_axis_zero >> d & 1) != 0, v.axis_zero[d]);
    }
    expect("m_verdict_axis_largest", int{top.m_verdict_axis_largest}, v.axis_largest);
    expect("m_verdict_box_separated", top.m_verdict_box_separated != 0, v.box.separated);
    expect("m_verdict_box_certain", top.m_verdict_box_certain != 0, v.box.certain_gap);

    const std::string text = to_words(in.beat.code) + ", " + to_text(in.pair);
    const bool separated = top.m_verdict_separated != 0;
    sim::require(separated == apart(in, 0), "verdict is not that of the projections of all vertices: " + text);
    sim::require((top.m_verdict_certain_gap != 0) == apart(in, 1 << model::error_shift(in.beat.err)),
                 "certain gap is not that of the projections of all vertices: " + text);
    sim::require((top.m_verdict_clear != 0) == clear(in), "clear is not that of the projections: " + text);
    sim::require(in_plane(in.beat.code) || (top.m_verdict_deep != 0) == deep(in),
                 "deep is not that of the projections of all vertices: " + text);
    sim::require(!separated || in_plane(in.beat.code) || witness_separates(in.beat.code, in.pair),
                 "separated by an axis that is no witness: " + text);
    on_verdict(in, v);
  }

  Random random_;
  sim::Simulation<Model> simulation_;
  model::Delay<std::optional<BeatIn>> delay_;
  model::Delay<std::optional<BeatIn>> operands_{static_cast<std::size_t>(defs::ram_latency())};
  Bench bench_;
  std::optional<BeatIn> in_;
  bool defined_ = false;
};

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_sat_pipeline: every verdict on its clock, through idle clocks and resets",
                        "[unit][cchip_sat_pipeline]", cchip_sat_pipeline_configs) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    PipelineBench<TestType> bench(options);
    const model::Shape& shape = bench.shape;
    const std::vector<AxisCode> codes = axis_codes(shape);
    const auto classes = stimulus::classes_of(kind_of(shape.a), kind_of(shape.b));
    stimulus::PairSource pairs(TestType::COORD_W, options.seed, kind_of(shape.a), kind_of(shape.b));
    Random random(options.seed);
    int verdicts = 0, separated = 0, certain_gaps = 0, box_separated = 0, box_certain = 0;
    bench.source = [&]() -> std::optional<BeatIn> {
      if (chance(random, 20)) return std::nullopt;
      BeatIn in;
      in.beat.code = codes[random() % codes.size()];
      in.beat.allow_above = chance(random, 80);
      in.beat.allow_below = chance(random, 80);
      in.beat.err = static_cast<int>(random() % (defs::err_unknown + 1));
      in.pair = pairs.draw(classes[pairs.draw_class()].value);
      return in;
    };
    bench.on_verdict = [&](const BeatIn&, const model::Verdict& v) {
      ++verdicts;
      separated += v.compare.separated ? 1 : 0;
      certain_gaps += v.compare.certain_gap ? 1 : 0;
      box_separated += v.box.separated ? 1 : 0;
      box_certain += v.box.certain_gap ? 1 : 0;
    };
    for (int part = 0; part < 4; ++part) {
      bench.simulation().reset(1);
      bench.simulation().steps(3000);
    }
    REQUIRE(verdicts > 8000);
    REQUIRE(separated < verdicts - 500);
    REQUIRE(certain_gaps > 50);
    REQUIRE(separated > certain_gaps + 300);
    REQUIRE(box_certain > 50);
    REQUIRE(box_separated > box_certain + 100);
  });
}

// The bound grows with the normal, which has two bits here, so each bit of the bound decides.
TEMPLATE_LIST_TEST_CASE("cchip_sat_pipeline: planes as far apart as the error bound are not certain, one unit more is",
                        "[unit][cchip_sat_pipeline]", cchip_sat_pipeline_configs) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    constexpr int most = TestType::COORD_W - 1;  // bits of a coordinate that is not negative
    PipelineBench<TestType> bench(options);
    Random random(options.seed);
    std::vector<BeatIn> beats;
    for (int high = 1; high < 2 * most; ++high) {
      for (int low = std::max(0, high - most + 1); low < high; ++low) {
        const int bit = std::clamp(high - most + 1, 0, low);  // x y is 2^high + 2^low
        const int x = 1 << bit;
        const int y = (1 << (high - bit)) + (1 << (low - bit));
        if (bit >= most || y >= 1 << most) continue;
        for (const int beside : {-1, 0, 1}) {
          BeatIn in;
          in.beat.code = axis_code(AxisClass::normal_a, 0, 0);
          in.beat.allow_above = in.beat.allow_below = true;
          in.beat.err = static_cast<int>(random() % defs::err_unknown);
          const int z = ((1 << model::error_shift(in.beat.err)) + beside) * (chance(random, 50) ? 1 : -1);
          const auto d = static_cast<Eigen::Index>(random() % 3);
          const auto rectangle = [&](GridPrimitive& p, std::size_t vertices, int height) {
            p.kind = kind_of(vertices);
            const std::array<std::array<int, 2>, 4> corners = {{{0, 0}, {x, 0}, {x, y}, {0, y}}};
            for (std::size_t i = 0; i < vertices; ++i) {
              p.v[i][d] = corners[i][0];
              p.v[i][(d + 1) % 3] = corners[i][1];
              p.v[i][(d + 2) % 3] = height;
            }
          };
          rectangle(in.pair.a, TestType::VERTS_A, 0);
          rectangle(in.pair.b, TestType::VERTS_B, z);
          beats.push_back(in);
        }
      }
    }
    std::size_t next = 0;
    std::size_t certain = 0;
    bench.source = [&]() -> std::optional<BeatIn> {
      if (next == beats.size()) return std::nullopt;
      return beats[next++];
    };
    bench.on_verdict = [&](const BeatIn&, const model::Verdict& v) { certain += v.compare.certain_gap ? 1 : 0; };
    bench.simulation().reset();
    next = 0;
    bench.simulation().steps(beats.size() + static_cast<std::size_t>(defs::pipe_latency(TestType::SUBSTAGES)));
    REQUIRE(certain == beats.size() / 3);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_sat_pipeline: each axis of the paper is the only one that separates some pair",
                        "[unit][cchip_sat_pipeline]", cchip_sat_pipeline_configs) {
  const model::Shape shape{TestType::VERTS_A, TestType::VERTS_B};
  const std::vector<AxisCode> codes = exhaustive_codes(shape);
  const std::vector<GridPair> pairs = pairs_separated_by_one(shape, TestType::COORD_W, sim::seed_from_environment());
  REQUIRE(static_cast<int>(codes.size()) == defs::exhaustive_beats(TestType::VERTS_A, TestType::VERTS_B));
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    PipelineBench<TestType> bench(options);
    std::size_t next = 0;
    bench.source = [&]() -> std::optional<BeatIn> {
      if (next == codes.size() * pairs.size()) return std::nullopt;
      const std::size_t i = next++;
      BeatIn in;
      in.beat.code = codes[i % codes.size()];
      in.pair = pairs[i / codes.size()];
      return in;
    };
    std::vector<AxisCode> separating;
    bench.on_verdict = [&](const BeatIn& in, const model::Verdict& v) {
      if (v.compare.separated) separating.push_back(in.beat.code);
    };
    bench.simulation().reset();
    next = 0;
    bench.simulation().steps(codes.size() * pairs.size() +
                             static_cast<std::size_t>(defs::pipe_latency(TestType::SUBSTAGES)));
    REQUIRE(separating == codes);
  });
}
