"""``firm-hdl verify``: the test systems, behind one set of arguments.

A test system is a line in :data:`SYSTEMS`: a function that gets the arguments, prints what it found
and says whether all is well.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence

from firm_hdl.errors import Diagnostic
from firm_hdl.export.build import BuildError
from firm_hdl.frontend import DEFAULT_DISTRO, DISTROS
from firm_hdl.plan import BUS_BYTES
from firm_hdl.verify.benches import run_benches
from firm_hdl.verify.executors import PROCESSES, ExecutorError, check_executor
from firm_hdl.verify.options import Options
from firm_hdl.verify.processes import unwound_when_terminated
from firm_hdl.verify.report.command import write_report
from firm_hdl.verify.results import ResultsError
from firm_hdl.verify.runner import Task, UnknownTypeError, collect_own, collect_tasks
from firm_hdl.verify.simulators import SIMULATORS, SimulatorMissingError
from firm_hdl.verify.ts1 import ORACLES, run_ts1, selections_of
from firm_hdl.verify.ts2 import run_ts2
from firm_hdl.verify.ts3 import How, run_ts3

__all__ = ["SYSTEMS", "add_verify_arguments", "run_verify"]


def run_verify(given: argparse.Namespace) -> int:
    """Run the test systems that were asked for; return the exit status.

    Raises
    ------
    DefinitionError
        If a definition that is named cannot be used. Of all types, those that can are tested, and
        then the others are printed.
    """
    if bool(given.types) == given.all:
        given.refuse("name types, or all of them with --all")
    if given.report is not None and given.results is None:
        given.refuse("--report needs --results")
    if given.results is not None and "ts3" not in given.systems:
        given.refuse("--results are of ts3")
    given.problems = {}
    try:
        with unwound_when_terminated():
            # Each of them, whatever comes of the first.
            results = [SYSTEMS[name](given) for name in given.systems]
        if given.report is not None:
            write_report([given.results], given.report)
            print(f"wrote   {given.report}")
    except (
        BuildError,
        ExecutorError,
        ResultsError,
        SimulatorMissingError,
        UnknownTypeError,
    ) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    for problem in given.problems:
        print(problem, file=sys.stderr)
    return 0 if all(results) and not given.problems else 1


def _ts3(given: argparse.Namespace) -> bool:
    options = [
        Options(
            bus_bytes=bus_bytes,
            wire=given.wire,
            seed=given.seed,
            stalled=given.stalls,
            broken=given.broken,
            most_cases=given.cases,
            simulator=given.simulator,
            paths=tuple(given.path),
            vcd=given.vcd,
        )
        for bus_bytes in dict.fromkeys(given.bus_bytes or [8])
    ]
    how = How(
        jobs=given.jobs,
        executor=given.executor,
        results=given.results,
        share_circuits=given.share_circuits,
    )
    return run_ts3(_tasks(given), options, how)


def _bench(given: argparse.Namespace) -> bool:
    return run_benches(
        _tasks(given),
        paths=given.path,
        wire=given.wire,
        widths=given.bus_bytes or [8],
        jobs=given.jobs,
    )


def _ts1(given: argparse.Namespace) -> bool:
    selections = selections_of(
        given.distro, given.path, given.types, mutations=given.mutations, seed=given.seed
    )
    counts = [run_ts1(each, given.oracle, given.jobs) for each in selections]
    return not any(counts)


def _ts2(given: argparse.Namespace) -> bool:
    return run_ts2(
        _tasks(given),
        paths=given.path,
        wire=given.wire,
        widths=given.bus_bytes or [8],
        golden=given.golden,
    )


SYSTEMS: dict[str, Callable[[argparse.Namespace], bool]] = {
    "ts1": _ts1,
    "ts2": _ts2,
    "ts3": _ts3,
    "bench": _bench,
}
"""By the name that ``--systems`` takes."""


def _tasks(given: argparse.Namespace) -> list[Task]:
    if given.path:
        # Of all types in a workspace, one that is wrong does not keep the others from being tested.
        problems: dict[str, Diagnostic] | None = given.problems if given.all else None
        distros = given.distro or [DEFAULT_DISTRO]
        return collect_own(distros, given.types, given.path, problems=problems)
    return collect_tasks(given.distro or (), given.types)


def add_verify_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command, all but how it is called."""
    parser.set_defaults(refuse=parser.error)
    parser.add_argument("types", nargs="*", metavar="TYPE", help="such as sensor_msgs/msg/Imu")
    parser.add_argument(
        "--all", action="store_true", help="all types; with --path, all in those folders"
    )
    parser.add_argument(
        "--distro",
        action="append",
        choices=list(DISTROS),
        help=f"repeatable; default: all that have the type, or {DEFAULT_DISTRO} with --path",
    )
    parser.add_argument(
        "--path",
        action="append",
        default=[],
        metavar="DIR",
        help="folder with ROS packages, searched before the distribution's types; repeatable",
    )
    parser.add_argument(
        "--systems",
        type=_systems,
        default=["ts3"],
        metavar="NAME,...",
        help=f"test systems: {', '.join(SYSTEMS)}; default: ts3",
    )
    parser.add_argument("--wire", choices=["ros1", "cdr"], help="default: the distribution's own")
    parser.add_argument(
        "--bus-bytes",
        type=int,
        action="append",
        choices=BUS_BYTES,
        metavar="N",
        help=f"bytes per beat: {', '.join(map(str, BUS_BYTES))}; repeatable; default: 8",
    )
    parser.add_argument("--seed", type=int, default=0, metavar="S", help="default: %(default)s")
    parser.add_argument(
        "--jobs", type=_positive, metavar="N", help="processes; default: one per processor"
    )
    _add_ts1(parser.add_argument_group("options of ts1"))
    ts2 = parser.add_argument_group("options of ts2")
    ts2.add_argument("--golden", metavar="DIR", help="compare with the golden plans there, too")
    ts3 = parser.add_argument_group("options of ts3")
    _add_cases(ts3)
    _add_results(ts3)


