// SPDX-License-Identifier: Apache-2.0
// Other half of bench_tri_tri.v.
//   twin vectors FILE PAIRS SEED          writes pairs and the results that the bit-exact model expects
//   twin run FILE START LINES        does with the Verilated module what the bench does, clock by clock
#include <Vcchip_primtest_tri_tri.h>

#include <cchip/model/programme.hpp>
#include <cchip/sim/pair_port.hpp>
#include <cchip/sim/simulation.hpp>
#include <fstream>
#include <iostream>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace cchip;
using namespace cchip::sim;

constexpr int width = defs::coord_w_default;
constexpr int side_w = 3 * defs::vertices * width;

/// One line of the vector file; field positions as in the bench.
struct Vector {
  static constexpr int words = 14;
  static constexpr int digits = (2 * side_w + 16 + 2 + 4 + 18) / 4;
  static_assert(4 * digits == 2 * side_w + 16 + 2 + 4 + 18 && 4 * digits <= 32 * words);
  VlWide<words> bits = {};
  void set(int lsb, int field_width, std::uint64_t value) { set_bits(bits, lsb, field_width, value); }
  std::uint64_t get(int lsb, int field_width) const { return get_bits(bits, lsb, field_width); }
};
constexpr int tag_at = 2 * side_w;
constexpr int mode_at = tag_at + defs::tag_w;
constexpr int err_at = mode_at + defs::mode_w;
constexpr int expected_at = err_at + defs::err_w;

// ---- vectors

GridPair random_pair(std::mt19937_64& random) {
  static const std::vector<std::int32_t> corners = {-32768, -32767, -1, 0, 1, 32766, 32767};
  const std::uint64_t kind = random() % 4;
  std::uniform_int_distribution<std::int32_t> full(-32768, 32767), near(-300, 300), tiny(-2, 2);
  const auto coordinate = [&]() -> std::int32_t {
    switch (kind) {
      case 0:
        return full(random);
      case 1:
        return near(random);
      case 2:
        return tiny(random);  // touching, coplanar, degenerate
      default:
        return corners[random() % corners.size()];
    }
  };
  GridPair pair;
  for (GridPrimitive* primitive : {&pair.a, &pair.b}) {
    for (Vec3i& vertex : primitive->v) vertex = Vec3i::NullaryExpr(coordinate);
  }
  return pair;
}

/// What the module answers: reserved modes with class illegal, the others by the bit-exact model.
PairResultBeat expected_result(const PairRequest& request) {
  PairResultBeat result;
  if (request.mode > static_cast<int>(PairMode::directed)) {
    result.hit = result.grid = true;
    result.axis.cls = AxisClass::illegal;
    return result;
  }
  const model::Outcome outcome = model::run_programme(model::Options{}, request.pair, request.mode, width);
  result.hit = outcome.hit();
  result.grid = outcome.grid;
  result.definite = outcome.definite;
  result.axis = outcome.witness;
  result.beats = outcome.beats;
  return result;
}

Vector to_vector(const PairRequest& request) {
  Vector vector;
  set_vertices(vector.bits, request.pair.a.v, defs::vertices, width);
  VlWide<side_w / 32> b = {};
  set_vertices(b, request.pair.b.v, defs::vertices, width);
  for (int i = 0; i < side_w; i += 32) vector.set(side_w + i, 32, get_bits(b, i, 32));
  vector.set(tag_at, defs::tag_w, request.tag);
  vector.set(mode_at, defs::mode_w, request.mode);
  vector.set(err_at, defs::err_w, static_cast<std::uint64_t>(request.pair.eta));
  const PairResultBeat result = expected_result(request);
  vector.set(expected_at, 1, result.hit ? 1 : 0);
  vector.set(expected_at + 1, 1, result.grid ? 1 : 0);
  vector.set(expected_at + 2, 1, result.definite ? 1 : 0);
  vector.set(expected_at + 3, defs::axis_code_w, pack_axis(result.axis));
  vector.set(expected_at + 3 + defs::axis_code_w, defs::beats_w, static_cast<std::uint64_t>(result.beats));
  return vector;
}

void write_vectors(const std::string& path, int pairs, std::uint64_t seed) {
  std::ofstream out(path);
  std::mt19937_64 random(seed);
  for (int i = 0; i < pairs; ++i) {
    PairRequest request{random_pair(random), static_cast<std::uint16_t>(i * 40503), 0};
    if (random() % 2 == 0) request.mode = static_cast<std::uint8_t>(PairMode::directed);
    if (random() % 16 == 0) request.mode = static_cast<std::uint8_t>(2 + random() % 2);
    if (random() % 4 == 0) request.pair.eta = static_cast<int>(random() % 16);
    const Vector vector = to_vector(request);
    for (int digit = Vector::digits - 1; digit >= 0; --digit) out << "0123456789abcdef"[vector.get(4 * digit, 4)];
    out << '\n';
  }
  out.close();
  if (!out) throw std::runtime_error(path + ": cannot be written");
}

