// SPDX-License-Identifier: Apache-2.0
#include <cchip/blocks/traversal.hpp>
#include <map>
#include <models/cchip_traversal.hpp>
#include <set>

#include "bench.hpp"
#include "traversal_ports.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

using model::Traversal;

unsigned below(Random& random, std::size_t n) { return static_cast<unsigned>(random() % n); }

/// Memory, box test and primitive tests that answer at random, each asked thing once.
class Surroundings {
 public:
  /// \param fills queries fill their stacks; else they end in every other way, if `short_of_steps` most by their limit
  Surroundings(Random& random, bool fills, bool short_of_steps) : random_(random), fills_(fills) {
    short_of_steps_ = short_of_steps;
    change_limits();
    waits_ = fills ? 95 : short_of_steps ? 70 : 30 + static_cast<int>(below(random, 25));
  }
  int busy = 50;  ///< chance of any event that may happen on a clock, per cent
  bool more = true;

  const Traversal::Inputs& next() {
    if (chance(random_, 1)) change_limits();
    in_.start_ready = chance(random_, 95);
    in_.done_ready = chance(random_, busy);
    if (!in_.query && more && chance(random_, 50)) in_.query = query();
    in_.verdict.reset();
    if (const auto place = some(box_test_)) in_.verdict = verdict(*place);
    in_.leaf_left = some(leaves_);
    if (in_.leaf_left) {
      ++credits_;
      results_.push_back(result_of_.at(*in_.leaf_left));
    }
    in_.credit = credits_ > 0 && chance(random_, busy);
    if (!in_.result) in_.result = some(results_);
    return in_;
  }

  void clock(const Traversal& model) {
    if (in_.query && model.query_ready()) {
      ++asked_;
      in_.query.reset();
    }
    if (in_.result && model.result_ready()) in_.result.reset();
    credits_ -= in_.credit ? 1 : 0;
    if (const auto place = model.lookup_place(); place && model.lookup()) {
      in_.lookup_context = context_of_.at(*place);
      in_.lookup_pair = pair_of_.at(*place);
      in_.lookup_lines = lines();
    }
    if (model.done_valid() && in_.done_ready) {
      ++codes[model.done().code];
      REQUIRE(++answered_ <= asked_);
    }
    if (const auto& fetch = model.fetch()) {
      if (fetch->pair) {
        box_test_.push_back(fetch->place);
        context_of_[fetch->place] = fetch->context;
        pair_of_[fetch->place] = *fetch->pair;
      } else {
        leaves_.push_back(fetch->place);
        result_of_[fetch->place] = result(fetch->context, fetch->epoch);
      }
    }
  }
  bool quiet() const { return asked_ == answered_ && !in_.query; }
  bool empty() const {
    return box_test_.empty() && leaves_.empty() && results_.empty() && !in_.result && credits_ == 0;
  }
  std::map<QueryCode, int> codes;

