// SPDX-License-Identifier: Apache-2.0
// What became of the queries of a round, and everything as it was before.
#include <fmt/format.h>

#include "fault_round.hpp"

namespace cchip::testing {

std::string FaultRound::compare(const Expectation& e, const Query& sent, const ChipAnswer& answer, bool clean) const {
  const bvh::Image& a = clean ? (sent.swapped ? clean_b_ : clean_a_) : (sent.swapped ? objects_.b : objects_.a);
  const bvh::Image& b = clean ? (sent.swapped ? clean_a_ : clean_b_) : (sent.swapped ? objects_.a : objects_.b);
  model::BroadPhaseOptions options;
  options.step_limit = 20000;
  const QueryCode code = answer.done->code;
  if (!clean) {
    Query whole = e.query;
    whole.mode = QueryMode::all;
    if (model::run_query(whole, a, b, options).done.code != QueryCode::ok) {
      return e.query.mode == QueryMode::all && code == QueryCode::ok ? "ok on garbage" : "";
    }
  }
  if (code == QueryCode::steps && ever(Fault::step_limit)) return "";
  if (code == QueryCode::memory && (ever(Fault::read_error) || ever(Fault::read_silence) || ever(Fault::read_late)))
    return "";
  const model::BroadPhaseResult expected = model::run_query(e.query, a, b, options);
  const std::string wrong = compare_answer(e.query, answer, expected, open_limit_);
  if (wrong.empty()) return wrong;
  using Key = std::pair<std::uint32_t, std::uint32_t>;
  std::set<Key> got, wanted;
  for (const PairRecord& x : answer.pairs) got.emplace(x.id_a, x.id_b);
  for (const PairRecord& x : expected.pairs) wanted.emplace(x.id_a, x.id_b);
  std::string text = wrong;
  for (const Key& x : got) text += wanted.count(x) == 0 ? fmt::format(" +{}/{}", x.first, x.second) : "";
  for (const Key& x : wanted) text += got.count(x) == 0 ? fmt::format(" -{}/{}", x.first, x.second) : "";
  return text + fmt::format(", expected {} steps and {} records", expected.done.steps, expected.pairs.size());
}

void FaultRound::judge(bool stopped, bool late) {
  const std::uint32_t failed = regs::status::query_failed_mask | regs::status::record_failed_mask;
  const std::uint32_t status = bench_.machine().read_register(regs::status::offset);
  const std::uint32_t events = bench_.machine().read_register(regs::interrupt_status::offset);
  const bool ring_stopped = (status & failed) != 0;
  if (stopped || late || reset_) {
    const bool fault_stops = ring_hit_ || write_hit_ || late_hit_;  // a line of the ring may be late, too
    if (late || (stopped && !ring_stopped)) {
      ++totals_.hangs;
      report("hang");
    }
    if (stopped && ring_stopped && !fault_stops) {
      ++totals_.wrong;
      report("a ring stopped without a fault");
    }
    const bool query_event = (events & regs::interrupt_status::query_failed_mask) != 0;
    const bool record_event = (events & regs::interrupt_status::record_failed_mask) != 0;
    if (((status & regs::status::query_failed_mask) != 0) != query_event ||
        ((status & regs::status::record_failed_mask) != 0) != record_event) {
      ++totals_.unreported;
      report("a ring stopped without its event");
    }
  } else if (bench_.unanswered() > 0) {
    totals_.lost += bench_.unanswered();
    report("lost");
  }
  for (std::size_t i = 0; i < expected_.size(); ++i) {
    const ChipAnswer& answer = bench_.answers()[from_ + i];
    if (!answer.done) continue;
    const Expectation& e = expected_[i];
    const QueryCode code = answer.done->code;
    ++totals_.codes[static_cast<std::size_t>(code)];
    const bool clean = !garbage_ || i < spoiled_from_;
    std::string wrong;
    if (e.ends) {
      const bool memory =
          code == QueryCode::memory && (ever(Fault::read_error) || ever(Fault::read_silence) || ever(Fault::read_late));
      if (e.codes.count(code) == 0 && !memory) wrong = "code of a bad descriptor";
    } else {
      wrong = compare(e, bench_.queries()[from_ + i], answer, clean);
    }
    if (wrong.empty()) continue;
    if (!clean) {
      ++totals_.damaged;
      continue;
    }
    ++(code == QueryCode::ok || code == QueryCode::host ? totals_.wrong : totals_.unreported);
    report(fmt::format("query {}: {}, code {}, answer {}, steps {}, records {}", i, wrong, static_cast<int>(code),
                       static_cast<int>(answer.done->answer), answer.done->steps, answer.pairs.size()));
  }
  if (!bench_.wrong().empty() && bench_.wrong().size() > seen_wrong()) {
    totals_.wrong += bench_.wrong().size() - seen_wrong();
    report(bench_.wrong().back());
    seen_wrong() = bench_.wrong().size();
  }
}

void FaultRound::report(const std::string& what) const {
  std::string names;
  for (const auto& [fault, phase] : phase_of_)
    names += fmt::format(" {}/{}", fault_names[static_cast<std::size_t>(fault)], phase_names[phase]);
  fmt::print("round {}:{} {}: {}\n", totals_.rounds, names, all_ ? "all" : "first", what);
}

void FaultRound::restore(bool stopped) {
  auto& memory = bench_.machine().memory();
  memory.read_fault = memory.write_fault = [](std::uint64_t) { return sim::AxiFault::none; };
  bench_.edit = nullptr;
  bench_.hold = false;
  active_.clear();
  // late responses are still to come: they hold up others, and their slots are out of use
  for (int i = 0; late_hit_ && i < 20; ++i) {
    const std::uint32_t status = bench_.machine().read_register(regs::status::offset);
    if (lost_response_ || (status & regs::status::read_outstanding_mask) == 0) break;
    bench_.machine().simulation().steps(slow_limit);
  }
  if (stopped || reset_ || lost_response_ || bench_.unanswered() > 0) {
    ++totals_.resets;
    if (!bench_.recover()) {
      // memory that has lost a response: the chip says so, and only a reset of chip and bus helps
      const std::uint32_t status = bench_.machine().read_register(regs::status::offset);
      const std::uint32_t owed = regs::status::read_outstanding_mask | regs::status::write_outstanding_mask;
      if (!lost_response_ || (status & owed) == 0 || (status & regs::status::resetting_mask) == 0) {
        ++totals_.unreported;
        report("a reset does not end");
      }
      ++totals_.bus_resets;
      bench_.machine().reset();
      if (!bench_.recover()) throw std::runtime_error("a reset of chip and bus does not help");
    }
  }
  set(regs::step_limit::offset, 0xFFFFFFFF);
  set(regs::open_limit::offset, 16);
  set(regs::interrupt_status::offset, 0x1F);
  if (garbage_) {
    objects_.a = clean_a_;
    objects_.b = clean_b_;
    bench_.port().store(static_cast<std::uint32_t>(objects_.line_a), objects_.a.lines);
    bench_.port().store(static_cast<std::uint32_t>(objects_.line_b), objects_.b.lines);
  }
  check_after();
}

void FaultRound::check_after() {
  const std::size_t from = bench_.queries().size();
  for (int i = 0; i < 3; ++i) bench_.submit(objects_.query(random_));
  totals_.queries += 3;
  if (!bench_.run(round_clocks)) {
    ++totals_.hangs;
    report("no answer afterwards");
    bench_.machine().reset();
    if (!bench_.recover()) throw std::runtime_error("a reset of chip and bus does not help");
    return;
  }
  for (std::size_t i = from; i < bench_.queries().size(); ++i) {
    const Query& query = bench_.queries()[i];
    const std::string wrong = compare_answer(query, bench_.answers()[i], objects_.expected(query), 16);
    if (wrong.empty()) continue;
    ++totals_.wrong;
    report("afterwards: " + wrong);
  }
}

}  // namespace cchip::testing