std::vector<Vector> read_vectors(const std::string& path) {
  std::vector<Vector> vectors;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    Vector vector;
    for (int digit = 0; digit < Vector::digits; ++digit) {
      vector.set(4 * digit, 4,
                 std::stoul(line.substr(static_cast<std::size_t>(Vector::digits - 1 - digit), 1), nullptr, 16));
    }
    vectors.push_back(vector);
  }
  return vectors;
}

// ---- the bench once more

class Twin {
 public:
  Twin(std::vector<Vector> vectors, std::uint32_t start, const std::string& lines)
      : vectors_(std::move(vectors)), random_(start), lines_(lines), port_(simulation_.top(), width) {
    simulation_->s_pair_valid = 0;
  }

  void run() {
    for (int quiet = 0; quiet < 100; ++clock_) {
      drive();
      simulation_.settle();
      sample();
      simulation_.rise();
      if (accepted_) simulation_->s_pair_valid = 0;
      quiet = next_ == vectors_.size() && inside_ == 0 ? quiet + 1 : 0;
    }
    lines_.close();
    if (!lines_) throw std::runtime_error("the lines cannot be written");
  }

 private:
  static SimulationOptions options() {
    SimulationOptions options;
    options.timeout_clocks = 0;  // CTest has one
    return options;
  }

  std::uint32_t bits(int msb, int lsb) const { return random_ >> lsb & ((2U << (msb - lsb)) - 1); }

  void drive() {
    random_ ^= random_ << 13;
    random_ ^= random_ >> 17;
    random_ ^= random_ << 5;
    if (reset_left_ > 0) {
      --reset_left_;
    } else if (bits(31, 22) == 0) {
      reset_left_ = 1 + bits(21, 20);
    }
    simulation_->rst = reset_left_ > 0 ? 1 : 0;
    bool offer = true;
    bool ready = true;
    switch (clock_ / 2048 % 4) {
      case 0:
        break;
      case 1:
        offer = bits(5, 0) == 0;
        break;
      case 2:
        ready = bits(11, 8) == 0;
        break;
      default:
        offer = bits(0, 0) != 0;
        ready = bits(8, 8) != 0;
    }
    simulation_->m_result_ready = ready ? 1 : 0;
    if (simulation_->s_pair_valid == 0 && offer && next_ < vectors_.size()) {
      simulation_->s_pair_valid = 1;
      put(vectors_[next_]);
    }
  }

  void put(const Vector& vector) {
    for (int i = 0; i < side_w; i += 32) {
      set_bits(simulation_->s_pair_a, i, 32, vector.get(i, 32));
      set_bits(simulation_->s_pair_b, i, 32, vector.get(side_w + i, 32));
    }
    simulation_->s_pair_tag = static_cast<SData>(vector.get(tag_at, defs::tag_w));
    simulation_->s_pair_mode = static_cast<CData>(vector.get(mode_at, defs::mode_w));
    simulation_->s_pair_err = static_cast<CData>(vector.get(err_at, defs::err_w));
  }

  void sample() {
    accepted_ = false;
    if (simulation_->rst != 0) {
      inside_ = 0;
      return;
    }
    const int idle = simulation_->idle;
    if (simulation_->m_result_valid != 0 && simulation_->m_result_ready != 0) {
      const PairResultBeat result = port_.result();
      lines_ << "out " << clock_ << ' ' << result.tag << ' ' << result.hit << ' ' << result.grid << ' '
             << result.definite << ' ' << pack_axis(result.axis) << ' ' << result.beats << ' ' << idle << '\n';
      --inside_;
    }
    accepted_ = simulation_->s_pair_valid != 0 && simulation_->s_pair_ready != 0;
    if (accepted_) {
      lines_ << "in " << clock_ << ' ' << simulation_->s_pair_tag << ' ' << idle << '\n';
      ++next_;
      ++inside_;
    }
  }

  std::vector<Vector> vectors_;
  std::uint32_t random_;
  std::ofstream lines_;
  Simulation<Vcchip_primtest_tri_tri> simulation_{options()};
  PairPort<Vcchip_primtest_tri_tri> port_;
  std::uint64_t clock_ = 0;
  std::uint32_t reset_left_ = 4;
  std::size_t next_ = 0;
  int inside_ = 0;
  bool accepted_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    if (arguments.size() == 4 && arguments[0] == "vectors") {
      write_vectors(arguments[1], std::stoi(arguments[2]), std::stoull(arguments[3]));
    } else if (arguments.size() == 4 && arguments[0] == "run") {
      Twin(read_vectors(arguments[1]), static_cast<std::uint32_t>(std::stoul(arguments[2])), arguments[3]).run();
    } else {
      throw std::invalid_argument("usage: twin vectors FILE PAIRS SEED | twin run FILE START LINES");
    }
  } catch (const std::exception& error) {
    std::cerr << "twin: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
