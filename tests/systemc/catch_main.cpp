// SPDX-License-Identifier: Apache-2.0
// sc_main() of the tests with SystemC, compiled once. The kernel elaborates only once in a process. If several test
// cases are selected, each runs in its own process; a single one, which is what CTest asks for, runs here.
#define CATCH_CONFIG_RUNNER
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <string>
#include <systemc>

#include "../seed_printer.hpp"

namespace {

/// The argument that selects this test case only.
std::string exactly(const std::string& name) {
  std::string spec;
  for (const char c : name) {
    if (std::strchr("\\,[]\"*~", c) != nullptr) spec += '\\';
    spec += c;
  }
  return spec;
}

int run_in_child(Catch::Session& session, const std::string& name) {
  std::cout.flush();
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) {
    std::perror("fork");
    return 1;
  }
  if (child == 0) {
    session.configData().testsOrTags = {exactly(name)};
    session.useConfigData(session.configData());
    const int failed = session.run();
    std::cout.flush();
    std::fflush(nullptr);
    _exit(failed == 0 ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return 0;
  std::cerr << "FAILED: " << name << (WIFSIGNALED(status) ? std::string(", ") + strsignal(WTERMSIG(status)) : "")
            << std::endl;
  return 1;
}

}  // namespace

int sc_main(int argc, char** argv) {
  Catch::Session session;
  if (const int wrong = session.applyCommandLine(argc, argv)) return wrong;
  const auto& data = session.configData();
  if (data.listTests || data.listTags || data.listReporters || data.listTestNamesOnly || data.showHelp) {
    return session.run();
  }
  const Catch::Config& config = session.config();
  const auto cases = Catch::filterTests(Catch::getAllTestCasesSorted(config), config.testSpec(), config);
  if (cases.size() <= 1) return session.run();
  int failed = 0;
  for (const auto& one : cases) failed += run_in_child(session, one.name);
  std::cout << cases.size() - static_cast<std::size_t>(failed) << " of " << cases.size() << " test cases passed"
            << std::endl;
  return failed == 0 ? 0 : 1;
}