def _add_ts1(group: argparse._ArgumentGroup) -> None:
    group.add_argument(
        "--oracle",
        action="append",
        default=[],
        choices=list(ORACLES),
        help="whom to ask; repeatable; default: all that are here",
    )
    group.add_argument(
        "--mutations",
        type=_positive,
        default=0,
        metavar="N",
        help="judge N texts with small mistakes, made from the types' own, instead of these",
    )


def _add_cases(group: argparse._ArgumentGroup) -> None:
    group.add_argument(
        "--simulator",
        choices=["python", *SIMULATORS],
        default="python",
        help="replay everything in this one as well; default: %(default)s",
    )
    group.add_argument(
        "--cases", type=_positive, metavar="N", help="most cases per type; default: all"
    )
    group.add_argument(
        "--no-stalls", dest="stalls", action="store_false", help="do not run with stalls"
    )
    group.add_argument(
        "--no-broken", dest="broken", action="store_false", help="do not run damaged packets"
    )


def _add_results(group: argparse._ArgumentGroup) -> None:
    group.add_argument(
        "--results",
        metavar="FILE",
        help="write results there as JSON lines; a run that was stopped goes on with its file",
    )
    group.add_argument(
        "--report",
        metavar="FILE",
        help="write a report of the results: FILE.html, FILE.md or FILE.json",
    )
    group.add_argument(
        "--executor",
        type=_executor,
        default=PROCESSES,
        metavar="NAME",
        help=f"{PROCESSES}, or dask://HOST:PORT for a cluster; default: %(default)s",
    )
    group.add_argument(
        "--share-circuits",
        action="store_true",
        help="simulate types whose circuits are the same once",
    )
    group.add_argument("--vcd", metavar="DIR", help="write the waveform of each run there")


def _executor(text: str) -> str:
    try:
        return check_executor(text)
    except ExecutorError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def _systems(text: str) -> Sequence[str]:
    names = list(dict.fromkeys(text.split(",")))
    for name in names:
        if name not in SYSTEMS:
            raise argparse.ArgumentTypeError(
                f"no test system {name!r}; there are {', '.join(SYSTEMS)}"
            )
    return names


def _positive(text: str) -> int:
    try:
        number = int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number") from None
    if number < 1:
        raise argparse.ArgumentTypeError(f"must be at least 1, not {number}")
    return number