 private:
  /// On any clock, queries at work or not, extremes included.
  void change_limits() {
    in_.limits.pairs_each = below(random_, 8);
    in_.limits.open = chance(random_, 10) ? 255 : below(random_, 7);
    in_.limits.steps = 0xffffffff;
    if (short_of_steps_ && !chance(random_, 20)) in_.limits.steps = below(random_, 11);
  }
  /// Any of a list, which loses it.
  template <class T>
  std::optional<T> some(std::vector<T>& list) {
    if (list.empty() || !chance(random_, busy)) return std::nullopt;
    std::swap(list[below(random_, list.size())], list.back());
    const T value = list.back();
    list.pop_back();
    return value;
  }
  model::TraversalEvents::QueryWords query() {
    model::TraversalEvents::QueryWords x{};
    for (auto& word : x) word = static_cast<std::uint32_t>(random_());
    for (std::size_t i = 2; i < 11; ++i) x[i] = static_cast<std::uint32_t>(static_cast<std::int32_t>(x[i]) / 2);
    if (chance(random_, 95)) x[14] &= 0x3fffffff;
    return x;
  }
  model::BoxVerdict verdict(std::size_t place) {
    model::BoxVerdict x;
    x.place = place;
    x.tests = 1 + below(random_, 16);
    if (pair_of_.at(place).header) return x;
    std::uint16_t all = 0;
    while (chance(random_, 60)) all |= static_cast<std::uint16_t>(1U << below(random_, 16));
    x.waiting = chance(random_, waits_) ? all : std::uint16_t{0};
    x.leaves = static_cast<std::uint16_t>(all & ~x.waiting);
    if (chance(random_, 20)) x.leaves |= static_cast<std::uint16_t>(random_() & ~std::uint64_t{x.waiting} & 0xffff);
    x.strong = static_cast<std::uint16_t>(random_() & x.waiting);
    while (x.waiting != 0 && (x.waiting >> x.best & 1) == 0) x.best = below(random_, 16);
    return x;
  }
  model::NodeLines lines() {
    model::NodeLines x;
    if (!fills_ && chance(random_, 2)) x.code = static_cast<QueryCode>(4 + below(random_, 4));
    x.kinds_a = static_cast<std::uint8_t>(random_());
    x.kinds_b = static_cast<std::uint8_t>(random_());
    x.first_a = static_cast<std::uint32_t>(random_()) & 0xffffff;
    x.first_b = static_cast<std::uint32_t>(random_()) & 0xffffff;
    return x;
  }
  model::TraversalResult result(std::size_t context, unsigned epoch) {
    model::TraversalResult x;
    x.context = context;
    x.epoch = epoch;
    if (fills_) return x;
    if (chance(random_, 10)) x.hits = below(random_, 5);
    if (chance(random_, 20)) x.open = below(random_, 5);
    if (!fills_ && chance(random_, 2)) x.code = static_cast<QueryCode>(4 + below(random_, 4));
    return x;
  }

  Random& random_;
  Traversal::Inputs in_;
  bool fills_;
  bool short_of_steps_ = false;
  int waits_;  ///< chance that child pairs wait, per cent
  std::vector<std::size_t> box_test_, leaves_;
  std::vector<model::TraversalResult> results_;
  std::map<std::size_t, std::size_t> context_of_;
  std::map<std::size_t, model::NodePair> pair_of_;
  std::map<std::size_t, model::TraversalResult> result_of_;
  int credits_ = 0;
  std::size_t asked_ = 0, answered_ = 0;
};

template <class Config, class Top>
void drive(Top& top, const Traversal::Inputs& in) {
  constexpr int place_w = log2(Config::PAIRS + Config::LEAVES);
  static_assert(place_w <= 8);
  top.pairs_each = static_cast<CData>(in.limits.pairs_each);
  top.step_limit = in.limits.steps;
  top.open_limit = static_cast<CData>(in.limits.open);
  top.s_query_valid = in.query ? 1 : 0;
  for (int i = 0; in.query && i < 16; ++i) {
    sim::set_bits(top.s_query, 32 * i, 32, (*in.query)[static_cast<std::size_t>(i)]);
  }
  top.m_start_ready = in.start_ready ? 1 : 0;
  top.s_leaf_valid = in.leaf_left ? 1 : 0;
  top.s_leaf_place = static_cast<CData>(in.leaf_left.value_or(0));
  top.s_verdict_valid = in.verdict ? 1 : 0;
  const model::BoxVerdict verdict = in.verdict.value_or(model::BoxVerdict{});
  top.s_verdict_place = static_cast<CData>(verdict.place);
  top.s_verdict_waiting = verdict.waiting;
  top.s_verdict_leaves = verdict.leaves;
  top.s_verdict_strong = verdict.strong;
  top.s_verdict_best = static_cast<CData>(verdict.best);
  top.s_verdict_tests = static_cast<CData>(verdict.tests);
  top.lookup_context = static_cast<CData>(in.lookup_context);
  put_pair(top.lookup_record, in.lookup_pair);
  put_node_lines(top.lookup_nodes, in.lookup_lines);
  top.s_result_valid = in.result ? 1 : 0;
  const model::TraversalResult result = in.result.value_or(model::TraversalResult{});
  top.s_result_context = static_cast<CData>(result.context);
  top.s_result_epoch = static_cast<CData>(result.epoch);
  top.s_result_hits = static_cast<CData>(result.hits);
  top.s_result_open = static_cast<CData>(result.open);
  top.s_result_code = static_cast<CData>(result.code);
  top.s_credit = in.credit ? 1 : 0;
  top.m_done_ready = in.done_ready ? 1 : 0;
}

