// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/cpu_device.hpp>
#include <cchip/device.hpp>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace cchip {
namespace {

struct NamedDevice {
  std::string name;
  DeviceOpener open;
};

/// All devices, "cpu" first.
class Registry {
 public:
  void add(const std::string& name, DeviceOpener open) {
    if (name.empty() || !open) throw std::invalid_argument("a device needs a name and a function that opens it");
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto has_name = [&name](const NamedDevice& device) { return device.name == name; };
    if (std::any_of(devices_.begin(), devices_.end(), has_name)) {
      throw std::invalid_argument("device " + name + " is known already: choose another name");
    }
    devices_.push_back({name, std::move(open)});
  }
  std::vector<NamedDevice> all() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return devices_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<NamedDevice> devices_ = {{"cpu", [] { return open_cpu_device(); }}};
};

/// Made by its first use, which may come before main(), and never destroyed: destructors of static objects use it, too.
Registry& registry() {
  static Registry* const devices = new Registry;  // NOLINT: reachable to the end
  return *devices;
}

}  // namespace

void add_device(const std::string& name, DeviceOpener open) { registry().add(name, std::move(open)); }

std::vector<std::string> device_names() {
  std::vector<std::string> names;
  for (const NamedDevice& device : registry().all()) names.push_back(device.name);
  return names;
}

std::unique_ptr<Device> open_device(const std::string& name) {
  std::string known;
  for (const NamedDevice& device : registry().all()) {
    if (name == device.name) return device.open();
    known += (known.empty() ? "" : ", ") + device.name;
  }
  const char* const remedy = name == "model" ? "; link collisionchip::driver and call add_model_device() first" : "";
  throw std::invalid_argument("device " + name + " is not known: the devices are " + known + remedy);
}

}  // namespace cchip
