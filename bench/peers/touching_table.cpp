// SPDX-License-Identifier: Apache-2.0
// Prints the table of docs/cpp/touching.md: the cases, answered by the CPU device and by FCL.
#include <algorithm>
#include <cchip/device/device.hpp>
#include <iostream>

#include "peer_library.hpp"
#include "touching_cases.hpp"

using namespace cchip;
using namespace cchip::testing;

int main() {
  const PeerLibrary fcl = PeerLibrary::fcl_debian();
  const auto device = open_device("cpu");
  CollisionRequest request;
  request.contacts = CollisionRequest::Contacts::all;
  request.relation = true;
  const std::string description = fcl.description();
  std::cout << "| case | relation | pairs of faces that cross | that touch | FCL "
            << description.substr(0, description.find(',')) << " |\n|---|---|---|---|---|\n";
  for (const TouchingCase& c : touching_cases()) {
    const CollisionResult result = collide(*device, Object(c.a), c.pose_a, Object(c.b), c.pose_b, request);
    const auto crosses = [](const Contact& contact) { return contact.relation == Relation::crossing; };
    const auto crossing = std::count_if(result.contacts.begin(), result.contacts.end(), crosses);
    const char* relation = crossing > 0 ? "crossing" : result.hit ? "touching" : "apart";
    std::cout << "| " << c.name << " | " << relation << " | " << crossing << " | "
              << static_cast<std::ptrdiff_t>(result.contacts.size()) - crossing << " | "
              << (fcl.mesh(c.a).hit(c.pose_a, fcl.mesh(c.b), c.pose_b) ? "hit" : "no hit") << " |\n";
  }
}
