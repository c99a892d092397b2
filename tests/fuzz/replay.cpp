// SPDX-License-Identifier: Apache-2.0
// Feeds every file of a folder to a fuzz target: the regression without libFuzzer.
// usage: replay_<target> FOLDER
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <vector>

#include "require.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: " << argv[0] << " FOLDER\n";
    return 2;
  }
  std::size_t inputs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1])) {
    std::ifstream in(entry.path(), std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(in)), {});
    const std::vector<std::uint8_t> bytes(text.begin(), text.end());
    std::cout << entry.path().filename().string() << std::endl;  // the last line names the input of a crash
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    ++inputs;
  }
  std::cout << "inputs=" << inputs << '\n';
  return inputs > 0 ? 0 : 1;
}
