// SPDX-License-Identifier: Apache-2.0
/// \file
/// What all simulations of a program reached of the RTL's lines and toggles, in a build with CCHIP_COVERAGE.
#ifndef CCHIP_SIM_COVERAGE_HPP
#define CCHIP_SIM_COVERAGE_HPP

#include <verilated.h>
#if VM_COVERAGE
#include <unistd.h>
#include <verilated_cov.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <string>
#include <unordered_map>
#endif

namespace cchip::sim {

#if VM_COVERAGE
/// Counts of this program by point of the sources: those of all instances of a module are one, but for bins. Written
/// when the program ends to a file of the folder CCHIP_COVERAGE_FOLDER, in Verilator's format.
class Coverage {
 public:
  static Coverage& of_program() {
    static Coverage coverage;
    return coverage;
  }

  /// Takes the counts of a simulation over.
  void add(VerilatedContext& context) {
    for_each_point(context, [this](const std::string& point, std::uint64_t count) { counts_[point] += count; });
  }
  /// Leaves out what has toggled so far: flip-flops that begin with a random value change when they are reset.
  void forget_toggles(VerilatedContext& context) {
    for_each_point(context, [this](const std::string& point, std::uint64_t count) {
      if (point.find("\1page\2v_toggle") != std::string::npos) counts_[point] -= count;  // add() adds them
    });
  }

  Coverage(const Coverage&) = delete;
  Coverage& operator=(const Coverage&) = delete;

 private:
  Coverage() {
    if (folder_ != nullptr) std::filesystem::create_directories(folder_);
  }
  ~Coverage() {
    if (counts_.empty()) return;
    std::ofstream out(file(".dat"));
    out << "# SystemC::Coverage-3\n";
    for (const auto& [point, count] : counts_) out << "C '" << point << "' " << count << '\n';
  }

  template <class Take>
  void for_each_point(VerilatedContext& context, const Take& take) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (folder_ == nullptr) return;
    const std::string path = file(".part");
    context.coveragep()->forcePerInstance(true);
    context.coveragep()->write(path.c_str());
    std::ifstream in(path);
    std::string line;
    while (std::getline(in, line)) {  // C '...<1>h<2>instance' count
      const std::size_t count = line.rfind(' ');
      if (line.compare(0, 2, "C ") != 0 || count == std::string::npos) continue;
      const bool bin = line.find("\1page\2v_user") != std::string::npos;  // told apart by their instances
      const std::size_t instance = bin ? std::string::npos : line.find("\1h\2");
      take(line.substr(3, (instance == std::string::npos ? count - 1 : instance) - 3),
           std::stoull(line.substr(count + 1)));
    }
    std::filesystem::remove(path);
  }

  std::string file(const char* ending) const {
    return std::string(folder_) + "/" + std::to_string(::getpid()) + ending;
  }

  const char* folder_ = std::getenv("CCHIP_COVERAGE_FOLDER");
  std::mutex mutex_;
  std::unordered_map<std::string, std::uint64_t> counts_;
};
inline void count_coverage(VerilatedContext& context) { Coverage::of_program().add(context); }
inline void forget_toggles(VerilatedContext& context) { Coverage::of_program().forget_toggles(context); }
#else
inline void count_coverage(VerilatedContext&) {}
inline void forget_toggles(VerilatedContext&) {}
#endif

}  // namespace cchip::sim

#endif
