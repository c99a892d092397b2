#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The generated register blocks, headers and pages are up to date, gen_registers.py --check notices when they are not,
and what is no SystemRDL, or cannot be built, is refused.

usage: test_registers.py [Staleness | Errors]
Exit code 77, skipped, where systemrdl-compiler is missing (make venv)."""
import sys
import unittest

import staleness


class Copy(staleness.GeneratorCopy):
    generator = "scripts/gen_registers.py"
    source = "rtl/regs/cchip_subsystem.rdl"
    common = "rtl/regs/cchip_common.rdl"
    chip = "rtl/regs/cchip_chip.rdl"
    more = [common, chip]
    of_subsystem = ["rtl/regs/cchip_subsystem_regs.v", "cpp_ref/include/cchip/internal/wire/registers.hpp",
                    "docs/hardware/registers.md"]
    of_chip = ["rtl/regs/cchip_chip_regs.v", "cpp_ref/include/cchip/internal/wire/chip_registers.hpp",
               "docs/hardware/chip-registers.md"]
    generated = of_subsystem + of_chip


class Staleness(staleness.StalenessTests, Copy):
    def test_changed_address(self):
        self.change("@ 0x084", "@ 0x094")
        self.assert_stale(self.of_subsystem)

    def test_changed_address_of_the_other_map(self):
        self.change("@ 0x0A8", "@ 0x0AC", self.chip)
        self.assert_stale(self.of_chip)

    def test_changed_common_part(self):
        self.change("major_number[15:8] = 2", "major_number[15:8] = 3", self.common)
        self.assert_stale(self.generated)


class Errors(Copy):
    def refused(self, old, new, message, name=None):
        self.change(old, new, name)
        code, lines = self.generate(self.root)
        self.assertEqual(code, 1)
        self.assertIn(message, "\n".join(lines))

    def test_two_registers_at_one_address(self):
        self.refused("@ 0x084", "@ 0x080", "overlaps with")

    def test_overlapping_fields(self):
        self.refused("slots[7:0]", "slots[8:0]", "overlaps with")

    def test_property_that_is_not_built(self):
        self.refused("singlepulse", "swmod", "swmod is not built here")

    def test_combination(self):
        self.refused("sw = r; hw = na;", "sw = w; hw = na;", "not built here", self.common)

    def test_reset_value_too_large(self):
        self.refused("minor_number[7:0] = 0", "minor_number[7:0] = 256", "reset value", self.common)

    def test_accesses_wider_than_the_bus(self):
        self.refused("accesswidth = 32;", "accesswidth = 64;", "accesswidth must be 32", self.common)

    def test_name_that_is_not_that_of_the_file(self):
        self.refused("addrmap cchip_chip {", "addrmap chip {", "must be called cchip_chip", self.chip)

    def test_error_names_its_file(self):
        self.refused("swaps[16:16]", "swaps[10:10]", "cchip_chip.rdl: ", self.chip)

    def test_no_reset_value(self):
        self.refused("scheduler_enable[0:0] = 0", "scheduler_enable[0:0]", "needs a reset value")

    def test_array_of_two_dimensions(self):
        self.refused("slot_status[4] @ 0x040 += 0x4", "slot_status[2][2] @ 0x040 += 0x4", "one dimension")

    def test_64_bits_that_are_not_external(self):
        self.refused("external swap_pairs", "swap_pairs", "64 bits only where external")

    def test_broken_syntax(self):
        self.refused("addrmap cchip_subsystem {", "addrmap cchip_subsystem (", "not SystemRDL")


if __name__ == "__main__":
    if Copy.generate(staleness.ROOT, "--check")[0] == 77:
        print("skipped: systemrdl-compiler is not installed (make venv)")
        sys.exit(77)
    unittest.main(verbosity=2)
