// SPDX-License-Identifier: Apache-2.0
// Queries from the constructors of global objects, which run before main(): the answers are those of later.
#include <cchip/cpu_device.hpp>
#include <cchip/device.hpp>
#include <cchip/shapes.hpp>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace {

/// Contacts of the README's example with each device and instruction set.
struct Contacts {
  Contacts() {
    const cchip::Object torus(cchip::make_torus(1, 0.25, 64, 32));
    const cchip::Object gear(cchip::make_gear(1.25, 1.5, 0.5, 0.5, 36, 6));
    const cchip::Pose pose = cchip::make_pose({0, 0, 0.4}, {0, 0, 0});
    const auto count = [&](const std::unique_ptr<cchip::Device>& device) {
      counts.push_back(
          cchip::collide(*device, torus, cchip::Pose::Identity(), gear, pose, {cchip::CollisionRequest::Contacts::all})
              .contacts.size());
    };
    for (const std::string& target : cchip::cpu_targets()) count(cchip::open_cpu_device({1, target}));
    for (const std::string& name : cchip::device_names()) count(cchip::open_device(name));
  }
  std::vector<std::size_t> counts;
};

// Before all objects of the libraries, regardless of the order in which they are linked; and where this file's turn
// comes.
__attribute__((init_priority(101))) const Contacts first;
const Contacts before_main;

}  // namespace

int main() {
  const Contacts in_main;
  bool same = true;
  for (std::size_t i = 0; i < in_main.counts.size(); ++i) {
    std::cout << "contacts first " << first.counts[i] << ", before main " << before_main.counts[i] << ", in main "
              << in_main.counts[i] << '\n';
    same = same && in_main.counts[i] == 834 && before_main.counts[i] == 834 && first.counts[i] == 834;
  }
  std::cout << (same ? "834 contacts each time\n" : "the order of initialisation changes answers\n");
  return same ? 0 : 1;
}
