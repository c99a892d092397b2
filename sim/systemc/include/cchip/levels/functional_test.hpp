// SPDX-License-Identifier: Apache-2.0
/// \file
/// Level 0: the primitive tests, purely functional, without time, with FIFOs only (paper, section 3 and figure 3). They
/// know nothing of reconfiguration.
#ifndef CCHIP_LEVELS_FUNCTIONAL_TEST_HPP
#define CCHIP_LEVELS_FUNCTIONAL_TEST_HPP

#include <array>
#include <cchip/levels/exact_sat.hpp>
#include <cchip/levels/stimulus.hpp>
#include <cstdint>
#include <ostream>
#include <systemc>

namespace cchip::levels {

/// Vertices of a primitive, grid steps; of a triangle the last is not used.
struct Vertices {
  std::array<std::array<std::int32_t, 3>, 4> v = {};
  friend bool operator==(const Vertices& x, const Vertices& y) { return x.v == y.v; }
  friend std::ostream& operator<<(std::ostream& out, const Vertices& x);
};

/// The first `count` vertices, as they are.
std::vector<Integers> vertices_of(const Vertices& p, std::size_t count);
/// The first `count` vertices times m, rounded by floor(x + 1/2), in fixed-point arithmetic.
std::vector<Integers> placed_vertices_of(const Vertices& p, std::size_t count, const Matrix& m);

/// Reads m, a and b, places a by m, writes whether the two intersect; repeatedly, one answer for each input, in order.
/// \tparam vertices_a, vertices_b  3 triangle, 4 quad
template <std::size_t vertices_a, std::size_t vertices_b>
class FunctionalTest : public sc_core::sc_module {
 public:
  sc_core::sc_fifo_in<Matrix> m{"m"};
  sc_core::sc_fifo_in<Vertices> a{"a"};
  sc_core::sc_fifo_in<Vertices> b{"b"};
  sc_core::sc_fifo_out<bool> hit{"hit"};

  SC_HAS_PROCESS(FunctionalTest);
  explicit FunctionalTest(const sc_core::sc_module_name&) { SC_THREAD(run); }

 private:
  void run() {
    while (true) {
      const Matrix matrix = m.read();
      const SatPrimitive in_b = make_sat_primitive(placed_vertices_of(a.read(), vertices_a, matrix));
      hit.write(sat_intersects(in_b, make_sat_primitive(vertices_of(b.read(), vertices_b))));
    }
  }
};

/// The same for a point and a triangle: of a vertex 0 is the centre of a sphere, x of vertex 1 its radius, which m does
/// not change.
class FunctionalPointTri : public sc_core::sc_module {
 public:
  sc_core::sc_fifo_in<Matrix> m{"m"};
  sc_core::sc_fifo_in<Vertices> a{"a"};
  sc_core::sc_fifo_in<Vertices> b{"b"};
  sc_core::sc_fifo_out<bool> hit{"hit"};

  SC_HAS_PROCESS(FunctionalPointTri);
  explicit FunctionalPointTri(const sc_core::sc_module_name&) { SC_THREAD(run); }

 private:
  void run() {
    while (true) {
      const Matrix matrix = m.read();
      const Vertices point = a.read();
      const Integers centre = placed_vertices_of(point, 1, matrix).front();
      hit.write(sphere_intersects(centre, point.v[1][0], vertices_of(b.read(), 3)));
    }
  }
};

using FunctionalTriTri = FunctionalTest<3, 3>;
using FunctionalTriQuad = FunctionalTest<3, 4>;
using FunctionalQuadQuad = FunctionalTest<4, 4>;

}  // namespace cchip::levels

#endif
