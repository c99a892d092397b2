// SPDX-License-Identifier: Apache-2.0
// How the time of some queries grows: coarse faces on fine ones, polygons of many corners, many faces round one vertex.
// Each line has the seconds of a size, and of one twice as large, and the exponent of the growth between them.
//
// usage: bench_sizes [quick]   (quick: small sizes, for a test)
#include <cchip/cchip.hpp>
#include <cchip/certify.hpp>
#include <cchip/check.hpp>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

using namespace cchip;

namespace {

const Pose here = Pose::Identity();
constexpr double pi = 3.14159265358979323846;

/// A closed slab over [0, size]^2, of n x n squares above and below, each cut into two triangles.
Mesh slab(int n, double low, double high, double size) {
  Mesh mesh;
  const auto number = [n](int i, int j, int k) { return static_cast<std::uint32_t>((k * (n + 1) + j) * (n + 1) + i); };
  for (const double z : {low, high}) {
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) mesh.vertices.emplace_back(size * i / n, size * j / n, z);
    }
  }
  const auto add = [&mesh](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.faces.push_back({Kind::tri, {a, b, c, 0}});
    mesh.faces.push_back({Kind::tri, {a, c, d, 0}});
  };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      add(number(i, j, 1), number(i + 1, j, 1), number(i + 1, j + 1, 1), number(i, j + 1, 1));
      add(number(i, j, 0), number(i, j + 1, 0), number(i + 1, j + 1, 0), number(i + 1, j, 0));
    }
  }
  for (int i = 0; i < n; ++i) {
    add(number(i, 0, 0), number(i + 1, 0, 0), number(i + 1, 0, 1), number(i, 0, 1));
    add(number(i + 1, n, 0), number(i, n, 0), number(i, n, 1), number(i + 1, n, 1));
    add(number(0, i + 1, 0), number(0, i, 0), number(0, i, 1), number(0, i + 1, 1));
    add(number(n, i, 0), number(n, i + 1, 0), number(n, i + 1, 1), number(n, i, 1));
  }
  return mesh;
}

/// A flat star of n corners as one polygon of a file.
Mesh star(int n, double shift, double turn) {
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "cchip_bench_star.obj";
  {
    std::ofstream out(path);
    out.precision(17);
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * pi * i / n + turn;
      const double radius = i % 2 != 0 ? 1 : 0.8;
      out << "v " << radius * std::cos(angle) + shift << ' ' << radius * std::sin(angle) << " 0\n";
    }
    out << 'f';
    for (int i = 1; i <= n; ++i) out << ' ' << i;
    out << '\n';
  }
  Mesh mesh = load_mesh(path.string());
  std::filesystem::remove(path);
  return mesh;
}

/// n faces round one vertex.
Mesh fan(int n) {
  Mesh mesh;
  mesh.vertices.emplace_back(0, 0, 0);
  for (int i = 0; i <= n; ++i) mesh.vertices.emplace_back(1, std::cos(6.0 * i / n), std::sin(6.0 * i / n));
  for (std::uint32_t i = 1; i <= static_cast<std::uint32_t>(n); ++i)
    mesh.faces.push_back({Kind::tri, {0, i, i + 1, 0}});
  return mesh;
}

/// Of the processor.
double seconds(const std::function<void()>& call) {
  const std::clock_t start = std::clock();
  call();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

class Table {
 public:
  /// \param run takes a size and returns its seconds and whether the answer was right
  void row(const char* name, int size, const std::function<std::pair<double, bool>(int)>& run) {
    const auto [one, right] = run(size);
    const auto [two, right_too] = run(2 * size);
    ++rows_;
    wrong_ += right && right_too ? 0 : 1;
    std::printf("%-34s %6d %9.5f s %6d %9.5f s  exponent %.2f\n", name, size, one, 2 * size, two, std::log2(two / one));
  }
  int finish() const {
    std::printf("sizes=%d wrong=%d\n", rows_, wrong_);
    return wrong_ == 0 ? 0 : 1;
  }

 private:
  int rows_ = 0;
  int wrong_ = 0;
};

std::pair<double, bool> solids_of(const Object& a, const Object& b, SolidRelation expected) {
  SolidRelation found = {};
  const double time = seconds([&] { found = solids(a, here, b, here); });
  return {time, found == expected};
}

}  // namespace

