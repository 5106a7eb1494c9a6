"""``firm-hdl bench``: figures of converters on an FPGA, as a table and as JSON."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace

from firm_hdl.arguments import (
    add_jobs,
    add_types_or_all,
    add_wire,
    check_types_or_all,
    number_between,
    positive,
)
from firm_hdl.bench.compare import compared
from firm_hdl.bench.cycles import STATED
from firm_hdl.bench.devices import DEVICES
from firm_hdl.bench.results import Converted, Result, read_results, results_text
from firm_hdl.bench.run import BenchTask, run_tasks
from firm_hdl.bench.tables import head, row, summary
from firm_hdl.bench.tools import versions
from firm_hdl.files import write_file
from firm_hdl.frontend import all_names, load_all, open_library
from firm_hdl.plan import BUS_BYTES, DEFAULT_MAX_MESSAGE_BYTES, DIRECTIONS
from firm_hdl.terminal import stage

__all__ = ["NO_DEVICE", "add_bench", "bench_tasks", "run_bench"]

NO_DEVICE = "none"


def add_bench(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl bench``, besides the origins of definitions."""
    add_types_or_all(command)
    add_wire(command)
    command.add_argument(
        "--bus-bytes",
        type=int,
        choices=BUS_BYTES,
        action="append",
        metavar="N",
        help="bytes per beat; repeatable; default: 8",
    )
    command.add_argument(
        "--direction",
        choices=DIRECTIONS,
        action="append",
        help="which converter; default: both",
    )
    command.add_argument(
        "--device",
        choices=[*DEVICES, NO_DEVICE],
        default="ecp5",
        help=f"FPGA to map circuits to; {NO_DEVICE}: only simulate; default: %(default)s",
    )
    command.add_argument(
        "--seeds",
        type=_seeds,
        default=(1, 2, 3),
        metavar="N,N,...",
        help="seeds of nextpnr, one run each; empty: area only; default: 1,2,3",
    )
    command.add_argument(
        "--mapping",
        default="",
        metavar="COMMANDS",
        help="commands of Yosys before the mapping, such as 'scratchpad -set abc9.D 4000'",
    )
    _add_messages(command)
    _add_files(command)
    add_jobs(command)
    command.set_defaults(run=run_bench)


def _add_messages(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--messages",
        type=positive,
        default=STATED.count,
        metavar="N",
        help="messages to simulate; default: %(default)s",
    )
    command.add_argument(
        "--message-seed",
        type=lambda text: number_between(text, 0, None),
        default=STATED.seed,
        metavar="N",
        help="seed of their values; default: %(default)s",
    )


def _add_files(command: argparse.ArgumentParser) -> None:
    command.add_argument("--json", metavar="FILE", help="write the figures to a file")
    command.add_argument("--compare", metavar="FILE", help="compare with the figures in FILE")
    command.add_argument(
        "--threshold",
        type=float,
        default=2.0,
        metavar="PERCENT",
        help="smallest change to report; default: %(default)s",
    )
    command.add_argument(
        "--cache", metavar="DIR", help="keep figures there, and take those of unchanged circuits"
    )


def _seeds(text: str) -> tuple[int, ...]:
    return tuple(number_between(part, 0, (1 << 31) - 1) for part in text.split(",") if part)


def run_bench(given: argparse.Namespace) -> int:
    """Run the command; return 1 if a figure is missing, or worse than in the older file.

    Raises `DefinitionError` if a type is invalid. Raises `ProgramMissingError` if a tool is not
    installed. Nothing was measured. Raises `BenchError` if the older file cannot be read.
    """
    check_types_or_all(given)
    old = None if given.compare is None else read_results(given.compare)
    device = None if given.device == NO_DEVICE else DEVICES[given.device]
    tasks = bench_tasks(given)
    if device is not None:
        versions(device, with_placer=bool(given.seeds))
    print(head(device), flush=True)
    results: list[Result] = []
    for result in run_tasks(tasks, 1 if len(tasks) == 1 else given.jobs):
        results.append(result)
        stage("bench: converters", len(results), len(tasks))
        print(row(result, path=not given.all), flush=True)
    print(summary(results, tasks[0].stated if tasks else None))
    if given.json is not None:
        write_file(given.json, results_text(results))
    is_fine = bool(results) and not any(result.problem for result in results)
    if old is not None:
        text, is_no_worse = compared(old, results, given.threshold / 100)
        print(text)
        is_fine = is_fine and is_no_worse
    return 0 if is_fine else 1


def bench_tasks(given: argparse.Namespace) -> list[BenchTask]:
    """Return a task for each type, bus width and direction."""
    library = open_library(given.distro, given.path, given.bag, depends=given.depends)
    names = (
        all_names(given.distro, given.path, given.bag, depends=given.depends)
        if given.all
        else given.types
    )
    messages = load_all(library, names)
    stated = replace(STATED, count=given.messages, seed=given.message_seed)
    widths: Sequence[int] = given.bus_bytes or [8]
    return [
        BenchTask(
            converter=Converted(
                distro=library.distro,
                type=message.name,
                wire=given.wire or message.wire,
                bus_bytes=bus_bytes,
                max_message_bytes=DEFAULT_MAX_MESSAGE_BYTES,
                direction=direction,
            ),
            paths=tuple(given.path),
            bags=tuple(given.bag),
            depends=tuple(given.depends),
            device=None if given.device == NO_DEVICE else given.device,
            seeds=given.seeds,
            mapping=given.mapping,
            stated=stated,
            cache=given.cache,
        )
        for message in messages
        for bus_bytes in dict.fromkeys(widths)
        for direction in dict.fromkeys(given.direction or DIRECTIONS)
    ]
