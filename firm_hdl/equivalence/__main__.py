"""``python -m firm_hdl.equivalence``: proofs for types that have every feature of a plan.

``make prove`` runs this. ``firm-hdl prove`` is the command for chosen types.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from firm_hdl.equivalence.command import run_proofs
from firm_hdl.equivalence.covering import covering_tasks, write_definitions
from firm_hdl.equivalence.proof import DEFAULT_TIMEOUT
from firm_hdl.terminal import printable_streams


@printable_streams()
def main(arguments: Sequence[str] | None = None) -> int:
    """Run the proofs; return 0 if all succeed."""
    parser = argparse.ArgumentParser(prog="python -m firm_hdl.equivalence", description=__doc__)
    parser.add_argument("--bus-bytes", type=int, default=8)
    parser.add_argument("--jobs", type=int, help="processes; default: one per processor")
    parser.add_argument("--timeout", type=float, default=DEFAULT_TIMEOUT)
    given = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory(prefix="firm-hdl-") as folder:
        write_definitions(Path(folder))
        tasks = covering_tasks(Path(folder), bus_bytes=given.bus_bytes, timeout=given.timeout)
        return run_proofs(tasks, given.jobs, bar=True)


if __name__ == "__main__":
    sys.exit(main())