int main(int argc, char** argv) {
  const bool quick = argc > 1 && std::string(argv[1]) == "quick";
  Table table;
  const int cells = quick ? 4 : 32;
  table.row("solids, box on a fine plate", cells, [](int n) {
    return solids_of(Object(slab(n, -1, 0, 1)), Object(slab(1, 0, 1, 0.99)), SolidRelation::touching);
  });
  table.row("solids, fine plates, flush", cells, [](int n) {
    return solids_of(Object(slab(n, -1, 0, 1)), Object(slab(n, 0, 1, 1)), SolidRelation::touching);
  });
  for (const bool solid : {false, true}) {  // boxes overlap, no contact
    table.row(solid ? "solids, disjoint, asked again" : "collide, the same", cells, [solid](int n) {
      const Object a(slab(n, -1, 0, 1));
      Mesh other = slab(n, -1, 0, 1);
      for (Vec3d& v : other.vertices) v = {v.x() + v.y() + 0.6, v.y() - v.x() + 1.6, v.z()};
      const Object b(other);
      bool right = true;
      const auto ask = [&] {
        right = solid ? solids(a, here, b, here) == SolidRelation::disjoint : !collide(a, here, b, here).hit;
      };
      ask();
      constexpr int times = 100;
      return std::pair(seconds([&] {
                         for (int i = 0; i < times; ++i) ask();
                       }) / times,
                       right);
    });
  }
  const int corners = quick ? 20 : 500;
  const auto polygons = [&table, corners](const char* name, const std::function<bool(const CollisionQuery&)>& ask) {
    table.row(name, corners, [&ask](int n) {
      const Object a(star(n, 0, 0));
      const Object b(star(n, 1.7, 0.1));
      bool right = false;
      const double time = seconds([&] { right = ask({&a, &here, &b, &here}); });
      return std::pair(time, right);
    });
  };
  const CollisionRequest all = {CollisionRequest::Contacts::all};
  polygons("polygons, contacts",
           [&all](const CollisionQuery& q) { return collide(*q.a, here, *q.b, here, all).contacts.size() == 1; });
  polygons("polygons, intersections", [](const CollisionQuery& q) { return !intersections(q, {{0, 0}})[0].empty(); });
  polygons("polygons, distance", [](const CollisionQuery& q) { return distance(*q.a, here, *q.b, here).upper == 0; });
  polygons("polygons, certificate", [](const CollisionQuery& q) {
    const Certificate certificate = certify(q, {}, collide(*q.a, here, *q.b, here));
    return check_certificate(q.a->mesh(), here, q.b->mesh(), here, certificate).accepted;
  });
  polygons("polygons, relation of one contact", [&all](const CollisionQuery& q) {
    CollisionRequest one = all;
    one.relation = true;
    one.max_contacts = 1;
    return collide(*q.a, here, *q.b, here, one).contacts.size() == 1;
  });
  table.row("self contacts of a fan", quick ? 50 : 8000, [](int n) {
    const Object object(fan(n));
    bool right = false;
    const double time = seconds([&] { right = self_contacts(object).empty(); });
    return std::pair(time, right);
  });
  table.row("self contacts of a sphere", quick ? 1 : 4, [](int n) {
    const Object object(make_sphere(1, n));
    bool right = false;
    const double time = seconds([&] { right = self_contacts(object).empty(); });
    return std::pair(time, right);
  });
  table.row("objects of a fine plate", cells, [](int n) {
    const double time = seconds([n] { const Object object(slab(n, -1, 0, 1)); });
    return std::pair(time, true);
  });
  return table.finish();
}
