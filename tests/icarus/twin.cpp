// SPDX-License-Identifier: Apache-2.0
// Does the same as bench_primtest.v with the Verilated RTL, clock by clock, and writes the same lines.
//   cchip_icarus_twin VECTORS START LINES      the module is the one whose rm_id the vectors name
#include <Vcchip_primtest_quad_quad.h>
#include <Vcchip_primtest_tri_quad.h>
#include <Vcchip_primtest_tri_tri.h>

#include <cchip/machines/pair_port.hpp>
#include <cchip/sim/simulation.hpp>
#include <cchip/stimulus/pair_vector.hpp>
#include <iostream>

namespace {

using namespace cchip;
using namespace cchip::sim;

template <class Model>
class Twin {
 public:
  Twin(std::vector<bench::Vector> vectors, std::uint32_t start, const std::string& lines)
      : vectors_(std::move(vectors)), random_(start), lines_(lines), port_(simulation_.top(), bench::coord_w) {
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

  void put(const bench::Vector& vector) {
    for (int i = 0; i < bench::side_w; i += 32) {
      set_bits(simulation_->s_pair_a, i, 32, vector.get({bench::side_a.lsb + i, 32}));
      set_bits(simulation_->s_pair_b, i, 32, vector.get({bench::side_b.lsb + i, 32}));
    }
    simulation_->s_pair_tag = static_cast<SData>(vector.get(bench::tag));
    simulation_->s_pair_mode = static_cast<CData>(vector.get(bench::mode));
    simulation_->s_pair_err = static_cast<CData>(vector.get(bench::err));
  }

  void sample() {
    accepted_ = false;
    if (simulation_->rst != 0) {
      inside_ = 0;
      return;
    }
    const int idle = simulation_->idle;
    if (simulation_->m_result_valid != 0 && simulation_->m_result_ready != 0) {
      const PairResult result = port_.result();
      lines_ << "out " << clock_ << ' ' << result.tag << ' ' << result.hit << ' ' << result.grid << ' '
             << result.definite << ' ' << to_bits(result.axis) << ' ' << result.beats << ' ' << idle << '\n';
      --inside_;
    }
    accepted_ = simulation_->s_pair_valid != 0 && simulation_->s_pair_ready != 0;
    if (accepted_) {
      lines_ << "in " << clock_ << ' ' << simulation_->s_pair_tag << ' ' << idle << '\n';
      ++next_;
      ++inside_;
    }
  }

  std::vector<bench::Vector> vectors_;
  std::uint32_t random_;
  std::ofstream lines_;
  Simulation<Model> simulation_{options()};
  PairPort<Model> port_;
  std::uint64_t clock_ = 0;
  std::uint32_t reset_left_ = 4;
  std::size_t next_ = 0;
  int inside_ = 0;
  bool accepted_ = false;
};

void run_twin(const std::string& vectors_path, std::uint32_t start, const std::string& lines) {
  const std::vector<bench::Vector> vectors = bench::read_vectors(vectors_path);
  switch (static_cast<ModuleId>(vectors.front().get(bench::rm_id))) {
    case ModuleId::tri_tri:
      return Twin<Vcchip_primtest_tri_tri>(vectors, start, lines).run();
    case ModuleId::tri_quad:
      return Twin<Vcchip_primtest_tri_quad>(vectors, start, lines).run();
    case ModuleId::quad_quad:
      return Twin<Vcchip_primtest_quad_quad>(vectors, start, lines).run();
    default:
      throw std::invalid_argument(vectors_path + ": no module has this rm_id");
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    if (arguments.size() != 3) throw std::invalid_argument("usage: cchip_icarus_twin VECTORS START LINES");
    run_twin(arguments[0], static_cast<std::uint32_t>(std::stoul(arguments[1])), arguments[2]);
  } catch (const std::exception& error) {
    std::cerr << "cchip_icarus_twin: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
