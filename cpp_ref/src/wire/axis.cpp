// SPDX-License-Identifier: Apache-2.0
#include <cchip/internal/wire/axis.hpp>
#include <stdexcept>

namespace cchip {
namespace {

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

[[noreturn]] void refuse(const AxisCode& axis) {
  throw std::invalid_argument("axis class " + std::to_string(static_cast<int>(axis.cls)) + " is not in 0..7");
}

}  // namespace

std::uint16_t to_bits(const AxisCode& axis) {
  return static_cast<std::uint16_t>(static_cast<unsigned>(axis.cls) << 6 | unsigned{axis.k} << 3 | axis.l);
}

AxisCode axis_code_from_bits(std::uint16_t bits) {
  return {static_cast<AxisClass>(bits >> 6 & 7), static_cast<std::uint8_t>(bits >> 3 & 7),
          static_cast<std::uint8_t>(bits & 7)};
}

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
  refuse(axis);
}

std::string to_symbol(const AxisCode& axis) {
  const std::string k = std::to_string(axis.k);
  switch (axis.cls) {
    case AxisClass::none:
      return "none";
    case AxisClass::normal_a:
    case AxisClass::normal_b: {
      const char* primitive = axis.cls == AxisClass::normal_a ? "A" : "B";
      return axis.k == 0 ? std::string("normal ") + primitive
                         : std::string("face ") + primitive + std::to_string(axis.k - 1);
    }
    case AxisClass::cross:
      return "e" + k + " x f" + std::to_string(axis.l);
    case AxisClass::in_plane_a:
      return "e" + k + " x u" + component(axis.l);
    case AxisClass::in_plane_b:
      return "f" + k + " x u" + component(axis.l);
    case AxisClass::box:
      return "box " + component(axis.l);
    case AxisClass::illegal:
      return "illegal";
  }
  refuse(axis);
}

}  // namespace cchip
