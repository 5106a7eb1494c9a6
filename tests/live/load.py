"""Processes that take all the processor time that they get."""

from __future__ import annotations

import os
import subprocess
import sys
from contextlib import contextmanager

__all__ = ["load"]


@contextmanager
def load():
    """Keep each processor busy twice. The processes end by themselves if nobody ends them."""
    code = "import time\nend = time.monotonic() + 120\nwhile time.monotonic() < end: pass"
    count = 2 * (os.cpu_count() or 1)
    busy = [subprocess.Popen([sys.executable, "-c", code]) for _ in range(count)]
    try:
        yield
    finally:
        for each in busy:
            each.kill()
            each.wait()
