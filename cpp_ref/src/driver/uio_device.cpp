// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <atomic>
#include <cchip/driver/chip_host.hpp>
#include <cchip/driver/uio_device.hpp>
#include <cchip/internal/wire/chip_registers.hpp>
#include <cerrno>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

#include "uio_interrupt.hpp"

namespace cchip {
namespace {

namespace regs = chip_registers;

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument("uio: " + what); }
/// After a system call.
[[noreturn]] void fail(const std::string& what, const std::string& remedy) {
  throw std::runtime_error("uio: cannot " + what + ": " + std::generic_category().message(errno) + "; " + remedy);
}

class File {
 public:
  File(std::string name, int flags) : name_(std::move(name)), number_(open(name_.c_str(), O_RDWR | O_CLOEXEC | flags)) {
    if (number_ < 0) fail("open " + name_, "is its driver loaded, and may this user read and write it?");
  }
  ~File() { close(number_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  int number() const { return number_; }
  const std::string& name() const { return name_; }
  struct stat status() const {
    struct stat status = {};
    if (fstat(number_, &status) != 0) fail("look at " + name_, "name another file");
    return status;
  }
  /// Not every device file: a write of 1 to /dev/mem would change memory.
  bool is_uio() const {
    const struct stat now = status();
    if (!S_ISCHR(now.st_mode)) return false;
    const std::string numbers = std::to_string(major(now.st_rdev)) + ":" + std::to_string(minor(now.st_rdev));
    std::error_code none;
    return std::filesystem::read_symlink("/sys/dev/char/" + numbers + "/subsystem", none).filename() == "uio";
  }

 private:
  std::string name_;
  int number_;
};

/// Words of a file, in no order but that of order().
class Words {
 public:
  Words(const File& file, std::uint64_t offset, std::uint64_t bytes) : name_(file.name()), bytes_(bytes) {
    const struct stat status = file.status();
    if (S_ISREG(status.st_mode) && static_cast<std::uint64_t>(status.st_size) < offset + bytes) {
      throw std::runtime_error("uio: " + name_ + " has " + std::to_string(status.st_size) + " bytes, " +
                               std::to_string(offset + bytes) + " are needed; name another file or fewer bytes");
    }
    void* const at = mmap(nullptr, static_cast<std::size_t>(bytes), PROT_READ | PROT_WRITE, MAP_SHARED, file.number(),
                          static_cast<off_t>(offset));
    if (at == MAP_FAILED) {
      fail("map " + std::to_string(bytes) + " bytes of " + name_ + " from " + std::to_string(offset),
           "compare size and offset with the device tree");
    }
    words_ = static_cast<volatile std::uint32_t*>(at);
  }
  ~Words() { munmap(const_cast<std::uint32_t*>(words_), static_cast<std::size_t>(bytes_)); }
  Words(const Words&) = delete;
  Words& operator=(const Words&) = delete;

  /// \throws std::runtime_error not in the file
  volatile std::uint32_t* at(std::uint64_t offset, std::uint64_t bytes) const {
    if (offset % 4 != 0 || offset > bytes_ || bytes > bytes_ - offset) {
      throw std::runtime_error("uio: no " + std::to_string(bytes) + " bytes at " + std::to_string(offset) + " in the " +
                               std::to_string(bytes_) + " of " + name_);
    }
    return words_ + offset / 4;
  }

 private:
  std::string name_;
  std::uint64_t bytes_;
  volatile std::uint32_t* words_ = nullptr;
};

/// Accesses before it are seen by the chip, and are done, before those after it. The fence of C++ orders for other
/// cores, and speaks of atomic objects: it keeps the compiler from moving volatile accesses as every compiler for Linux
/// implements it, but the chip is outside of the domain of cores that it uses on Arm and RISC-V.
void order() {
  std::atomic_thread_fence(std::memory_order_seq_cst);
#if defined(__aarch64__) || defined(__arm__)
  asm volatile("dsb sy" ::: "memory");
#elif defined(__riscv)
  asm volatile("fence iorw, iorw" ::: "memory");
#endif
}

class UioMachine final : public Machine {
 public:
  explicit UioMachine(const UioOptions& options)
      : options_(checked(options)),
        register_file_(options.registers, O_SYNC),
        registers_(register_file_, 0, options.register_bytes),
        memory_(File(options.memory, options.coherent ? 0 : O_SYNC), options.memory_file_offset, options.memory_bytes) {
    if (register_file_.is_uio()) interrupt_.emplace(register_file_.number(), register_file_.name());
  }

  std::uint32_t read_register(std::uint32_t offset) override {
    const volatile std::uint32_t* const from = registers_.at(offset, 4);
    const std::uint32_t value = *from;
    order();  // what a register says of memory is true of reads and writes that follow
    return value;
  }
  void write_register(std::uint32_t offset, std::uint32_t value) override {
    volatile std::uint32_t* const to = registers_.at(offset, 4);
    order();  // queries and images are in memory before a doorbell, records have been read before their room is free
    *to = value;
  }

  // Whole aligned words, neither memcpy() nor std::copy(): those access what they like, which uncached mappings of some
  // hosts do not bear. Bytes lie in words as the chip has them, lowest first.
  void write_memory(std::uint64_t address, const Bytes& bytes) override {
    volatile std::uint32_t* to = memory_at(address, (bytes.size() + 3) / 4 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 4) {
      std::uint32_t word = 0;
      for (std::size_t k = 0; k < 4 && i + k < bytes.size(); ++k) word |= std::uint32_t{bytes[i + k]} << (8 * k);
      *to++ = word;
    }
  }
  Bytes read_memory(std::uint64_t address, std::size_t size) override {
    const volatile std::uint32_t* from = memory_at(address, size);
    Bytes bytes(size);
    for (std::size_t i = 0; i < size; i += 4) {
      const std::uint32_t word = *from++;
      for (std::size_t k = 0; k < 4 && i + k < size; ++k) bytes[i + k] = static_cast<std::uint8_t>(word >> (8 * k));
    }
    order();  // the rest of a record after its phase bit
    return bytes;
  }

  bool interrupt() override {
    const auto line = [this] {
      return (read_register(regs::interrupt_status::offset) & read_register(regs::interrupt_enable::offset)) != 0;
    };
    return interrupt_ ? interrupt_->level(line) : line();
  }

  void proceed() override {
    if (options_.wait) {
      options_.wait();
    } else if (options_.poll.count() == 0) {
      std::this_thread::yield();
    } else {
      std::this_thread::sleep_for(options_.poll);
    }
  }

 private:
  static const UioOptions& checked(const UioOptions& options) {
    if (options.registers.empty()) refuse("UioOptions::registers names no file");
    if (options.memory.empty()) refuse("UioOptions::memory names no file");
    if (options.register_bytes == 0 || options.register_bytes % 4 != 0)
      refuse("register_bytes is " + std::to_string(options.register_bytes) + ", multiples of 4 from 4 on are legal");
    if (options.memory_bytes == 0 || options.memory_bytes % 4 != 0)
      refuse("memory_bytes is " + std::to_string(options.memory_bytes) + ", multiples of 4 from 4 on are legal");
    const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    if (options.memory_file_offset % page != 0)
      refuse("memory_file_offset is no multiple of the page size " + std::to_string(page));
    constexpr auto most = static_cast<std::uint64_t>(std::numeric_limits<off_t>::max());
    if (options.memory_file_offset > most || options.memory_bytes > most - options.memory_file_offset ||
        options.memory_bytes > std::numeric_limits<std::size_t>::max()) {
      refuse("the memory ends beyond what a file can have");
    }
    if (options.poll.count() < 0) refuse("poll is negative");
    return options;
  }

  volatile std::uint32_t* memory_at(std::uint64_t address, std::uint64_t bytes) const {
    if (address < options_.memory_base) {
      throw std::runtime_error("uio: address " + std::to_string(address) + " is before the memory, which begins at " +
                               std::to_string(options_.memory_base));
    }
    return memory_.at(address - options_.memory_base, bytes);
  }

  UioOptions options_;
  File register_file_;
  Words registers_;
  Words memory_;  // its file may be closed
  std::optional<UioInterrupt> interrupt_;
};

}  // namespace

std::unique_ptr<Machine> open_uio_machine(const UioOptions& options) { return std::make_unique<UioMachine>(options); }

std::unique_ptr<Device> open_uio_device(const UioOptions& options, ChipDriverOptions driver) {
  driver.memory_base = options.memory_base;
  driver.memory_bytes = options.memory_bytes;
  return make_chip_device(open_chip(open_uio_machine(options), driver));
}

}  // namespace cchip
