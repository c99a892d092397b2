// SPDX-License-Identifier: Apache-2.0
// cchip_table1: Table 1 of the paper from a timed simulation.
#include <CLI/CLI.hpp>
#include <cchip/program/command_line.hpp>
#include <cchip/program/output_file.hpp>
#include <iostream>
#include <optional>
#include <systemc>

#include "report.hpp"

int sc_main(int argc, char** argv) {
  CLI::App app(
      "Run times of collision queries with reconfiguration: Table 1 of the paper from a timed simulation,\n"
      "and the overhead of reconfiguration against the work per swap.",
      "cchip_table1");
  std::uint64_t data_bits = 8'388'608;
  std::string csv;
  constexpr cchip::WholeRange data_range = {0, std::uint64_t{1} << 40};
  cchip::add_whole(app, "--data-bits", data_bits, "data of an object pair on the bus; the paper does not say",
                   data_range)
      ->default_str(std::to_string(data_bits));
  cchip::add_text(app, "--csv", csv, "file for the overhead curves");
  app.footer("Exit codes: 0 done, 1 a file cannot be written or the simulation failed, 2 bad arguments");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const cchip::UsageError& error) {
    std::cerr << "cchip_table1: " << error.what() << '\n';
    return 2;
  }
  try {
    std::optional<cchip::sim::OutputFile> file;
    if (!csv.empty()) file.emplace(csv);
    const cchip::table1::Figures figures = cchip::table1::run_experiments(data_bits);
    cchip::table1::print_report(figures, std::cout);
    if (file) {
      cchip::table1::write_csv(figures, file->stream());
      file->commit();
    }
  } catch (const std::invalid_argument& error) {
    std::cerr << "cchip_table1: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "cchip_table1: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
