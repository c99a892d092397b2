// SPDX-License-Identifier: Apache-2.0
#include "primtest_rtl.hpp"

#include <Vcchip_primtest_point_tri.h>
#include <Vcchip_primtest_quad_quad.h>
#include <Vcchip_primtest_tri_quad.h>
#include <Vcchip_primtest_tri_tri.h>

#include <algorithm>
#include <cchip/sim/simulation.hpp>
#include <stdexcept>

namespace cchip::levels {
namespace {

template <class Model>
class Machine : public PrimtestRtl {
 public:
  /// The assertions are enabled from the first reset on.
  explicit Machine(std::uint64_t seed) : simulation_(sim::without_timeout(seed)) {
    simulation_->contextp()->assertOn(false);
  }

  PrimtestOutputs clock(const PrimtestInputs& in) override {
    Model& top = simulation_.top();
    top.rst = in.rst ? 1 : 0;
    top.s_pair_valid = in.s_pair_valid ? 1 : 0;
    top.s_pair_tag = static_cast<SData>(in.s_pair_tag);
    top.s_pair_mode = static_cast<CData>(in.s_pair_mode);
    std::copy(in.s_pair_a.begin(), in.s_pair_a.end(), &top.s_pair_a[0]);
    std::copy(in.s_pair_b.begin(), in.s_pair_b.end(), &top.s_pair_b[0]);
    top.s_pair_err = static_cast<CData>(in.s_pair_err);
    top.m_result_ready = in.m_result_ready ? 1 : 0;
    simulation_.settle();
    simulation_.rise();
    if (in.rst) top.contextp()->assertOn(true);
    return {top.s_pair_ready != 0, top.m_result_valid != 0, top.m_result_tag,
            top.m_result_hit != 0, top.m_result_grid != 0,  top.m_result_definite != 0,
            top.m_result_axis,     top.m_result_beats,      top.rm_id,
            top.idle != 0};
  }

 private:
  sim::Simulation<Model> simulation_;
};

}  // namespace

std::unique_ptr<PrimtestRtl> power_up_primtest(ModuleId id, std::uint64_t seed) {
  switch (id) {
    case ModuleId::tri_tri:
      return std::make_unique<Machine<Vcchip_primtest_tri_tri>>(seed);
    case ModuleId::tri_quad:
      return std::make_unique<Machine<Vcchip_primtest_tri_quad>>(seed);
    case ModuleId::quad_quad:
      return std::make_unique<Machine<Vcchip_primtest_quad_quad>>(seed);
    case ModuleId::point_tri:
      return std::make_unique<Machine<Vcchip_primtest_point_tri>>(seed);
    case ModuleId::blank:
      break;
  }
  throw std::invalid_argument("level 3: no model of this module; choose one of the tests");
}

}  // namespace cchip::levels
