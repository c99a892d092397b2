// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/eigen_reference.hpp>
#include <cchip/engine.hpp>
#include <cchip/exact_oracle.hpp>
#include <stdexcept>
#include <utility>

namespace cchip {
namespace {

/// An engine that is a function of one pair and ignores the programme.
class FunctionEngine : public PairEngine {
 public:
  using Intersects = bool (*)(const GridPair&, int coord_w);

  FunctionEngine(const char* name, int coord_w, Intersects intersects)
      : name_(name), coord_w_(coord_w), intersects_(intersects) {
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
      answers.push_back({intersects_(pair, coord_w_), pair.eta == 0, std::nullopt});
    }
    return answers;
  }

 private:
  const char* name_;
  int coord_w_;
  Intersects intersects_;
};

std::string component(std::uint8_t index) {
  return index < 3 ? std::string(1, static_cast<char>('x' + index)) : std::to_string(index);
}

std::string normal_of(const char* primitive, std::uint8_t k) {
  if (k == 0) return std::string("normal of ") + primitive;
  return "normal of face " + std::to_string(k - 1) + " of " + primitive;
}

std::string edge_of(const char* primitive, std::uint8_t k) {
  const std::string of = std::string(" of ") + primitive;
  if (k == 4) return "diagonal V0V2" + of;
  if (k == 5) return "diagonal V1V3" + of;
  return "edge " + std::to_string(k) + of;
}

std::string in_plane(const char* primitive, const AxisCode& axis) {
  return edge_of(primitive, axis.k) + " x direction " + component(axis.l);
}

}  // namespace

std::string to_words(const AxisCode& axis) {
  switch (axis.cls) {
    case AxisClass::none:
      return "none";
    case AxisClass::normal_a:
      return normal_of("A", axis.k);
    case AxisClass::normal_b:
      return normal_of("B", axis.k);
    case AxisClass::cross:
      return edge_of("A", axis.k) + " x " + edge_of("B", axis.l);
    case AxisClass::in_plane_a:
      return in_plane("A", axis);
    case AxisClass::in_plane_b:
      return in_plane("B", axis);
    case AxisClass::box:
      return "box " + component(axis.l);
    case AxisClass::illegal:
      return "illegal request";
  }
  throw std::invalid_argument("axis class " + std::to_string(static_cast<int>(axis.cls)) + " is not in 0..7");
}

std::unique_ptr<PairEngine> make_eigen_engine(int coord_w) {
  return std::make_unique<FunctionEngine>("eigen", coord_w, eigen_intersects);
}

std::unique_ptr<PairEngine> make_exact_engine(int coord_w) {
  return std::make_unique<FunctionEngine>("exact", coord_w,
                                          [](const GridPair& pair, int) { return exact_intersects(pair); });
}

}  // namespace cchip
