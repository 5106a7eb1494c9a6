"""``python -m lab.bench.software TYPE...``: time rosbags, genpy and Fast CDR beside converters.

The libraries read and write the same messages for which the cycles of converters are counted.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import replace

from firm_hdl.arguments import add_origins, check_types_or_all
from firm_hdl.bench.command import NO_DEVICE, add_bench, bench_tasks
from firm_hdl.bench.run import run_tasks
from firm_hdl.errors import DefinitionError, UserError
from firm_hdl.plan import DIRECTIONS
from firm_hdl.terminal import printable_streams
from lab.bench.software import CLOCK_MHZ, compare_software, machine, software_rows

OF_CIRCUITS = ("json", "compare", "cache", "bus_bytes", "direction")
"""Options of ``firm-hdl bench`` that times of libraries do not have."""


@printable_streams()
def main(arguments: Sequence[str] | None = None) -> int:
    """Time libraries, and print which have no figure; return 1 if a converter has no figure."""
    parser = argparse.ArgumentParser(prog="python -m lab.bench.software", description=__doc__)
    add_origins(parser)
    add_bench(parser)
    given = parser.parse_args(arguments)
    for name in OF_CIRCUITS:
        if getattr(given, name) is not None:
            parser.error(f"times of libraries have no --{name.replace('_', '-')}")
    check_types_or_all(given)
    given.device = NO_DEVICE
    try:
        return _run(given)
    except DefinitionError as error:
        print(error, file=sys.stderr)
    except UserError as error:
        print(f"error: {error}", file=sys.stderr)
    return 1


def _run(given: argparse.Namespace) -> int:
    tasks = bench_tasks(given)
    results = {each.converter: each for each in run_tasks(tasks, given.jobs)}
    print(f"{machine()}; converters simulated, at {CLOCK_MHZ} MHz", software_rows(), sep="\n")
    for task in tasks:
        if task.converter.direction != DIRECTIONS[0]:
            continue
        same = [replace(task.converter, direction=each) for each in DIRECTIONS]
        found = compare_software(task, [results[each] for each in same])
        print(software_rows(found), flush=True)
        for name, why in found.missing.items():
            print(f"    {name}: {why}")
    problems = [f"{each.converter}: {each.problem}" for each in results.values() if each.problem]
    print(*problems, *(str(task.stated) for task in tasks[:1]), sep="\n")
    return 0 if tasks and not problems else 1


if __name__ == "__main__":
    sys.exit(main())
