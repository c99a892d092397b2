// SPDX-License-Identifier: Apache-2.0
#include <cchip/internal/driver/pair_engine.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <stdexcept>
#include <utility>

namespace cchip {
namespace {

/// An engine that is a function of one pair and ignores the programme.
class FunctionEngine : public PairEngine {
 public:
  using Intersects = std::function<bool(const GridPair&)>;

  FunctionEngine(const char* name, int coord_w, Intersects intersects)
      : name_(name), coord_w_(coord_w), intersects_(std::move(intersects)) {
    if (coord_w < defs::coord_w_min || coord_w > defs::coord_w_max) {
      throw std::invalid_argument(std::string("engine ") + name + ": coord_w " + std::to_string(coord_w) +
                                  " is not in 4..20");
    }
  }

  const char* name() const override { return name_; }
  int coord_w() const override { return coord_w_; }

  using PairEngine::run;
  std::vector<EngineAnswer> run(const std::vector<GridPair>& pairs, const std::vector<PairMode>&) override {
    std::vector<EngineAnswer> answers;
    answers.reserve(pairs.size());
    for (const GridPair& pair : pairs) {
      EngineAnswer answer;
      answer.grid = intersects_(pair);
      answer.definite = pair.eta == 0;
      answer.hit = answer.grid || !answer.definite;
      answers.push_back(answer);
    }
    return answers;
  }

 private:
  const char* name_;
  int coord_w_;
  Intersects intersects_;
};

}  // namespace

std::unique_ptr<PairEngine> make_function_engine(const char* name, int coord_w,
                                                 std::function<bool(const GridPair&)> intersects) {
  return std::make_unique<FunctionEngine>(name, coord_w, std::move(intersects));
}

std::unique_ptr<PairEngine> make_exact_engine(int coord_w) {
  return make_function_engine("exact", coord_w, [](const GridPair& pair) { return exact_intersects(pair); });
}

}  // namespace cchip
