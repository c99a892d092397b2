#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The generated definitions are up to date, and gen_definitions.py --check notices when they are not.

usage: test_definitions.py [Staleness]"""
import json
import unittest

import staleness


class Staleness(staleness.StalenessTests, staleness.GeneratorCopy):
    generator = "scripts/gen_definitions.py"
    source = "scripts/definitions.json"
    numbers = ["rtl/include/cchip_defs.vh", "cpp_ref/include/cchip/internal/wire/definitions.hpp"]
    names = "cpp_ref/include/cchip/internal/wire/code_names.hpp"
    page = "docs/hardware/definitions.md"
    generated = [*numbers, names, page]

    def change_source(self, change, stale):
        source = self.root / self.source
        data = json.loads(source.read_text())
        change(data)
        source.write_text(json.dumps(data))
        self.assert_stale(stale)

    def test_changed_constant(self):
        def change(data):
            data["constants"][0]["value"] += 1
        self.change_source(change, [*self.numbers, self.page])

    def test_changed_formula(self):
        def change(data):
            data["functions"][0]["expr"] += " + 1"
        self.change_source(change, [*self.numbers, self.page])

    def test_changed_name(self):
        def change(data):
            data["enums"][0]["values"][0]["name"] += "LY"
        self.change_source(change, self.generated)


if __name__ == "__main__":
    unittest.main(verbosity=2)
