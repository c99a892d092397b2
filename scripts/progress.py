# SPDX-License-Identifier: Apache-2.0
"""One line on standard error with a bar, a count and an estimate of the time left; silent unless that is a terminal.
The twin of lib/app/progress.cpp for scripts."""
import sys
import threading
import time


def duration(seconds):
    """'3 s', '12 min', '2.5 h'."""
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"


class Progress:
    """Counts jobs, of which there are `total`; more may be announced by raising `total`. Any thread may call it."""

    def __init__(self, total, unit, out=sys.stderr):
        self.total, self.unit, self.out = total, unit, out
        self.done = 0
        self.start = time.monotonic()
        self.lock = threading.Lock()
        self.enabled = out.isatty()

    def __enter__(self):
        self.draw()
        return self

    def __exit__(self, *_):
        with self.lock:
            self.clear()
            self.enabled = False

    def counted(self, function):
        """The same function; each call counts when it ends, however it ends."""
        def call(*arguments):
            try:
                return function(*arguments)
            finally:
                with self.lock:
                    self.done += 1
                    self.draw()
        return call

    def say(self, text, file=None):
        """Prints a line above the bar, on standard output unless told otherwise."""
        with self.lock:
            self.clear()
            print(text, file=file or sys.stdout, flush=True)
            self.draw()

    def clear(self):
        if self.enabled:
            print("\r\x1b[K", end="", file=self.out, flush=True)

    def draw(self):
        if not self.enabled or self.total == 0:
            return
        fraction = min(self.done / self.total, 1)
        left = f", {duration((time.monotonic() - self.start) * (1 - fraction) / fraction)} left" if fraction > 0 else ""
        print(f"\r\x1b[K[{'#' * int(40 * fraction):<40}] {100 * fraction:3.0f} %  {self.done} of {self.total} "
              f"{self.unit}{left}",
              end="", file=self.out, flush=True)
