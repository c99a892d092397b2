// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/cchip.hpp>
#include <iostream>

int main() {
  // A ball that is thicker than the ring through which it sticks.
  const cchip::Object ring(cchip::make_torus(1, 0.25, 48, 24)), ball(cchip::make_sphere(0.5, 6));
  const cchip::Pose here = cchip::Pose::Identity();
  cchip::Pose there = here;
  there.translation().x() = 1.125;
  const auto contacts = cchip::collide(ring, here, ball, there, {cchip::CollisionRequest::Contacts::all}).contacts;
  const cchip::CollisionQuery query = {&ring, &here, &ball, &there};
  // What two faces share.
  const cchip::Intersection first = cchip::intersections(query, contacts[0])[0];
  std::cout << contacts.size() << " pairs of faces; the first share a "
            << (first.kind == cchip::Intersection::Kind::segment ? "segment" : "point or polygon") << '\n';
  for (const cchip::Vec3d& end : first.points) std::cout << end.x() << ", " << end.y() << ", " << end.z() << '\n';
  // Chained: where the surfaces of ring and ball cross.
  for (const cchip::IntersectionCurve& curve : cchip::intersection_curves(query, contacts)) {
    double least = curve.points[0].y(), greatest = least;
    for (const cchip::Vec3d& point : curve.points) {
      least = std::min(least, point.y());
      greatest = std::max(greatest, point.y());
    }
    std::cout << (curve.closed ? "closed" : "open") << " curve of " << curve.points.size() << " points, y from "
              << least << " to " << greatest << '\n';
  }
}
