# SPDX-License-Identifier: Apache-2.0
"""Tools that the tests run."""
import os
import re
import subprocess


def tool(name):
    """The command that the environment variable of this name in capitals holds, or else the name."""
    return os.environ.get(name.upper(), name)


def run(*command, **options):
    """Exit code and all that the command printed, standard error included, without the time and size that Verilators
    newer than Debian's report at their end. Bound: 300 s."""
    result = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            text=True, timeout=300, **options)
    return result.returncode, re.sub(r"(?m)^- (V e r i l a t i o n|Verilator:) .*\n", "", result.stdout)