template <class Top>
void check(const Top& top, const Traversal& model) {
  REQUIRE((top.s_query_ready != 0) == model.query_ready());
  REQUIRE((top.s_result_ready != 0) == model.result_ready());
  REQUIRE((top.lookup != 0) == model.lookup());
  if (model.lookup_place()) REQUIRE(std::size_t{top.lookup_place} == *model.lookup_place());
  const auto start = model.start();
  REQUIRE((top.m_start_valid != 0) == start.has_value());
  if (start) {
    REQUIRE(std::size_t{top.m_start_context} == start->context);
    REQUIRE(unsigned{top.m_start_epoch} == start->epoch);
    for (int i = 0; i < 16; ++i) {
      REQUIRE(sim::get_bits(top.m_start_query, 32 * i, 32) == (*model.query())[static_cast<std::size_t>(i)]);
    }
  }
  const auto& fetch = model.fetch();
  REQUIRE((top.m_valid != 0) == fetch.has_value());
  REQUIRE((top.count_leaf_pair != 0) == model.leaf_pair());
  REQUIRE((top.count_step != 0) == model.step().has_value());
  REQUIRE(unsigned{top.count_tests} == model.step().value_or(0));
  if (fetch) {
    REQUIRE(std::size_t{top.m_place} == fetch->place);
    REQUIRE(std::size_t{top.m_context} == fetch->context);
    REQUIRE(sim::get_bits(top.m_lines, 0, 32) == fetch->line_a);
    REQUIRE(sim::get_bits(top.m_lines, 32, 32) == fetch->line_b);
    if (fetch->pair) {
      REQUIRE(get_pair(top.m_record) == *fetch->pair);
    } else {
      REQUIRE(sim::get_bits(top.m_record, 0, 2) == fetch->leaf_kind_a);
      REQUIRE(sim::get_bits(top.m_record, 28, 2) == fetch->leaf_kind_b);
      REQUIRE(sim::get_bits(top.m_record, 56, 3) == fetch->epoch);
    }
  }
  REQUIRE((top.m_judged_valid != 0) == model.judged().has_value());
  if (model.judged()) {
    REQUIRE((top.m_judged_live != 0) == model.judged()->live);
    if (model.judged()->live) REQUIRE(top.m_judged_tag == model.judged()->tag);
  }
  REQUIRE((top.m_done_valid != 0) == model.done_valid());
  if (model.done_valid()) {
    REQUIRE(top.m_done_tag == model.done().tag);
    REQUIRE(unsigned{top.m_done_code} == static_cast<unsigned>(model.done().code));
    REQUIRE(unsigned{top.m_done_answer} == static_cast<unsigned>(model.done().answer));
    REQUIRE(top.m_done_steps == model.done().steps);
    REQUIRE(top.m_done_pairs == model.done().pairs);
  }
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_traversal: the model's outputs on every clock, every query is answered",
                        "[unit][cchip_traversal]", cchip_traversal_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    Traversal model({TestType::QUERIES, TestType::PAIRS, TestType::LEAVES, TestType::STACK, TestType::LEAF_DEPTH,
                     TestType::CREDIT});
    std::map<QueryCode, int> codes;
    for (int run = 0; run < 30; ++run) {
      Surroundings around(random, run % 4 == 1, run % 4 == 2);
      around.busy = run % 3 == 0 ? 90 : run % 3 == 1 ? 40 : 10;
      drive<TestType>(top, {});
      simulation.reset();
      model.reset();
      const int clocks = run % 5 == 4 ? 300 + static_cast<int>(below(random, 300)) : 3000;  // some end in the middle
      for (int clock = 0; clock < clocks || (clocks == 3000 && !(around.quiet() && around.empty())); ++clock) {
        REQUIRE(clock < 100000);
        around.more = clock < clocks;
        const Traversal::Inputs& in = around.next();
        drive<TestType>(top, in);
        simulation.settle();
        CAPTURE(run, clock);
        check(top, model);
        const Traversal::Inputs now = in;
        around.clock(model);
        model.clock(now);
        simulation.rise();
      }
      for (const auto& [code, n] : around.codes) codes[code] += n;
    }
    REQUIRE(codes.size() == 8);
    for (const auto& [code, n] : codes) {
      CAPTURE(static_cast<int>(code), n);
      REQUIRE(n > 5);
    }
  });
}

