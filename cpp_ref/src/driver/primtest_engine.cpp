// SPDX-License-Identifier: Apache-2.0
#include <cchip/internal/driver/primtest_engine.hpp>
#include <cchip/internal/grid/canonical.hpp>
#include <map>
#include <stdexcept>
#include <unordered_map>
#include <utility>
#include <vector>

namespace cchip {
namespace {

constexpr std::size_t tags = std::size_t{1} << defs::tag_w;

void check(const GridPrimitive& primitive, int coord_w, const std::string& pair) {
  const std::int32_t limit = std::int32_t{1} << (coord_w - 1);
  for (std::size_t i = 0; i < primitive.vertex_count(); ++i) {
    if (primitive.v[i].minCoeff() < -limit || primitive.v[i].maxCoeff() >= limit) {
      throw std::invalid_argument(pair + ": coordinate beyond " + std::to_string(coord_w) +
                                  " signed bits; quantise it first");
    }
  }
}

void check(const GridPair& pair, int coord_w, std::size_t index) {
  const std::string name = "pair " + std::to_string(index);
  check(pair.a, coord_w, name);
  check(pair.b, coord_w, name);
  if (pair.eta < 0 || pair.eta > defs::err_unknown) {
    throw std::invalid_argument(name + ": eta " + std::to_string(pair.eta) + " is not in 0..15");
  }
}

using Order = std::array<std::size_t, 4>;

/// Number of the edge between two vertices of a quad or triangle: side i leads from vertex i to its successor, 4 and
/// 5 are the diagonals.
std::uint8_t edge_between(std::size_t from, std::size_t to, std::size_t vertex_count) {
  if (to == (from + 1) % vertex_count) return static_cast<std::uint8_t>(from);
  if (from == (to + 1) % vertex_count) return static_cast<std::uint8_t>(to);
  return from % 2 == 0 ? 4 : 5;
}

/// Edge `edge` of the reordered primitive in the numbers of the original.
std::uint8_t original_edge(std::uint8_t edge, const Order& order, std::size_t vertex_count) {
  const std::size_t from = edge < 4 ? edge : edge - 4U;
  const std::size_t to = edge < 4 ? (edge + 1U) % vertex_count : edge - 2U;
  return edge_between(order[from], order[to], vertex_count);
}

/// How a pair was changed on its way to the module.
struct Dispatch {
  bool swapped = false;
  Order order_a = {0, 1, 2, 3};
  Order order_b = {0, 1, 2, 3};
};

Dispatch dispatch_of(const GridPair& pair) {
  const bool swapped = pair.a.kind == Kind::quad && pair.b.kind == Kind::tri;
  return {swapped, canonical_order(pair.a), canonical_order(pair.b)};
}

GridPrimitive sent(const GridPrimitive& p, const Order& order) {
  GridPrimitive result = p;
  for (std::size_t i = 0; i < 4; ++i) result.v[i] = p.v[order[i]];
  if (p.kind == Kind::tri) result.v[3].setZero();
  return result;
}

GridPair sent(const GridPair& pair, const Dispatch& dispatch) {
  GridPair result{sent(pair.a, dispatch.order_a), sent(pair.b, dispatch.order_b), pair.eta};
  if (dispatch.swapped) std::swap(result.a, result.b);
  return result;
}

/// The witness with A and B exchanged.
AxisCode swapped(const AxisCode& axis) {
  switch (axis.cls) {
    case AxisClass::normal_a:
      return {AxisClass::normal_b, axis.k, axis.l};
    case AxisClass::normal_b:
      return {AxisClass::normal_a, axis.k, axis.l};
    case AxisClass::in_plane_a:
      return {AxisClass::in_plane_b, axis.k, axis.l};
    case AxisClass::in_plane_b:
      return {AxisClass::in_plane_a, axis.k, axis.l};
    case AxisClass::cross:
      return {AxisClass::cross, axis.l, axis.k};
    default:
      return axis;
  }
}

/// The witness in terms of the pair as it was given. Faces need no change: warped quads are sent as they are.
AxisCode original(AxisCode axis, const GridPair& pair, const Dispatch& dispatch) {
  if (dispatch.swapped) axis = swapped(axis);
  const auto edge_of_a = [&](std::uint8_t k) { return original_edge(k, dispatch.order_a, pair.a.vertex_count()); };
  const auto edge_of_b = [&](std::uint8_t k) { return original_edge(k, dispatch.order_b, pair.b.vertex_count()); };
  if (axis.cls == AxisClass::cross) axis = {axis.cls, edge_of_a(axis.k), edge_of_b(axis.l)};
  if (axis.cls == AxisClass::in_plane_a) axis.k = edge_of_a(axis.k);
  if (axis.cls == AxisClass::in_plane_b) axis.k = edge_of_b(axis.k);
  return axis;
}

class PrimtestEngine : public PairEngine {
 public:
  explicit PrimtestEngine(PrimtestEngineOptions options) : options_(std::move(options)) {}
  const char* name() const override { return options_.name.c_str(); }
  int coord_w() const override { return options_.coord_w; }

  EngineStatistics statistics() const override {
    EngineStatistics sum;
    for (const auto& [id, lane] : lanes_) {
      sum.clocks += lane.statistics.clocks;
      sum.beats += lane.statistics.beats;
      sum.waiting_clocks += lane.statistics.waiting_clocks;
    }
    return sum;
  }

