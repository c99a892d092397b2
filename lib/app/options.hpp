// SPDX-License-Identifier: Apache-2.0
/// \file
/// Options that several commands have.
#ifndef CCHIP_APP_OPTIONS_HPP
#define CCHIP_APP_OPTIONS_HPP

#include <CLI/CLI.hpp>
#include <cchip/program/command_line.hpp>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "row_writer.hpp"

namespace cchip::app {

/// Words of the command line and what they mean, in the order of the help text.
template <class Value>
using Choices = std::vector<std::pair<std::string, Value>>;

inline const Choices<Format> formats = {{"table", Format::table}, {"csv", Format::csv}, {"jsonl", Format::jsonl}};

inline constexpr WholeRange at_least_1 = {1, std::numeric_limits<std::uint64_t>::max()};

inline const std::string exit_codes =
    "Exit codes: 0 done, 1 internal error or the output cannot be written (check: a certificate is refused),\n"
    "2 wrong input or command line, 3 answers differ, 4 answered without faces that cannot be used,\n"
    "5 a contact (collide --exit-code).\n";

template <class Value>
CLI::Option* add_choice(CLI::App& command, const std::string& name, Value& value, const Choices<Value>& choices,
                        const std::string& description) {
  std::vector<std::string> words;
  for (const auto& choice : choices) words.push_back(choice.first);
  const auto choose = [&value, &choices](const std::string& word) {
    for (const auto& choice : choices) {
      if (choice.first == word) value = choice.second;
    }
  };
  return command.add_option_function<std::string>(name, choose, description)->check(CLI::IsMember(words));
}

/// How meshes are read.
template <class Options>
void add_reading(CLI::App& command, Options& options) {
  command.add_flag("--lenient", options.lenient,
                   "leave out faces that cannot be used, name them on standard error, and end with exit code 4");
  command.add_flag("--single", options.single,
                   "round the coordinates to single precision, so that parts from programs that round "
                   "and from others meet");
}

/// Two meshes, --lenient, and the option --pose, which is returned.
template <class Options>
CLI::Option* add_meshes(CLI::App& command, Options& options) {
  add_text(command, "A", options.file_a, "mesh that stays; - reads standard input")->required();
  add_text(command, "B", options.file_b, "mesh that is placed")->required();
  add_reading(command, options);
  return add_text(command, "--pose", options.pose,
                  "tx,ty,tz[,rx,ry,rz]: rotate B by degrees about x, then y, then z, then move it");
}

/// The trees of both meshes that certificates cite.
/// \returns the first, which needs the second, and the other way round
template <class Options>
CLI::Option* add_trees(CLI::App& command, Options& options) {
  auto* a =
      add_text(command, "--tree-a", options.tree_a, "tree of A, which cchip tree made: proofs that cite it are short");
  auto* b = add_text(command, "--tree-b", options.tree_b, "the same of B");
  b->needs(a);
  return a->needs(b);
}

}  // namespace cchip::app

#endif
