// SPDX-License-Identifier: Apache-2.0
#include <deque>
#include <models/cchip_pair_queue.hpp>

#include "stream_bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

/// Clock-exact: a memory, the register at its output, the output register.
class QueueModel {
 public:
  explicit QueueModel(std::size_t depth) : depth_(depth) {}
  bool s_ready() const { return ready_; }
  bool m_valid() const { return out_.has_value(); }
  std::uint64_t m_data() const { return *out_; }
  std::size_t count() const { return memory_.size() + (fetched_ ? 1 : 0) + (out_ ? 1 : 0); }
  void clock(bool s_valid, std::uint64_t s_data, bool m_ready) {
    const bool push = s_valid && ready_;
    if (m_ready) out_.reset();
    if (!out_) out_ = std::exchange(fetched_, std::nullopt);
    if (!fetched_ && !memory_.empty()) {
      fetched_ = memory_.front();
      memory_.pop_front();
    }
    if (push) memory_.push_back(s_data);
    ready_ = count() < depth_;
  }
  void reset() {
    memory_.clear();
    fetched_.reset();
    out_.reset();
    ready_ = false;
  }

 private:
  std::size_t depth_;
  std::deque<std::uint64_t> memory_;
  std::optional<std::uint64_t> fetched_, out_;
  bool ready_ = false;
};

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_pair_queue: every output on every clock is the model's", "[unit][cchip_pair_queue]",
                        cchip_pair_queue_configs) {
  sweep_stream_module<typename TestType::Model, TestType::WIDTH>([] { return QueueModel(TestType::DEPTH); });
}

TEMPLATE_LIST_TEST_CASE("cchip_pair_queue: throughput, DEPTH words of room, no path through",
                        "[unit][cchip_pair_queue]", cchip_pair_queue_configs) {
  using Model = typename TestType::Model;
  for_two_power_ups([](const sim::SimulationOptions& options) {
    REQUIRE(beats_passed<Model>(options, sim::Pattern::always(), 200) == 197);  // three clocks to the other side
    REQUIRE(beats_until_full<Model>(options) == TestType::DEPTH);
    require_registered_outputs<Model, TestType::WIDTH>(options);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_pair_queue: count is what waits, filled and drained several times",
                        "[unit][cchip_pair_queue]", cchip_pair_queue_configs) {
  using Model = typename TestType::Model;
  for_two_power_ups<Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    QueueModel model(TestType::DEPTH);
    bool filling = true;
    int full = 0;
    int empty = 0;
    top.s_valid = top.m_ready = 0;
    simulation.reset();
    model.reset();
    Bench bench(
        [&](const sim::ClockInfo&) {
          top.s_valid = chance(random, filling ? 90 : 20) ? 1 : 0;
          top.m_ready = chance(random, filling ? 20 : 90) ? 1 : 0;
          sim::set_random(top.s_data, TestType::WIDTH, random);
        },
        [&](const sim::ClockInfo&) {
          expect("count", std::size_t{top.count}, model.count());
          expect("m_valid", top.m_valid != 0, model.m_valid());
          full += model.count() == TestType::DEPTH ? 1 : 0;
          empty += model.count() == 0 ? 1 : 0;
          if (model.count() == TestType::DEPTH) filling = false;
          if (model.count() == 0) filling = true;
          model.clock(top.s_valid != 0, sim::get_bits(top.s_data, 0, TestType::WIDTH), top.m_ready != 0);
        });
    simulation.add(bench);
    simulation.steps(static_cast<std::uint64_t>(TestType::DEPTH) * 12);
    REQUIRE(full >= 2);
    REQUIRE(empty >= 2);
  });
}
