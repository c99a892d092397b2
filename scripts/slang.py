# SPDX-License-Identifier: Apache-2.0
"""slang's own command line from its Python package (make venv), quiet if there is nothing to say.

usage: slang.py OPTION... FILE...
Exit codes: 0 no error (there may be warnings), 1 errors."""
import shlex
import sys

from pyslang.driver import Driver

driver = Driver()
driver.addStandardArgs()
done = (driver.parseCommandLine(shlex.join(["slang", *sys.argv[1:]])) and driver.processOptions()
        and driver.parseAllSources() and driver.runFullCompilation(quiet=True))
sys.exit(0 if done else 1)
