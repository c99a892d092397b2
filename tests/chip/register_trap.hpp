// SPDX-License-Identifier: Apache-2.0
/// \file
/// Registers that a process has mapped from a file, served by functions: each access of the process faults, the handler
/// asks a function, and the processor executes the access alone. x86-64 Linux only.
#ifndef CCHIP_TESTS_REGISTER_TRAP_HPP
#define CCHIP_TESTS_REGISTER_TRAP_HPP

#include <fcntl.h>
#include <sys/mman.h>
#include <ucontext.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

namespace cchip::testing {

/// One at a time, and one thread accesses the registers. The functions run inside of a signal that the access itself
/// raises, where the process holds no lock; an exception of theirs ends the process, as a bus error of a board does.
class RegisterTrap {
 public:
  using Read = std::function<std::uint32_t(std::uint32_t offset)>;
  using Write = std::function<void(std::uint32_t offset, std::uint32_t value)>;

  /// From now on the mapping of this file that the process has is served. It outlives the trap.
  /// \throws std::runtime_error the process does not map this file, or does so twice
  RegisterTrap(const std::string& path, Read read, Write write) : read_(std::move(read)), write_(std::move(write)) {
    if (active_ != nullptr) throw std::runtime_error("another register trap is active");
    find(path);
    const int file = open(path.c_str(), O_RDWR | O_CLOEXEC);
    void* const words = mmap(nullptr, end_ - begin_, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    close(file);
    if (words == MAP_FAILED) throw std::runtime_error("cannot map " + path);
    words_ = static_cast<volatile std::uint32_t*>(words);
    active_ = this;
    struct sigaction action = {};
    action.sa_flags = SA_SIGINFO;
    action.sa_sigaction = [](int, siginfo_t* info, void* context) {
      active_->fault(reinterpret_cast<std::uintptr_t>(info->si_addr), *static_cast<ucontext_t*>(context));
    };
    sigaction(SIGSEGV, &action, &old_fault_);
    action.sa_sigaction = [](int, siginfo_t*, void* context) { active_->stepped(*static_cast<ucontext_t*>(context)); };
    sigaction(SIGTRAP, &action, &old_step_);
    protect(PROT_NONE);
  }
  ~RegisterTrap() {
    protect(PROT_READ | PROT_WRITE);
    sigaction(SIGSEGV, &old_fault_, nullptr);
    sigaction(SIGTRAP, &old_step_, nullptr);
    munmap(const_cast<std::uint32_t*>(words_), end_ - begin_);
    active_ = nullptr;
  }
  RegisterTrap(const RegisterTrap&) = delete;
  RegisterTrap& operator=(const RegisterTrap&) = delete;

  std::uint64_t reads() const { return reads_; }
  std::uint64_t writes() const { return writes_; }

 private:
  static constexpr greg_t single_step = 0x100;   // EFLAGS.TF
  static constexpr greg_t code_of_a_write = 2;   // bit of the code of a page fault
  static constexpr std::uintptr_t unmapped = 0;  // value of begin_

  void find(const std::string& path) {
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);) {
      if (line.size() < path.size() || line.compare(line.size() - path.size(), path.size(), path) != 0) continue;
      if (begin_ != unmapped) throw std::runtime_error(path + " is mapped twice");
      void* end = nullptr;
      char dash = 0;
      std::istringstream(line) >> mapping_ >> dash >> end;
      begin_ = reinterpret_cast<std::uintptr_t>(mapping_);
      end_ = reinterpret_cast<std::uintptr_t>(end);
    }
    if (begin_ == unmapped) throw std::runtime_error(path + " is not mapped");
  }

  void protect(int what) const { mprotect(mapping_, end_ - begin_, what); }

  template <class Action>
  static void or_die(const Action& action) {
    try {
      action();
    } catch (const std::exception& error) {
      std::fprintf(stderr, "register access: %s\n", error.what());
      std::abort();
    }
  }

  void fault(std::uintptr_t address, ucontext_t& context) {
    if (address < begin_ || address >= end_ || address % 4 != 0) {
      sigaction(SIGSEGV, &old_fault_, nullptr);  // the access faults again
      return;
    }
    offset_ = static_cast<std::uint32_t>(address - begin_);
    is_write_ = (context.uc_mcontext.gregs[REG_ERR] & code_of_a_write) != 0;
    if (!is_write_) {
      ++reads_;
      or_die([this] { words_[offset_ / 4] = read_(offset_); });
    }
    protect(PROT_READ | PROT_WRITE);
    context.uc_mcontext.gregs[REG_EFL] |= single_step;
  }

  /// After the access.
  void stepped(ucontext_t& context) {
    context.uc_mcontext.gregs[REG_EFL] &= ~single_step;
    protect(PROT_NONE);
    if (!is_write_) return;
    ++writes_;
    or_die([this] { write_(offset_, words_[offset_ / 4]); });
  }

  inline static RegisterTrap* active_ = nullptr;

  Read read_;
  Write write_;
  void* mapping_ = nullptr;  // of the process
  std::uintptr_t begin_ = unmapped, end_ = 0;
  volatile std::uint32_t* words_ = nullptr;  // the file once more, never protected
  struct sigaction old_fault_ = {}, old_step_ = {};
  std::uint32_t offset_ = 0;  // of the present access
  bool is_write_ = false;
  std::uint64_t reads_ = 0, writes_ = 0;
};

}  // namespace cchip::testing

#endif
