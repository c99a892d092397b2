// SPDX-License-Identifier: Apache-2.0
// Time of clear_along() and first_contact(): docs/cpp/along.md.
#include <cchip/along.hpp>
#include <cchip/shapes.hpp>
#include <chrono>
#include <iomanip>
#include <iostream>
#include <string>
#include <vector>

namespace {

using namespace cchip;

struct Case {
  std::string name;
  Mesh a;
  Mesh b;
  Pose pose;
};

/// Mean milliseconds of five calls.
template <class Call>
double time_of(const Call& call) {
  constexpr int count = 5;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < count; ++i) call();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count() / count;
}

}  // namespace

int main() {
  const Pose here = Pose::Identity();
  const Pose turned = make_pose({0.3, 0.2, 0.1}, {20, 30, 40});
  const Pose moved(Eigen::Translation3d(0.3, 0.2, 0.1));
  const Mesh gear = make_gear(0.8, 1.2, 0.3, 0.5, 24, 6);
  std::cout
      << "| pair | faces of each | direction | clear_along(), ms | faces in integers | first_contact(), ms | faces in "
         "integers |\n|---|---|---|---|---|---|---|\n"
      << std::fixed << std::setprecision(1);
  for (const Case& c : {Case{"bodies that cross", make_body(30, 0.3, 1), make_body(30, 0.3, 2), turned},
                        {"tori that cross", make_torus(1, 0.4, 64, 32), make_torus(1, 0.4, 64, 32), turned},
                        {"gears that cross, axes parallel", gear, gear, moved}}) {
    const Object a(c.a), b(c.b);
    for (const Vec3d& d : {Vec3d(1, 0, 0), Vec3d(0.3, 0.5, -0.7)}) {
      Pose away = c.pose;
      away.translation() += 5 * d;
      const auto clear = [&] { return clear_along(a, here, b, c.pose, d); };
      const auto contact = [&] { return first_contact(a, here, b, away, -d); };
      std::cout << "| " << c.name << " | " << c.a.faces.size() << " | " << d[0] << ' ' << d[1] << ' ' << d[2] << " | "
                << time_of(clear) << " | " << clear().stats.open << " | " << time_of(contact) << " | "
                << contact().stats.open << " |\n";
    }
  }
}
