// SPDX-License-Identifier: Apache-2.0
/// \file
/// cchip_chip on a Linux board, without a kernel driver of its own: registers and interrupt through the UIO framework,
/// memory through a file that maps it (docs/hardware/uio.md). Linux only.
#ifndef CCHIP_DRIVER_UIO_DEVICE_HPP
#define CCHIP_DRIVER_UIO_DEVICE_HPP

#include <cchip/collide.hpp>
#include <cchip/driver/chip_driver.hpp>
#include <cchip/driver/machine.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace cchip {

struct UioOptions {
  /// UIO file of the chip, whose first mapping is its registers; any file that maps them will do.
  std::string registers = "/dev/uio0";
  std::size_t register_bytes = 4096;  ///< a multiple of 4
  /// File that maps the memory that host and chip share, such as "/dev/udmabuf0" or "/dev/mem".
  std::string memory;
  std::uint64_t memory_file_offset = 0;  ///< where it begins in that file, a multiple of the page size
  std::uint64_t memory_base = 0;         ///< address of its first byte as the chip sees it
  std::uint64_t memory_bytes = 0;        ///< a multiple of 4
  /// The chip's bus port is coherent with the host's caches, so the mapping may be cached. false: the file is opened
  /// with O_SYNC, which asks its driver for an uncached mapping.
  bool coherent = false;
  /// Machine::proceed() sleeps so long, and some 50 us more, as Linux does; 0: gives the core to who wants it, and
  /// returns at once. ChipDriverOptions::patience counts these.
  std::chrono::microseconds poll{0};
  /// If set, proceed() calls it instead of sleeping.
  std::function<void()> wait;
};

/// Maps both files; touches no register, but arms the interrupt of a UIO file. interrupt() asks that file, and reads
/// the registers of events only if it has fired. It reads these every time if the file is not UIO's or has no
/// interrupt.
/// \throws std::invalid_argument an option is out of range
/// \throws std::runtime_error a file cannot be opened or mapped
std::unique_ptr<Machine> open_uio_machine(const UioOptions& options);

/// Driver and host over open_uio_machine().
/// \param driver memory_base and memory_bytes of `options` replace its own
/// \throws as open_uio_machine() and open_chip()
std::unique_ptr<Device> open_uio_device(const UioOptions& options, ChipDriverOptions driver = {});

}  // namespace cchip

#endif
