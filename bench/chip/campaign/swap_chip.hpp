// SPDX-License-Identifier: Apache-2.0
/// \file
/// A simulated chip whose modules are exchanged, and objects that need more than one of them.
#ifndef CCHIP_BENCH_CHIP_SWAP_CHIP_HPP
#define CCHIP_BENCH_CHIP_SWAP_CHIP_HPP

#include <array>
#include <cchip/cpu_device.hpp>
#include <cchip/driver/chip_host.hpp>
#include <cchip/driver/machine.hpp>
#include <cchip/internal/wire/chip_registers.hpp>
#include <cchip/shapes.hpp>
#include <cchip/sim/axi_memory.hpp>
#include <functional>
#include <memory>
#include <vector>

#include "campaign.hpp"

namespace cchip::testing {

/// A simulated chip with swaps as a device, and its machine.
struct SwapChip {
  std::unique_ptr<Device> device;
  Machine* machine = nullptr;                           // of the device
  std::function<void(sim::AxiMemoryOptions)> set_port;  ///< of the bitstreams' memory
  std::function<void(std::function<void(std::vector<sim::AxiBeat>&)>)> set_fault;
  std::function<void(bool)> set_silent;  ///< it takes no address
  std::function<std::uint64_t()> clocks;
  std::shared_ptr<std::array<std::uint64_t, 2>> overlap;  ///< clocks of TRANSFER, and those of them with box tests
};

/// \param slots 1 or 2
SwapChip make_swap_chip(unsigned slots, const sim::AxiLinesOptions& memory, const ChipDriverOptions& driver,
                        std::uint64_t seed);

/// Objects of triangles and of quads, and random pairs of them.
struct MixedObjects {
  MixedObjects() {
    objects.emplace_back(make_body(6, 0.3, 3));
    objects.emplace_back(make_torus(1, 0.4, 36, 24));
    objects.emplace_back(make_torus(1, 0.4, 36, 24, Kind::quad));
    objects.emplace_back(make_torus(0.8, 0.3, 24, 18, Kind::quad));
  }
  struct Placed {
    std::size_t a, b;
    PosePair pose;
  };
  Placed draw(Random& random) const {
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto pose = [&](double range) {
      Pose made = Pose::Identity();
      made.linear() =
          Eigen::Quaterniond(unit(random), unit(random), unit(random), unit(random)).normalized().toRotationMatrix();
      for (int i = 0; i < 3; ++i) made.translation()[i] = range * unit(random);
      return made;
    };
    return {random() % objects.size(), random() % objects.size(), {pose(0.2), pose(2)}};
  }
  std::vector<Object> objects;
};

}  // namespace cchip::testing

#endif
