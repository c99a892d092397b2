// SPDX-License-Identifier: Apache-2.0
// Queries from the destructor of a static object, which runs after main() and after the end of what its thread owns.
#include <cchip/along.hpp>
#include <cchip/device.hpp>
#include <cchip/distance.hpp>
#include <cchip/point_cloud.hpp>
#include <cchip/shapes.hpp>
#include <cchip/solids.hpp>
#include <iostream>

namespace {

/// Asks every question once, without a device and with one of each name.
std::size_t ask() {
  const cchip::Object torus(cchip::make_torus(1, 0.25, 64, 32));
  const cchip::Object gear(cchip::make_gear(1.25, 1.5, 0.5, 0.5, 36, 6));
  const cchip::Pose here = cchip::Pose::Identity();
  const cchip::Pose pose = cchip::make_pose({0, 0, 0.4}, {0, 0, 0});
  const cchip::CollisionRequest all = {cchip::CollisionRequest::Contacts::all};
  const std::size_t contacts = cchip::collide(torus, here, gear, pose, all).contacts.size();
  bool same = cchip::distance(torus, here, gear, pose).upper == 0 &&
              cchip::clear_along(torus, here, gear, pose, {0, 0, 1}).touches &&
              cchip::first_contact(torus, here, gear, pose, {0, 0, 1}).touches &&
              cchip::solids(torus, here, gear, pose) == cchip::SolidRelation::overlapping;
  for (const std::string& name : cchip::device_names()) {
    same = same && cchip::collide(*cchip::open_device(name), torus, here, gear, pose, all).contacts.size() == contacts;
  }
  return same ? contacts : 0;
}

struct Last {
  ~Last() { std::cout << ask() << " contacts after main" << std::endl; }
};
const Last last;

}  // namespace

int main() { return ask() == 834 ? 0 : 1; }
