"""``python -m firm_hdl.equivalence``: proofs for types that have every feature of a plan.

``make prove`` runs this. ``firm-hdl prove`` is the command for chosen types.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from firm_hdl.arguments import add_bus_bytes, add_jobs
from firm_hdl.equivalence.command import add_timeout, run_proofs
from firm_hdl.equivalence.covering import covering_tasks, write_definitions
from firm_hdl.terminal import printable_streams, progress


@printable_streams()
def main(arguments: Sequence[str] | None = None) -> int:
    """Run the proofs; return 0 if all succeed."""
    parser = argparse.ArgumentParser(prog="python -m firm_hdl.equivalence", description=__doc__)
    add_bus_bytes(parser)
    add_jobs(parser)
    add_timeout(parser)
    given = parser.parse_args(arguments)
    with progress("prove"), tempfile.TemporaryDirectory(prefix="firm-hdl-") as folder:
        write_definitions(Path(folder))
        timeout = float(given.timeout)
        tasks = covering_tasks(Path(folder), bus_bytes=given.bus_bytes, timeout=timeout)
        return run_proofs(tasks, given.jobs, with_summary=True)


if __name__ == "__main__":
    sys.exit(main())
