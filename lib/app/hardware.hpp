// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the simulated hardware adds to the command: of cchip it is in sim/commands; without it (CCHIP_SIMULATION=OFF)
/// there is none.
#ifndef CCHIP_APP_HARDWARE_HPP
#define CCHIP_APP_HARDWARE_HPP

#include <cchip/collide.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cli.hpp"

namespace CLI {
class App;
}

namespace cchip::app {

/// Runs a command whose options have been read; returns the exit code.
using Run = std::function<int(const Streams&)>;

/// A command of cchip. `add` puts it with its options into the command line.
struct Command {
  std::string name;
  std::function<Run(CLI::App&)> add;
};

struct ChipOptions {
  std::string trace_path;  ///< FST file, none if empty
  unsigned slots = 0;      ///< whose modules are exchanged at run time; 0: a static chip
  unsigned chips = 1;
};

struct Hardware {
  /// The simulated chip.
  /// \throws UsageError the waveform cannot be written
  std::function<std::unique_ptr<Device>(const ChipOptions&)> open_chip;
  unsigned most_chips = 1;
  std::vector<Command> commands;
};

/// Makes its devices known to open_device(), too. Null without it.
const Hardware* hardware();

/// What a cchip without the hardware refuses, and why. Of names that no cchip knows both are false.
bool is_hardware_command(const std::string& name);
bool is_hardware_device(const std::string& name);
extern const char* const without_hardware;

}  // namespace cchip::app

#endif