TEST_CASE("cchip_traversal: a step limit lowered below the steps of a query ends it, regardless of the other limits",
          "[unit][cchip_traversal]") {
  for_two_power_ups<traversal_4::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    for (int run = 0; run < 8; ++run) {
      Traversal::Inputs in;
      in.start_ready = in.done_ready = true;
      in.limits.pairs_each = run % 2 == 0 ? 0 : below(random, 8);
      drive<traversal_4>(top, in);
      simulation.reset();
      in.query.emplace();
      (*in.query)[14] = 1U << 28;  // mode ALL
      std::vector<std::size_t> places;
      std::map<std::size_t, bool> header;
      bool done = false;
      int clock = 0;
      for (; clock < 4000 && !done; ++clock) {
        if (clock == 2000) in.limits.steps = below(random, 3);
        in.verdict.reset();
        if (!places.empty()) {  // one child pair continues for ever, the others on to the stack
          in.verdict.emplace();
          in.verdict->place = places.back();
          if (!header.at(places.back())) in.verdict->waiting = clock < 1000 && clock % 16 == 0 ? 3 : 1;
          places.pop_back();
        }
        drive<traversal_4>(top, in);
        simulation.settle();
        if (top.s_query_ready != 0 && in.query) in.query.reset();
        if (top.m_valid != 0) {
          places.push_back(top.m_place);
          header[top.m_place] = get_pair(top.m_record).header;
        }
        if (top.lookup != 0 && header.count(top.lookup_place) != 0) {
          in.lookup_pair.header = header[top.lookup_place];
        }
        if (top.m_done_valid != 0) {
          done = true;
          REQUIRE(unsigned{top.m_done_code} == static_cast<unsigned>(QueryCode::steps));
          REQUIRE(top.m_done_steps > 50);
        }
        simulation.rise();
      }
      REQUIRE(done);
      REQUIRE(clock > 2000);
    }
  });
}

TEST_CASE("cchip_traversal: as many leaf pairs in flight as the rules allow", "[unit][cchip_traversal]") {
  using Config = traversal_leaves;
  for_two_power_ups<Config::Model>([](auto& simulation, Random& /*random*/) {
    auto& top = simulation.top();
    constexpr std::size_t receiver = 1899;  // leaf pairs behind cchip_get_data
    Traversal::Inputs in;
    in.start_ready = in.done_ready = true;
    in.limits.pairs_each = 7;
    drive<Config>(top, in);
    simulation.reset();
    in.query.emplace();
    (*in.query)[14] = 1U << 28;  // mode ALL
    std::vector<std::size_t> nodes, leaves;
    std::map<std::size_t, bool> header;
    int waiting = 18;  // node pairs of which all child pairs are inner ones; of the others all are leaf pairs
    std::size_t behind = 0, most = 0, results = 0;
    bool done = false;
    for (int clock = 0; clock < 100000 && !done; ++clock) {
      const bool fill = clock < 12000;
      in.verdict.reset();
      if (!nodes.empty()) {
        in.verdict.emplace();
        in.verdict->place = nodes.back();
        if (!header.at(nodes.back())) {
          if (waiting > 0)
            in.verdict->waiting = 0xffff;
          else
            in.verdict->leaves = 0xffff;
          --waiting;
        }
        nodes.pop_back();
      }
      in.leaf_left.reset();
      in.credit = false;
      if (!leaves.empty() && behind < receiver) {
        in.leaf_left = leaves.back();
        in.credit = true;
        leaves.pop_back();
        ++behind;
      }
      in.result.reset();
      if (!fill && behind > 0) in.result.emplace();
      drive<Config>(top, in);
      simulation.settle();
      if (top.s_query_ready != 0 && in.query) in.query.reset();
      if (in.result && top.s_result_ready != 0) {
        --behind;
        ++results;
      }
      if (top.m_valid != 0 && top.count_leaf_pair != 0) {
        leaves.push_back(top.m_place);
      } else if (top.m_valid != 0) {
        nodes.push_back(top.m_place);
        header[top.m_place] = get_pair(top.m_record).header;
      }
      if (top.lookup != 0 && header.count(top.lookup_place) != 0) in.lookup_pair.header = header[top.lookup_place];
      most = std::max(most, behind + leaves.size());
      if (top.m_done_valid != 0) {
        done = true;
        REQUIRE(unsigned{top.m_done_code} == static_cast<unsigned>(QueryCode::ok));
        REQUIRE(top.m_done_pairs == 0);
      }
      simulation.rise();
    }
    REQUIRE(done);
    REQUIRE(most == receiver + Config::LEAVES);
    REQUIRE(results > most + 16 * Config::LEAF_DEPTH);
  });
}

