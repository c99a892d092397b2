// SPDX-License-Identifier: Apache-2.0
/// What the benchmark programs have in common.
#ifndef CCHIP_BENCH_PROGRAM_HPP
#define CCHIP_BENCH_PROGRAM_HPP

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <exception>
#include <iostream>
#include <vector>

namespace cchip::bench {

/// The middle value; of an even number the upper middle one.
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Parses the arguments and runs. Exit codes: that of run(), 1 an exception, 2 bad arguments.
template <class Run>
int run_program(CLI::App& app, int argc, char** argv, Run run) {
  try {
    app.parse(argc, argv);
    return run();
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    std::cerr << app.get_name() << ": " << error.what() << '\n';
    return 1;
  }
}

}  // namespace cchip::bench

#endif  // CCHIP_BENCH_PROGRAM_HPP
