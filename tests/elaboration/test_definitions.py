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
    generated = ["rtl/include/cchip_defs.vh", "cpp_ref/include/cchip/wire/definitions.hpp", "docs/hardware/definitions.md"]

    def change_source(self, change):
        source = self.root / self.source
        data = json.loads(source.read_text())
        change(data)
        source.write_text(json.dumps(data))
        self.assert_stale(self.generated)

    def test_changed_constant(self):
        def change(data):
            data["constants"][0]["value"] += 1
        self.change_source(change)

    def test_changed_formula(self):
        def change(data):
            data["functions"][0]["expr"] += " + 1"
        self.change_source(change)


if __name__ == "__main__":
    unittest.main(verbosity=2)