  using PairEngine::run;
  std::vector<EngineAnswer> run(const std::vector<GridPair>& pairs, const std::vector<PairMode>& modes) override {
    if (modes.size() != pairs.size()) {
      throw std::invalid_argument("engine " + options_.name + ": " + std::to_string(modes.size()) + " modes for " +
                                  std::to_string(pairs.size()) + " pairs; give one each");
    }
    std::map<ModuleId, std::vector<std::size_t>> indices;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      check(pairs[i], options_.coord_w, i);
      indices[module_of(pairs[i])].push_back(i);
    }
    std::vector<EngineAnswer> answers(pairs.size());
    for (const auto& [id, of_module] : indices) stream(lane(id), Batch{pairs, modes, of_module, answers});
    return answers;
  }

 private:
  struct Lane {
    std::unique_ptr<PrimtestMachine> machine;
    EngineStatistics statistics;
  };
  /// The pairs of one module, in order.
  struct Batch {
    const std::vector<GridPair>& pairs;
    const std::vector<PairMode>& modes;
    const std::vector<std::size_t>& indices;
    std::vector<EngineAnswer>& answers;
    std::size_t size() const { return indices.size(); }
    const GridPair& pair(std::size_t n) const { return pairs[indices[n]]; }
    EngineAnswer& answer(std::size_t n) const { return answers[indices[n]]; }
  };

  Lane& lane(ModuleId id) {
    Lane& found = lanes_[id];
    if (!found.machine) found.machine = options_.make_machine(id);
    return found;
  }

  void stream(Lane& lane, const Batch& batch) {
    EngineStatistics& statistics = lane.statistics;
    PrimtestTraffic traffic;
    traffic.pairs = batch.size();
    traffic.answer_bound = options_.answer_bound;
    traffic.request = [&](std::size_t n) {
      const GridPair& pair = batch.pair(n);
      // fewer than 2^16 pairs are in flight
      return PairRequest{sent(pair, dispatch_of(pair)), static_cast<std::uint16_t>(n % tags),
                         batch.modes[batch.indices[n]]};
    };
    traffic.accepted = [&](std::size_t n) { batch.answer(n).clocks = EngineAnswer::Handshakes{statistics.clocks, 0}; };
    traffic.answered = [&](std::size_t n, const PairResult& result) {
      EngineAnswer& answer = batch.answer(n);
      static_cast<PairResult&>(answer) = result;
      answer.axis = original(result.axis, batch.pair(n), dispatch_of(batch.pair(n)));
      answer.clocks->answered = statistics.clocks;
    };
    traffic.clock = [&](const PrimtestMachine::Outputs& out, bool) {
      ++statistics.clocks;
      statistics.beats += out.beat_valid;
      statistics.waiting_clocks += out.pair_waits;
    };
    try {
      stream_pairs(*lane.machine, traffic);
    } catch (const PrimtestStreamError& error) {
      throw std::runtime_error("engine " + options_.name + ": clock " + std::to_string(statistics.clocks) + ": " +
                               error.what() + "; this is a defect, please report it");
    }
  }

  PrimtestEngineOptions options_;
  std::map<ModuleId, Lane> lanes_;
};

}  // namespace

void stream_pairs(PrimtestMachine& machine, const PrimtestTraffic& traffic) {
  std::unordered_map<std::uint16_t, std::size_t> in_flight;  // number of the pair with this tag
  std::uint16_t tag = 0;                                     // of the pair on s_pair
  std::size_t accepted = 0;
  std::size_t answered = 0;
  const auto offer = [&] {
    std::optional<PairRequest> request;
    if (accepted < traffic.pairs) {
      request = traffic.request(accepted);
      tag = request->tag;
    }
    machine.offer(request);
  };
  offer();
  std::uint64_t progress = 0;
  for (std::uint64_t clock = 0; answered < traffic.pairs; ++clock) {
    const PrimtestMachine::Outputs out = machine.outputs();
    const bool offers = accepted < traffic.pairs;
    if (out.result) {
      const auto found = in_flight.find(out.result->tag);
      if (found == in_flight.end()) {
        throw PrimtestStreamError("result with tag " + std::to_string(out.result->tag) + " that no pair in flight has");
      }
      traffic.answered(found->second, *out.result);
      in_flight.erase(found);
      ++answered;
      progress = clock;
    }
    const bool accept = offers && out.pair_ready;
    if (accept) {
      in_flight[tag] = accepted;
      traffic.accepted(accepted);
      ++accepted;
      progress = clock;
    }
    traffic.clock(out, offers);
    machine.clock();
    if (accept) offer();
    if (clock - progress > traffic.answer_bound) {
      throw PrimtestStreamError("no pair accepted and no result for " + std::to_string(traffic.answer_bound) +
                                " clocks, " + std::to_string(accepted) + " of " + std::to_string(traffic.pairs) +
                                " pairs accepted, " + std::to_string(answered) + " answered");
    }
  }
}

std::unique_ptr<PairEngine> make_primtest_engine(PrimtestEngineOptions options) {
  return std::make_unique<PrimtestEngine>(std::move(options));
}

}  // namespace cchip
