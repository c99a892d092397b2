// SPDX-License-Identifier: Apache-2.0
/// \file
/// What can go wrong in a simulation. All are SimulationError; Simulation adds the clock, the seed and the wave to the
/// message as the exception passes through it.
#ifndef CCHIP_SIM_ERRORS_HPP
#define CCHIP_SIM_ERRORS_HPP

#include <stdexcept>
#include <string>
#include <utility>

namespace cchip::sim {

class SimulationError : public std::exception {
 public:
  explicit SimulationError(std::string message) : message_(std::move(message)) {}
  const char* what() const noexcept override { return message_.c_str(); }
  void add_context(const std::string& context) { message_ += context; }

 private:
  std::string message_;
};

/// Something did not happen within its limit of clocks.
class SimulationTimeout : public SimulationError {
 public:
  using SimulationError::SimulationError;
};

/// An assertion in the RTL failed; its text is on standard output.
class AssertionFailure : public SimulationError {
 public:
  using SimulationError::SimulationError;
};

/// A valid/ready stream broke its rules.
class StreamError : public SimulationError {
 public:
  using SimulationError::SimulationError;
};

/// A result is wrong, missing, unexpected or repeated.
class ScoreboardError : public SimulationError {
 public:
  using SimulationError::SimulationError;
};

/// For checks in the body of with_wave_on_failure().
/// \throws SimulationError if the condition is false
inline void require(bool condition, const std::string& message) {
  if (!condition) throw SimulationError(message);
}

}  // namespace cchip::sim

#endif
