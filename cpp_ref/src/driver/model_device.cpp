// SPDX-License-Identifier: Apache-2.0
#include <cchip/device.hpp>
#include <cchip/driver/chip_host.hpp>
#include <cchip/driver/model_device.hpp>
#include <cchip/internal/image/image.hpp>
#include <cchip/internal/model/broad_phase.hpp>
#include <deque>
#include <iterator>
#include <map>
#include <utility>

namespace cchip {
namespace {

/// The functional model with memory for images.
class ModelPort final : public QueryPort {
 public:
  const char* name() const override { return "model"; }

  ChipCapabilities capabilities() const override {
    ChipCapabilities all;
    all.image_lines = std::uint32_t{1} << 25U;  // two images of any size; what is not stored takes no memory
    return all;
  }

  void store(std::uint32_t first_line, const std::vector<Line>& lines) override {
    auto next = images_.lower_bound(first_line);
    if (next != images_.begin()) {
      const auto before = std::prev(next);
      if (first_line - before->first < before->second.lines.size()) images_.erase(before);
    }
    while (next != images_.end() && next->first - first_line < lines.size()) next = images_.erase(next);
    images_.emplace(first_line, bvh::Image{lines});
  }

  void lock(unsigned, std::uint32_t, std::uint32_t) override {}

  bool submit(const Query& query) override {
    const auto a = images_.find(query.base_a);
    const auto b = images_.find(query.base_b);
    QueryOutcome outcome;
    if (a == images_.end() || b == images_.end()) {
      outcome.done.tag = query.tag;
      outcome.done.code = QueryCode::bad_descriptor;
    } else {
      model::BroadPhaseResult result = model::run_query(query, a->second, b->second);
      outcome = {result.done, std::move(result.pairs), result.counts.box_tests, result.counts.primitive_pairs};
    }
    ended_.push_back(std::move(outcome));
    return true;
  }

  std::optional<QueryOutcome> collect() override {
    if (ended_.empty()) return std::nullopt;
    QueryOutcome outcome = std::move(ended_.front());
    ended_.pop_front();
    return outcome;
  }

  bool proceed() override { return !ended_.empty(); }

  bool recover() override {
    ended_.clear();
    return true;
  }

  std::uint64_t clocks() const override { return 0; }

 private:
  std::map<std::uint32_t, bvh::Image> images_;  // by their first line
  std::deque<QueryOutcome> ended_;
};

}  // namespace

void add_model_device() {
  static const bool added = [] {
    add_device("model", [] { return make_chip_device(std::make_unique<ModelPort>()); });
    return true;
  }();
  static_cast<void>(added);
}

}  // namespace cchip
