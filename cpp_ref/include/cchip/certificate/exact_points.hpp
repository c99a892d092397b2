// SPDX-License-Identifier: Apache-2.0
/// \file
/// What check.hpp computes with: the vertices of two meshes in their poses and the numbers of certificates, as
/// integers.
#ifndef CCHIP_CERTIFICATE_EXACT_POINTS_HPP
#define CCHIP_CERTIFICATE_EXACT_POINTS_HPP

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cchip/certificate/certificate.hpp>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace cchip::certificate_check {

using Int = boost::multiprecision::cpp_int;
using Point = std::array<Int, 3>;

inline void require(bool holds, const char* otherwise) {
  if (!holds) throw std::invalid_argument(otherwise);
}

/// The vertices of the faces of both meshes in their poses, all multiplied by the same power of two; exact.
inline std::array<std::vector<Point>, 2> place(const std::array<const Mesh*, 2>& mesh,
                                               const std::array<const Pose*, 2>& pose) {
  using Rational = boost::multiprecision::cpp_rational;
  const auto exact = [](double x) {
    require(std::isfinite(x), "a number of a mesh or a pose is not finite");
    return Rational(x);
  };
  std::array<std::vector<std::array<Rational, 3>>, 2> placed;
  Int scale = 1;  // denominators are powers of two, so the greatest is a multiple of all
  for (const std::size_t side : {0U, 1U}) {
    const std::vector<Vec3d>& vertices = mesh[side]->vertices;
    std::vector<bool> used(vertices.size());
    for (const Mesh::Face& face : mesh[side]->faces) {
      require(face.kind == Kind::tri || face.kind == Kind::quad, "a face is neither triangle nor quad");
      for (std::size_t k = 0; k < static_cast<std::size_t>(face.kind); ++k) {
        require(face.vertex[k] < used.size(), "a face has a vertex that does not exist");
        used[face.vertex[k]] = true;
      }
    }
    placed[side].resize(used.size());
    for (std::size_t v = 0; v < used.size(); ++v) {
      for (int row = 0; used[v] && row < 3; ++row) {
        Rational& x = placed[side][v][static_cast<std::size_t>(row)];
        x = exact((*pose[side])(row, 3));
        for (int i = 0; i < 3; ++i) x += exact((*pose[side])(row, i)) * exact(vertices[v][i]);
        scale = std::max(scale, Int(denominator(x)));
      }
    }
  }
  const auto whole = [&](const Rational& x) { return Int(numerator(x) * (scale / denominator(x))); };
  std::array<std::vector<Point>, 2> points;
  for (const std::size_t side : {0U, 1U}) {
    for (const auto& x : placed[side]) {
      points[side].push_back({whole(x[0]), whole(x[1]), whole(x[2])});
    }
  }
  return points;
}

/// Reads integers of a certificate.
inline std::vector<Int> integers(const std::vector<Digits>& texts, std::size_t count) {
  require(texts.size() == count, "wrong number of weights or components");
  std::vector<Int> result;
  for (const Digits& text : texts) {
    const std::size_t sign = !text.empty() && text[0] == '-';
    require(text.size() > sign && text.size() <= 20000 &&
                text.find_first_not_of("0123456789", sign) == std::string::npos &&
                (text[sign] != '0' || text.size() == 1),
            "not an integer of at most 20000 digits");
    result.emplace_back(text);
  }
  return result;
}

inline Int dot(const std::vector<Int>& d, const Point& p) { return d[0] * p[0] + d[1] * p[1] + d[2] * p[2]; }

}  // namespace cchip::certificate_check

#endif
