"""The command of Yosys that the package ``pyosys`` does not have, with a few options.

The package has Yosys as a library for the processor. WebAssembly of YoWASP is compiled before its
first run, for two minutes of processor time; this library is not. `firm_hdl.jobs.programs` runs
this file, which imports nothing of firm-hdl.
"""

from __future__ import annotations

import argparse
import importlib
import os
import sys
from collections.abc import Sequence

__all__ = ["main"]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a script of Yosys, or print the version.

    After an error in a script, Yosys itself writes the error and ends the process with status 1.
    """
    parser = argparse.ArgumentParser(prog="native_yosys", allow_abbrev=False)
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("-V", action="store_true", dest="version", help="print the version")
    what.add_argument("-p", metavar="SCRIPT", dest="script", help="commands of Yosys")
    parser.add_argument("-q", action="store_true", dest="quiet", help="print errors alone")
    parser.add_argument("-l", metavar="FILE", dest="log", help="write the log to a file")
    options = parser.parse_args(arguments)
    yosys = importlib.import_module("pyosys.libyosys")
    if options.version:
        print(yosys.yosys_maybe_version())
        return 0
    # The library writes its log to the descriptor of standard output, and errors to that of errors.
    if options.log is not None or options.quiet:
        log = os.open(options.log or os.devnull, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o666)
        os.dup2(log, sys.stdout.fileno())
    yosys.run_pass(options.script)
    return 0


if __name__ == "__main__":
    sys.exit(main())
