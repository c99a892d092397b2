// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_pr_config_memory.hpp>

#include "reconfig_tools.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_pr_config_memory: every clock like a judge of the whole payload, good and bad ones",
                        "[unit][cchip_pr_config_memory]", cchip_pr_config_memory_configs) {
  constexpr int port_bytes = TestType::CFG_W / 8;
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    ConfigMemoryModel model(TestType::SLOT_ID, TestType::RM_ID, port_bytes, TestType::KINDS);
    const auto clock = [&](bool valid, std::uint32_t word) {
      top.cfg_valid = valid ? 1 : 0;
      sim::set_bits(top.cfg_data, 0, TestType::CFG_W, word);
      simulation.settle();
      REQUIRE((top.garbage != 0) == model.garbage());
      if (!model.garbage()) REQUIRE(int{top.select} == model.select());
      if (valid) model.write(word);
      simulation.rise();
    };
    std::vector<int> seen(faults);
    std::vector<int> garbage_after(faults);
    std::vector<int> modules(TestType::KINDS + 1);
    for (int transfer = 0; transfer < 600; ++transfer) {
      const auto fault = static_cast<Fault>(chance(random, 40) ? 0 : random() % faults);
      const int module = static_cast<int>(random() % (TestType::KINDS + 1));
      const std::size_t length = 16 + 4 * (random() % 12);
      Bytes bytes = spoil(make_payload(TestType::SLOT_ID, module, length, random), fault, TestType::SLOT_ID, random);
      const bool before = model.garbage();
      const int former = model.select();
      for (std::size_t i = 0; i + port_bytes <= bytes.size(); i += port_bytes) {
        while (chance(random, 30)) clock(false, static_cast<std::uint32_t>(random()));
        clock(true, port_bytes == 1 ? bytes[i] : word_at(bytes, i));
      }
      clock(false, 0);
      const auto index = static_cast<std::size_t>(fault);
      ++seen[index];
      garbage_after[index] += model.garbage() ? 1 : 0;
      if (fault == Fault::none) {
        REQUIRE(int{top.select} == module);
        ++modules[static_cast<std::size_t>(module)];
      }
      if (fault == Fault::other_slot || fault == Fault::cut_sync) {  // leaves this slot as it is
        REQUIRE(model.garbage() == before);
        REQUIRE(model.select() == former);
      }
    }
    for (int fault = 0; fault < faults; ++fault) {
      const auto index = static_cast<std::size_t>(fault);
      INFO("fault " << fault);
      REQUIRE(seen[index] > 10);
      if (fault == static_cast<int>(Fault::none)) REQUIRE(garbage_after[index] == 0);
      if (fault != static_cast<int>(Fault::none) && fault != static_cast<int>(Fault::other_slot) &&
          fault != static_cast<int>(Fault::cut_sync)) {
        REQUIRE(garbage_after[index] == seen[index]);
      }
    }
    for (const int count : modules) REQUIRE(count > 10);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_pr_config_memory: at power-up RM_ID is in the slot, words without a name change nothing",
                        "[unit][cchip_pr_config_memory]", cchip_pr_config_memory_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    for (int i = 0; i < 500; ++i) {
      top.cfg_valid = 1;
      sim::set_bits(top.cfg_data, 0, TestType::CFG_W, random() & 0x7FFFFF7F);  // no byte 0xAA
      simulation.settle();
      REQUIRE(top.garbage == 0);
      REQUIRE(int{top.select} == TestType::RM_ID);
      simulation.rise();
    }
  });
}
