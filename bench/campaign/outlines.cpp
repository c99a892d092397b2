// SPDX-License-Identifier: Apache-2.0
// outlines <count> <seed>: random outlines of faces against the even-odd rule.
#include "outlines.hpp"

#include <cstdio>
#include <cstdlib>
#include <string>

int main(int argc, char** argv) {
  const std::uint64_t count = argc > 1 ? std::stoull(argv[1]) : 1000000;
  const std::uint64_t seed = argc > 2 ? std::stoull(argv[2]) : 1;
  cchip::outlines::Campaign campaign(seed);
  std::uint64_t wrong = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::string what = campaign.one();
    if (what.empty()) continue;
    if (++wrong <= 5)
      std::printf("outline %s: %s\n%s", std::to_string(i).c_str(), what.c_str(), campaign.obj().c_str());
  }
  std::printf("outlines=%s crossed=%s points=%s wrong=%s\n", std::to_string(campaign.outlines).c_str(),
              std::to_string(campaign.crossed).c_str(), std::to_string(campaign.points).c_str(),
              std::to_string(wrong).c_str());
  return wrong == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
