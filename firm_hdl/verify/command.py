"""``firm-hdl verify``: the test systems, behind one set of arguments.

A test system is a line in :data:`SYSTEMS`: a function that makes it of the arguments. What each of
them finds out goes to one file of results, which says first what all of them are to test.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from contextlib import ExitStack

from firm_hdl.errors import Diagnostic
from firm_hdl.export.build import BuildError
from firm_hdl.frontend import DEFAULT_DISTRO, DISTROS
from firm_hdl.frontend.search import workspace_folders
from firm_hdl.jobs.executors import PROCESSES, ExecutorError, check_executor
from firm_hdl.jobs.processes import unwound_when_terminated
from firm_hdl.jobs.programs import ProgramMissingError
from firm_hdl.plan import BUS_BYTES
from firm_hdl.verify.bench.system import Benches
from firm_hdl.verify.clients.arguments import (
    add_sut_arguments,
    check_sut,
    references_of,
    sut_options,
)
from firm_hdl.verify.clients.command import run_sut
from firm_hdl.verify.references.client import ClientMissingError
from firm_hdl.verify.report.command import write_report
from firm_hdl.verify.results.environment import code_digest, environment, inputs_digest
from firm_hdl.verify.results.file import ResultsError, ResultsWriter
from firm_hdl.verify.simulators import SIMULATORS
from firm_hdl.verify.systems.ending import concluded, is_well
from firm_hdl.verify.systems.system import Judged, Recorder, System
from firm_hdl.verify.systems.tasks import Task, UnknownTypeError, collect_own, collect_tasks
from firm_hdl.verify.ts1 import ORACLES, Ts1, selections_of
from firm_hdl.verify.ts2.system import Ts2, Ts2Options
from firm_hdl.verify.ts3.options import LONGEST, Options
from firm_hdl.verify.ts3.replay_command import (
    add_replay_arguments,
    check_replay,
    collect_recorded,
)
from firm_hdl.verify.ts3.system import How, Ts3

__all__ = ["SYSTEMS", "add_verify_arguments", "run_verify"]


def run_verify(given: argparse.Namespace) -> int:
    """Run the test systems that were asked for; return the exit status.

    Raises
    ------
    DefinitionError
        If a definition that is named cannot be used. Of all types, those that can are tested, and
        then the others are printed.
    """
    check_replay(given)
    check_sut(given)
    if bool(given.types) == given.all:
        given.refuse("name types, or all of them with --all")
    if given.report is not None and given.results is None:
        given.refuse("--report needs --results")
    if given.depends and not given.path:
        given.refuse("--depends needs --path")
    given.path = [*given.path, *given.depends]
    given.problems = {}
    given.tasks = None
    try:
        _search_workspace(given)
        with unwound_when_terminated():
            if given.sut:
                found = run_sut(_tasks(given), sut_options(given), given.jobs)
            else:
                found = _run_systems(given)
        # Changed texts are nobody's by name.
        is_named = not given.all and not given.mutations
        for line in concluded(found, is_named=is_named):
            print(line)
        if given.report is not None:
            write_report([given.results], given.report)
            print(f"wrote   {given.report}")
    except (
        BuildError,
        ClientMissingError,
        ExecutorError,
        ResultsError,
        ProgramMissingError,
        UnknownTypeError,
    ) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    for problem in given.problems:
        print(problem, file=sys.stderr)
    return 0 if is_well(found, is_named=is_named) and not given.problems else 1


def _search_workspace(given: argparse.Namespace) -> None:
    """Have types that no distribution has looked up in the active workspace, as if by ``--path``.

    TS1 alone does so anyway.
    """
    if not given.types or given.path or given.bag or (given.systems == ["ts1"] and not given.sut):
        return
    try:
        _tasks(given)
    except UnknownTypeError:
        packages = {name.partition("/")[0] for name in given.types}
        distros = given.distro or [DEFAULT_DISTRO]
        given.path = [f for distro in distros for f in workspace_folders(distro, packages)]
        if not given.path:
            # Some of the types may be there.
            given.tasks = collect_tasks(given.distro or (), given.types, problems=given.problems)


def _run_systems(given: argparse.Namespace) -> list[Judged]:
    """Run the test systems; return what came of all tests."""
    with ExitStack() as stack:
        systems = [SYSTEMS[name](given) for name in given.systems]
        for system in systems:
            stack.enter_context(system)
        writer = None
        if given.results is not None:
            writer = stack.enter_context(_writer(given, systems))
        # Each of them, whatever comes of the first.
        return [each for system in systems for each in system.run(Recorder(writer))]


def _writer(given: argparse.Namespace, systems: Sequence[System]) -> ResultsWriter:
    """Open the file of results, new or to be continued."""
    options = {
        "systems": [system.name for system in systems],
        "bus_bytes": _widths(given),
        "wire": given.wire,
        "paths": list(given.path),
        "code": code_digest(),
        "inputs": inputs_digest([*given.path, *given.bag, *filter(None, [given.golden])]),
    }
    for system in systems:
        options |= system.options
    more = {"executor": given.executor}
    if given.problems:
        # They are no tests of TS2 and of what follows, and nobody is to think that all is well.
        more["definitions that are refused"] = f"{len(given.problems)}: {min(given.problems)}"
    return ResultsWriter(
        given.results,
        options=options,
        planned=[test for system in systems for test in system.tests],
        session=environment(**more),
    )


def _ts3(given: argparse.Namespace) -> System:
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
            bags=tuple(given.bag),
            longest=given.max_message_bytes or LONGEST,
            references=references_of(given),
            vcd=given.vcd,
        )
        for bus_bytes in _widths(given)
    ]
    # Of a type that is named, people want to see a run, and of a recording its own messages.
    shares = given.all and not given.bag if given.share_circuits is None else given.share_circuits
    how = How(jobs=given.jobs, executor=given.executor, share_circuits=shares)
    return Ts3(_tasks(given), options, how)


def _bench(given: argparse.Namespace) -> System:
    return Benches(
        _tasks(given),
        paths=given.path,
        wire=given.wire,
        widths=_widths(given),
        jobs=given.jobs,
    )


def _ts1(given: argparse.Namespace) -> System:
    selections = selections_of(
        given.distro, given.path, given.types, mutations=given.mutations, seed=given.seed
    )
    return Ts1(selections, given.oracle, given.jobs)


def _ts2(given: argparse.Namespace) -> System:
    options = Ts2Options(
        paths=tuple(given.path),
        wire=given.wire,
        widths=tuple(_widths(given)),
        golden=given.golden,
    )
    return Ts2(_tasks(given), options, jobs=given.jobs, executor=given.executor)


SYSTEMS: dict[str, Callable[[argparse.Namespace], System]] = {
    "ts1": _ts1,
    "ts2": _ts2,
    "ts3": _ts3,
    "bench": _bench,
}
"""By the name that ``--systems`` takes."""


def _widths(given: argparse.Namespace) -> list[int]:
    return list(dict.fromkeys(given.bus_bytes or [8]))


def _tasks(given: argparse.Namespace) -> list[Task]:
    # The same for all test systems, and slow for thousands of types.
    if given.tasks is None:
        given.tasks = _collected(given)
    tasks: list[Task] = given.tasks
    return tasks


def _collected(given: argparse.Namespace) -> list[Task]:
    if given.bag:
        return collect_recorded(given)
    if given.path:
        # A type that is wrong does not keep the others from being tested.
        problems: dict[str, Diagnostic] = given.problems
        distros = given.distro or [DEFAULT_DISTRO]
        own = [path for path in given.path if path not in given.depends]
        return collect_own(distros, given.types, given.path, own=own, problems=problems)
    return collect_tasks(given.distro or (), given.types)


def add_verify_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command, all but how it is called."""
    parser.set_defaults(refuse=parser.error)
    parser.add_argument("types", nargs="*", metavar="TYPE", help="such as sensor_msgs/msg/Imu")
    parser.add_argument(
        "--all",
        action="store_true",
        help="all types; with --path, all in those folders; with --bag, all that have topics",
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
        "--depends",
        action="append",
        default=[],
        metavar="DIR",
        help="folder with ROS packages that those of --path need; no part of --all; repeatable",
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
    add_replay_arguments(parser.add_argument_group("options of ts3 with recordings"))
    add_sut_arguments(parser.add_argument_group("client libraries"), ts3)
    _add_results(parser.add_argument_group("results"))


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
        help="replay everything as well: the exported VHDL in ghdl, or the Verilog in iverilog or "
        "verilator; default: %(default)s",
    )
    group.add_argument(
        "--cases",
        type=_positive,
        metavar="N",
        help="most cases per type; default: all, of recordings some",
    )
    group.add_argument(
        "--no-stalls", dest="stalls", action="store_false", help="do not run with stalls"
    )
    group.add_argument(
        "--no-broken", dest="broken", action="store_false", help="do not run damaged packets"
    )
    group.add_argument(
        "--share-circuits",
        action=argparse.BooleanOptionalAction,
        help="simulate types whose circuits are the same once; default: with --all",
    )
    group.add_argument("--vcd", metavar="DIR", help="write the waveform of each run there")


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
        help=f"{PROCESSES}, or dask://HOST:PORT for a cluster that runs ts2 and ts3; "
        "default: %(default)s",
    )


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
