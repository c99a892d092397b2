// SPDX-License-Identifier: Apache-2.0
/// How long bits take: load time of a bitstream (eq. 4), transmission over a bus (eq. 6), both one after the other
/// (eq. 5). Needs <systemc> only.
#ifndef CCHIP_RC_BITSTREAM_TIMING_HPP
#define CCHIP_RC_BITSTREAM_TIMING_HPP

#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <systemc>

namespace cchip::rc {

/// A port or bus that takes `width` bits on every clock.
struct bit_path {
  std::uint64_t width = 0;  ///< bits
  std::uint64_t clock = 0;  ///< Hz
};

/// The paper's hardware (section 3.2): configuration port of a Virtex-II, local bus of an ADM-XRC-II board.
inline constexpr bit_path virtex2_port{8, 50'000'000};
inline constexpr bit_path adm_xrc2_bus{32, 66'000'000};

/// Time of a whole number of picoseconds, exactly. Errors: the resolution of sc_time is coarser than 1 ps; the number
/// does not fit into sc_time.
inline sc_core::sc_time from_picoseconds(std::uint64_t picoseconds) {
  const std::uint64_t unit = sc_core::sc_time(1, sc_core::SC_PS).value();
  if (unit == 0) {
    throw std::logic_error("bitstream timing: the time resolution is " + sc_core::sc_get_time_resolution().to_string() +
                           "; leave it at 1 ps or finer");
  }
  if (picoseconds > std::numeric_limits<std::uint64_t>::max() / unit) {
    throw std::overflow_error("bitstream timing: " + std::to_string(picoseconds) + " ps do not fit into sc_time");
  }
  return sc_core::sc_time::from_value(picoseconds * unit);
}

/// Time in which `bits` bits pass: ceil(bits / width) clocks. The product of clocks and period, which need not be a
/// whole number of picoseconds (66 MHz), is rounded up to the next one, once. Errors: a width or clock of 0, a time
/// beyond sc_time (more than 200 days).
inline sc_core::sc_time transfer_time(std::uint64_t bits, const bit_path& path) {
  constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  constexpr std::uint64_t clock_limit = most / 1000;
  if (path.width == 0 || path.clock == 0 || path.clock > clock_limit) {
    throw std::invalid_argument(
        "bitstream timing: a path of " + std::to_string(path.width) + " bits at " + std::to_string(path.clock) +
        " Hz; width and clock must be above 0, the clock at most " + std::to_string(clock_limit));
  }
  const std::uint64_t clocks = bits / path.width + (bits % path.width != 0 ? 1 : 0);
  std::uint64_t time = clocks / path.clock;  // s, then ms, us, ns, ps: long division, exact
  std::uint64_t rest = clocks % path.clock;
  if (time >= most / 1'000'000'000'000) {
    throw std::overflow_error("bitstream timing: " + std::to_string(bits) + " bits take " + std::to_string(time) +
                              " s, which does not fit into sc_time; check width and clock");
  }
  for (int step = 0; step < 4; ++step) {
    time = 1000 * time + 1000 * rest / path.clock;
    rest = 1000 * rest % path.clock;
  }
  return from_picoseconds(time + (rest != 0 ? 1 : 0));
}

/// Bitstream length of a module in bits, attached to it as an attribute (section 3.2), so that the module itself
/// needs no change. It belongs to `module` until it is destroyed, and must be destroyed before it: a member of a class
/// derived from the module, or declared after it. Error: the module has such an attribute already.
class bitfile_size : public sc_core::sc_attribute<std::uint64_t> {
 public:
  static constexpr const char* attribute = "bitfile_bits";

  bitfile_size(sc_core::sc_object& module, std::uint64_t bits)
      : sc_core::sc_attribute<std::uint64_t>(attribute, bits), module_(&module) {
    if (!module.add_attribute(*this)) {
      throw std::logic_error(std::string(module.name()) + ": has two attributes '" + attribute + "'; keep one");
    }
  }
  bitfile_size(const bitfile_size&) = delete;
  bitfile_size& operator=(const bitfile_size&) = delete;
  ~bitfile_size() override { module_->remove_attribute(attribute); }

 private:
  sc_core::sc_object* module_;
};

/// Bitstream length of a module in bits, if it has one. Error: the attribute has another type than std::uint64_t.
inline std::optional<std::uint64_t> bitfile_bits(const sc_core::sc_object& module) {
  const sc_core::sc_attr_base* found = module.get_attribute(bitfile_size::attribute);
  if (found == nullptr) return std::nullopt;
  const auto* bits = dynamic_cast<const sc_core::sc_attribute<std::uint64_t>*>(found);
  if (bits == nullptr) {
    throw std::logic_error(std::string(module.name()) + ": attribute '" + bitfile_size::attribute +
                           "' is no std::uint64_t; use cchip::rc::bitfile_size");
  }
  return bits->value;
}

/// The paper's delays for one configuration port and one bus.
class bitstream_timing {
 public:
  explicit bitstream_timing(bit_path port = virtex2_port, bit_path bus = adm_xrc2_bus) : port_(port), bus_(bus) {}

  const bit_path& port() const { return port_; }
  const bit_path& bus() const { return bus_; }

  /// Eq. (4), of a bitstream.
  sc_core::sc_time configuration(std::uint64_t bits) const { return transfer_time(bits, port_); }
  /// Eq. (4), of a module's bitstream; no time for a module without bitfile_size.
  sc_core::sc_time configuration(const sc_core::sc_object& module) const {
    return configuration(bitfile_bits(module).value_or(0));
  }
  /// Eq. (6), of data.
  sc_core::sc_time transmission(std::uint64_t bits) const { return transfer_time(bits, bus_); }
  /// Eq. (5), both over one bus.
  sc_core::sc_time overall(std::uint64_t data_bits, std::uint64_t bitstream_bits) const {
    return transmission(data_bits) + configuration(bitstream_bits);
  }

 private:
  bit_path port_;
  bit_path bus_;
};

}  // namespace cchip::rc

#endif  // CCHIP_RC_BITSTREAM_TIMING_HPP
