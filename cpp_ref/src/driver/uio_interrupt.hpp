// SPDX-License-Identifier: Apache-2.0
/// \file
/// Level of an interrupt line behind a UIO file.
#ifndef CCHIP_SRC_DEVICE_UIO_INTERRUPT_HPP
#define CCHIP_SRC_DEVICE_UIO_INTERRUPT_HPP

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

namespace cchip {

/// UIO reports a line that has risen once, and keeps it masked until it is armed again. It is armed here when the line
/// has fallen: earlier, the same event would be reported again. One that rises in between is reported after the arming.
class UioInterrupt {
 public:
  /// \param file outlives this; arms the interrupt
  /// \throws std::runtime_error the file refuses that
  UioInterrupt(int file, std::string name) : file_(file), name_(std::move(name)) {
    exists_ = try_to_arm();
    // EIO: the device has no interrupt. ENOSYS: its kernel driver cannot mask it.
    if (!exists_ && errno != EIO && errno != ENOSYS) fail("arm the interrupt");
  }

  /// \param line level of the line by the registers; called only if it may be 1
  /// \throws std::runtime_error the file refuses a call
  template <class Line>
  bool level(const Line& line) {
    if (!exists_) return line();
    if (!fired_) fired_ = take_event();
    if (!fired_ || line()) return fired_;
    fired_ = false;
    if (!try_to_arm()) fail("arm the interrupt");
    return false;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error("uio: cannot " + what + " of " + name_ + ": " + std::generic_category().message(errno) +
                             "; see the kernel's log");
  }

  bool try_to_arm() const {
    const std::int32_t on = 1;
    return write(file_, &on, sizeof on) == sizeof on;
  }

  /// Without blocking.
  bool take_event() const {
    pollfd entry = {file_, POLLIN, 0};
    int ready = 0;
    do ready = poll(&entry, 1, 0);
    while (ready < 0 && errno == EINTR);
    if (ready < 0) fail("poll the interrupt");
    if (ready == 0) return false;
    std::uint32_t count = 0;  // of all events, not needed
    ssize_t got = 0;
    do got = read(file_, &count, sizeof count);
    while (got < 0 && errno == EINTR);
    if (got < 0 && errno == EAGAIN) return false;
    if (got != sizeof count) fail("read the interrupt");
    return true;
  }

  int file_;
  std::string name_;
  bool exists_ = false;
  bool fired_ = false;  // and not armed again
};

}  // namespace cchip

#endif
