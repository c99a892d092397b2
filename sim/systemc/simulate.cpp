// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/levels/simulate.hpp>
#include <chrono>
#include <stdexcept>

namespace cchip::levels {

LevelResult simulate(const Api& api) {
  using Clock = std::chrono::steady_clock;
  sc_core::sc_report_handler::set_actions("/OSCI/SystemC", sc_core::SC_INFO,
                                          sc_core::SC_DO_NOTHING);  // stopped by user
  const Clock::time_point start = Clock::now();
  sc_core::sc_start();
  const std::chrono::duration<double> wall = Clock::now() - start;
  if (!api.failure().empty()) throw std::runtime_error(api.failure());
  LevelResult result;
  result.answers = api.answers();
  const auto missing = std::count(result.answers.begin(), result.answers.end(), Api::unanswered);
  if (missing != 0) throw std::runtime_error(std::to_string(missing) + " primitive pairs are not answered");
  result.simulated_seconds = sc_core::sc_time_stamp().to_seconds();
  result.wall_seconds = wall.count();
  result.deltas = sc_core::sc_delta_count();
  return result;
}

}  // namespace cchip::levels
