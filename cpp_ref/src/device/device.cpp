// SPDX-License-Identifier: Apache-2.0
#include <cchip/device/cpu_device.hpp>
#include <cchip/device/device.hpp>
#include <stdexcept>

#include "model_device.hpp"

namespace cchip {
namespace {

struct NamedDevice {
  const char* name;
  std::unique_ptr<Device> (*open)();
};

constexpr NamedDevice devices[] = {
    {"cpu", [] { return open_cpu_device(); }},
    {"model", make_model_device},
};

}  // namespace

std::vector<std::string> device_names() {
  std::vector<std::string> names;
  for (const NamedDevice& device : devices) names.emplace_back(device.name);
  return names;
}

std::unique_ptr<Device> open_device(const std::string& name) {
  std::string known;
  for (const NamedDevice& device : devices) {
    if (name == device.name) return device.open();
    known += (known.empty() ? "" : ", ") + std::string(device.name);
  }
  throw std::invalid_argument("device " + name + " is not known: the devices are " + known);
}

}  // namespace cchip
