// SPDX-License-Identifier: Apache-2.0
/// \file
/// Squares of the distances of vertices, edges and faces, over any number type.
//
// Two hulls of three or four points without a common point are as far apart as the nearest of these pairs: two
// vertices; a vertex and the inside of an edge; the insides of two edges that are not parallel; a vertex and the inside
// of a triangle. Proof: a hull of three points, and the boundary of one of four, are the union of the triangles of
// three of its vertices, and nearest points of disjoint hulls lie on the boundaries. Each of the two lies inside a
// smallest face of its triangle, a vertex, an edge or the triangle; take nearest points whose faces have the fewest
// dimensions together. If both faces had a direction in common, both points could be moved along it, as far apart as
// before, until one of them met the boundary of its face, which has fewer dimensions. So they have none, and since the
// direction between the points is orthogonal to both faces, these have at most two dimensions together.
// Edges between any two vertices and triangles of any three lie within the hulls, so those that are no faces do no
// harm.
#ifndef CCHIP_EXACT_FEATURE_PAIRS_HPP
#define CCHIP_EXACT_FEATURE_PAIRS_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "hulls.hpp"

namespace cchip::exact {

/// Vertices of a hull by their numbers: one, two or three.
struct Feature {
  std::uint8_t count;
  std::array<std::uint8_t, 3> at;
};

/// All features of a hull of four points; those of the first three vertices come first among their kind.
inline constexpr std::array<Feature, 14> features = {{{1, {0, 0, 0}},
                                                      {1, {1, 0, 0}},
                                                      {1, {2, 0, 0}},
                                                      {1, {3, 0, 0}},
                                                      {2, {0, 1, 0}},
                                                      {2, {0, 2, 0}},
                                                      {2, {1, 2, 0}},
                                                      {2, {0, 3, 0}},
                                                      {2, {1, 3, 0}},
                                                      {2, {2, 3, 0}},
                                                      {3, {0, 1, 2}},
                                                      {3, {0, 1, 3}},
                                                      {3, {0, 2, 3}},
                                                      {3, {1, 2, 3}}}};
/// Features of hulls of `count` points, by the number of their vertices less 1: from `first` on `size` of them.
struct FeatureRange {
  std::size_t first;
  std::size_t size;
};
constexpr FeatureRange features_of(std::size_t vertices, std::size_t count) {
  constexpr std::array<std::array<FeatureRange, 3>, 2> ranges = {
      {{{{0, 3}, {4, 3}, {10, 1}}}, {{{0, 4}, {4, 6}, {10, 4}}}}};
  return ranges[count - 3][vertices - 1];
}

/// Numbers in `features` of one of A and one of B.
struct FeaturePair {
  std::uint8_t a;
  std::uint8_t b;
};

/// At most this many pairs: 16 + 2 * 24 + 36 + 2 * 16.
inline constexpr std::size_t feature_pairs_most = 132;

/// Calls visit(FeaturePair) for those of two hulls, until it returns false.
template <class Visit>
void for_each_feature_pair(std::size_t count_a, std::size_t count_b, const Visit& visit) {
  constexpr std::array<std::array<std::size_t, 2>, 6> kinds = {{{1, 1}, {1, 2}, {2, 1}, {2, 2}, {1, 3}, {3, 1}}};
  for (const auto& [vertices_a, vertices_b] : kinds) {
    const FeatureRange a = features_of(vertices_a, count_a);
    const FeatureRange b = features_of(vertices_b, count_b);
    for (std::size_t i = a.first; i < a.first + a.size; ++i) {
      for (std::size_t k = b.first; k < b.first + b.size; ++k) {
        if (!visit(FeaturePair{static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(k)})) return;
      }
    }
  }
}

template <class Num>
Num dot(const Vec<Num>& p, const Vec<Num>& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

/// A square as a fraction, and numbers that are all positive only if the nearest points of the lines and planes lie
/// inside the edges and faces: then `under` is positive, too.
template <class Num>
struct SquareOfPair {
  Num over;
  Num under;
  std::array<Num, 4> inside;
  std::size_t inside_count = 0;
  void require(const Num& x) { inside[inside_count++] = x; }
};

template <class Num>
SquareOfPair<Num> square_of(const std::array<Vec<Num>, 4>& a, const std::array<Vec<Num>, 4>& b, FeaturePair pair) {
  const Feature& f = features[pair.a];
  const Feature& g = features[pair.b];
  SquareOfPair<Num> s;
  const auto point_edge = [&s](const Vec<Num>& p, const Vec<Num>& from, const Vec<Num>& to) {
    const Vec<Num> edge = to - from;
    const Vec<Num> between = p - from;
    const Vec<Num> normal = cross(between, edge);
    s.over = dot(normal, normal);
    s.under = dot(edge, edge);
    const Num at = dot(edge, between);
    s.require(at);
    s.require(s.under - at);
  };
  const auto point_face = [&s](const Vec<Num>& p, const Vec<Num>& u, const Vec<Num>& v, const Vec<Num>& w) {
    const Vec<Num> normal = cross(v - u, w - u);
    const Vec<Num> from_u = p - u;
    const Num height = dot(normal, from_u);
    s.over = height * height;
    s.under = dot(normal, normal);
    s.require(dot(normal, cross(v - u, from_u)));
    s.require(dot(normal, cross(w - v, p - v)));
    s.require(dot(normal, cross(u - w, p - w)));
  };
  if (f.count == 1 && g.count == 1) {
    const Vec<Num> between = a[f.at[0]] - b[g.at[0]];
    s.over = dot(between, between);
    s.under = Num(1);
  } else if (f.count == 1 && g.count == 2) {
    point_edge(a[f.at[0]], b[g.at[0]], b[g.at[1]]);
  } else if (f.count == 2 && g.count == 1) {
    point_edge(b[g.at[0]], a[f.at[0]], a[f.at[1]]);
  } else if (f.count == 1) {
    point_face(a[f.at[0]], b[g.at[0]], b[g.at[1]], b[g.at[2]]);
  } else if (g.count == 1) {
    point_face(b[g.at[0]], a[f.at[0]], a[f.at[1]], a[f.at[2]]);
  } else {
    // p + s u and r + t v with r - p = s u - t v + h n, n = u x v: s n n = ((r - p) x v) n, t n n = ((r - p) x u) n
    const Vec<Num> u = a[f.at[1]] - a[f.at[0]];
    const Vec<Num> v = b[g.at[1]] - b[g.at[0]];
    const Vec<Num> between = b[g.at[0]] - a[f.at[0]];
    const Vec<Num> normal = cross(u, v);
    const Num height = dot(normal, between);
    s.over = height * height;
    s.under = dot(normal, normal);
    for (const Num& at : {dot(normal, cross(between, v)), dot(normal, cross(between, u))}) {
      s.require(at);
      s.require(s.under - at);
    }
  }
  return s;
}

enum class Known { no, yes, open };

/// Are the nearest points inside the features, at a distance whose square is at most `square`, or less than it?
template <class Num>
Known is_near(const SquareOfPair<Num>& s, const Num& square, bool strictly) {
  bool open = false;
  const int side = sign_if_known(Num(s.over - square * s.under), open);
  if (!open && (side > 0 || (side == 0 && strictly))) return Known::no;
  for (std::size_t i = 0; i < s.inside_count; ++i) {
    bool open_here = false;
    const int sign = sign_if_known(s.inside[i], open_here);
    if (!open_here && sign <= 0) return Known::no;
    open = open || open_here;
  }
  return open ? Known::open : Known::yes;
}

}  // namespace cchip::exact

#endif
