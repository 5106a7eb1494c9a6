"""``make -C lab fuzz-hardware``: random packets through exported circuits, and what comes."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TextIO

from firm_hdl.arguments import add_jobs, number_between, positive
from firm_hdl.errors import DefinitionError
from firm_hdl.jobs import run_each
from firm_hdl.jobs.processes import unwound_when_terminated
from firm_hdl.jobs.programs import ProgramMissingError
from firm_hdl.plan import BUS_BYTES
from firm_hdl.terminal import printable_streams, progress, stage
from lab.fuzz.build import find_tools
from lab.fuzz.circuits import CIRCUITS
from lab.fuzz.report import HEAD, failure_text, line, summary
from lab.fuzz.run import Failure, FuzzTask, Outcome, run_task
from lab.fuzz.types import BUS_BYTES as USUAL_BUS_BYTES
from lab.fuzz.types import TYPES, message_of

__all__ = ["main"]

PACKETS = 10_000
# Lengths that claim more take more cycles; some circuits have more.
_ROOM, _LARGE_ROOM, _ONE_IN = 512, 4096, 7
_MOST_NUMBER = (1 << 63) - 1


@printable_streams()
def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; return 0 if packets were sent and no rule was broken."""
    given = _parser().parse_args(arguments)
    tasks = _tasks(given)
    if given.list:
        for task in tasks:
            print(f"{task.type} --bus-bytes {task.bus_bytes} --room {task.room}")
        return 0
    try:
        find_tools()
        for name in dict.fromkeys(task.type for task in tasks):
            message_of(name)
    except DefinitionError as error:
        print(error, file=sys.stderr)
        return 1
    except ProgramMissingError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    with unwound_when_terminated(), ExitStack() as stack:
        results = None
        if given.results:
            given.results.parent.mkdir(parents=True, exist_ok=True)
            results = stack.enter_context(given.results.open("a", encoding="utf-8"))
        outcomes = _run(tasks, given.jobs, results)
    print(summary(outcomes))
    if sum(outcome.packets for outcome in outcomes) == 0:
        print("error: no packet was sent", file=sys.stderr)
        return 1
    return int(any(outcome.failures for outcome in outcomes))


def _run(tasks: Sequence[FuzzTask], jobs: int | None, results: TextIO | None) -> list[Outcome]:
    outcomes: list[Outcome] = []
    print(HEAD)
    with progress("fuzzing"):
        work = [(task, (task,)) for task in tasks]
        for task, result in run_each(run_task, work, jobs=1 if len(tasks) == 1 else jobs):
            if isinstance(result, Exception):
                failure = Failure(rule=f"the process failed: {result!r}")
                wire = message_of(task.type).wire
                result = Outcome(task=task, wire=wire, failures=(failure,))
            outcomes.append(result)
            if results is not None:
                results.write(json.dumps(result.as_json()) + "\n")
                results.flush()
            print(line(result), flush=True)
            for failure in result.failures:
                print(failure_text(result, failure), flush=True)
            stage("fuzzing: circuit sets", len(outcomes), len(tasks))
    return outcomes


def _tasks(given: argparse.Namespace) -> list[FuzzTask]:
    """List the tasks such that the first ones have all types, and all widths of the bus."""
    types = given.types or TYPES
    widths = given.bus_bytes or USUAL_BUS_BYTES
    tasks: list[FuzzTask] = []
    for turn in range(len(widths)):
        for index, name in enumerate(types):
            large = len(tasks) % _ONE_IN == _ONE_IN - 1
            tasks.append(
                FuzzTask(
                    type=name,
                    bus_bytes=widths[(index + turn) % len(widths)],
                    room=given.room or (_LARGE_ROOM if large else _ROOM),
                    seed=given.seed,
                    packets=given.packets if given.only_packet is None else 1,
                    first=given.only_packet or 0,
                    circuits=tuple(given.circuits or CIRCUITS),
                )
            )
    return tasks


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m lab.fuzz", description=__doc__)
    parser.add_argument(
        "--types", nargs="+", metavar="TYPE", help=f"default: a standard set of {len(TYPES)}"
    )
    parser.add_argument(
        "--bus-bytes",
        nargs="+",
        type=int,
        choices=BUS_BYTES,
        metavar="N",
        help=f"default: {' '.join(map(str, sorted(USUAL_BUS_BYTES)))}",
    )
    parser.add_argument("--circuits", nargs="+", choices=CIRCUITS, help="default: all")
    parser.add_argument(
        "--packets",
        type=positive,
        default=PACKETS,
        metavar="N",
        help="for each circuit, rounded up to whole episodes; default: %(default)s",
    )
    parser.add_argument(
        "--room",
        type=positive,
        metavar="BYTES",
        help="how much longer than the shortest packet a message may be, and lengths may claim; "
        f"default: {_ROOM}, and {_LARGE_ROOM} for some",
    )
    number = _number
    parser.add_argument("--seed", type=number, default=1, metavar="N", help="default: %(default)s")
    parser.add_argument(
        "--only-packet", type=number, metavar="N", help="run the episode of this packet only"
    )
    add_jobs(parser)
    parser.add_argument(
        "--results", type=Path, metavar="FILE", help="append a line of JSON for each"
    )
    parser.add_argument("--list", action="store_true", help="print what would be run")
    return parser


def _number(text: str) -> int:
    return number_between(text, 0, _MOST_NUMBER)