TEST_CASE("cchip_traversal: a query's count of pairs that meet beyond 2^17", "[unit][cchip_traversal]") {
  using Config = traversal_leaves;
  for_two_power_ups<Config::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    constexpr int most_inner = 156;  // node pairs whose child pairs are all inner ones
    constexpr unsigned hits = 4;     // of each leaf pair: that is what two leaves of two triangles can have
    Traversal::Inputs in;
    in.start_ready = in.done_ready = true;
    in.limits.pairs_each = 7;
    drive<Config>(top, in);
    simulation.reset();
    in.query.emplace();
    (*in.query)[14] = 1U << 28;  // mode ALL
    std::vector<std::size_t> nodes, leaves;
    std::map<std::size_t, bool> header;
    int inner = 0, open = 0;  // child pairs that have not been sent; few, so that the stack never fills
    std::size_t behind = 0;
    std::uint32_t results = 0;
    bool done = false;
    for (int clock = 0; clock < 1000000 && !done; ++clock) {
      in.verdict.reset();
      if (!nodes.empty()) {
        in.verdict.emplace();
        in.verdict->place = nodes.back();
        if (!header.at(nodes.back())) {
          const bool more = inner < most_inner && open < 40;
          if (more) {
            in.verdict->waiting = 0xffff;
          } else {  // an odd number of results as well as an even one
            in.verdict->leaves = static_cast<std::uint16_t>(0xffffU >> random() % 3);
          }
          inner += more ? 1 : 0;
          open += more ? 16 : 0;
        }
        nodes.pop_back();
      }
      in.leaf_left.reset();
      in.credit = !leaves.empty();
      if (in.credit) {
        in.leaf_left = leaves.back();
        leaves.pop_back();
        ++behind;
      }
      in.result.reset();
      if (behind > 0) {
        in.result.emplace();
        in.result->hits = hits;
      }
      drive<Config>(top, in);
      simulation.settle();
      if (top.s_query_ready != 0 && in.query) in.query.reset();
      if (in.result && top.s_result_ready != 0) {
        --behind;
        ++results;
      }
      if (top.m_valid != 0 && top.count_leaf_pair != 0) {
        leaves.push_back(top.m_place);
      } else if (top.m_valid != 0) {
        nodes.push_back(top.m_place);
        header[top.m_place] = get_pair(top.m_record).header;
        open -= open > 0 ? 1 : 0;
      }
      if (top.lookup != 0 && header.count(top.lookup_place) != 0) in.lookup_pair.header = header[top.lookup_place];
      if (top.m_done_valid != 0) {
        done = true;
        REQUIRE(unsigned{top.m_done_code} == static_cast<unsigned>(QueryCode::ok));
        REQUIRE(top.m_done_pairs == hits * results);
      }
      simulation.rise();
    }
    REQUIRE(done);
    REQUIRE(results > (1U << 17U) / hits);
  });
}
