"""``firm-hdl verify``: its arguments, the request that they make, and the types to test."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from firm_hdl.arguments import (
    add_depends,
    add_engine,
    add_jobs,
    add_json,
    add_path,
    add_types_or_all,
    add_wire,
    number_between,
    positive,
    seconds,
)
from firm_hdl.errors import Diagnostic
from firm_hdl.frontend import DEFAULT_DISTRO, DISTROS
from firm_hdl.frontend.search import workspace_folders
from firm_hdl.node import Description
from firm_hdl.plan import BUS_BYTES
from firm_hdl.terminal import stage
from firm_hdl.verify.board.description import described_board
from firm_hdl.verify.systems.options import (
    CLIENT_NAMES,
    LONGEST,
    MOST_MESSAGES,
    NO_REFERENCE,
    ORACLE_NAMES,
    SIMULATOR_NAMES,
    SYSTEM_NAMES,
    WRITER_NAMES,
    Request,
    option_of,
)
from firm_hdl.verify.systems.tasks import (
    TypeUnderTest,
    UnknownTypeError,
    collect_own,
    collect_tasks,
)

__all__ = ["Workload", "add_verify", "resolve", "run_verify"]

_USUAL_SYSTEMS = ("ts3",)

# Arguments that cannot be combined with ``--sut``.
_OTHERS = (
    *("bag", "bus_bytes", "golden", "oracle", "reference"),
    *("share_circuits", "simulator", "systems", "vcd"),
    *("board", "node", "write_node"),
)


def run_verify(given: argparse.Namespace) -> int:
    """Run what is asked for; return the exit status.

    Raises `DefinitionError` if a definition that is named cannot be used. Without names, the usable
    types are tested, and the errors in the others are printed at the end.
    """
    request = _request(given)
    stage("verify: reads definitions")
    # Report a type that cannot be used before simulators and oracles are imported.
    work = resolve(request)
    if given.write_node is not None:
        return _write_node(work, given.write_node)
    stage("verify: finds tools and libraries")
    from firm_hdl.verify.run import run_workload

    if not getattr(given, "as_json", False):
        return run_workload(work)
    given.document["errors"] += [each.facts() for each in work.problems.values()]
    with TemporaryDirectory(prefix="firm-hdl-") as folder:
        results = request.results or str(Path(folder, "results.jsonl"))
        status = run_workload(replace(work, request=replace(work.request, results=results)))
        given.document |= _facts(results)
    return status


def _facts(results: str) -> dict[str, Any]:
    """Return what is in a file of results, as values of JSON."""
    from firm_hdl.verify.report.summary import outcomes_of
    from firm_hdl.verify.results.file import read_results
    from firm_hdl.verify.results.verdict import Counts

    found = read_results(results)
    outcomes = outcomes_of([found])
    counts = Counts.of(each.verdict for each in outcomes)
    return {
        "verdict": "failed" if found.failure else counts.verdict,
        "failure": found.failure or None,
        "counts": asdict(counts),
        "tests": [
            {
                **asdict(each.test),
                "same": list(each.test.distros),
                "verdict": each.verdict.name,
                "cases": getattr(each.verdict, "cases", 0),
                "details": list(getattr(each.verdict, "details", ())),
            }
            for each in outcomes
        ],
    }


@dataclass(frozen=True, slots=True, kw_only=True)
class Workload:
    """A request and its types."""

    request: Request  # Its `paths` are the folders of the workspace if the types were found there.
    # The types that are tested; empty if only TS1 runs, which looks up the types itself.
    tasks: Sequence[TypeUnderTest]
    # Errors by their texts. Types without errors are tested nevertheless.
    problems: Mapping[str, Diagnostic]
    board: Description | None = None  # The node of the board, if there is one.


def resolve(request: Request) -> Workload:
    """Look up the types of a request.

    Named types that no distribution has are looked up in the active workspace, as with ``--path``.

    Raises `DefinitionError` if a definition that is named cannot be used. Raises `UnknownTypeError`
    if a type that is named does not exist. Raises `UserError` if the board or its node cannot be
    used.
    """
    problems: dict[str, Diagnostic] = {}
    if request.is_ts1_alone:
        return Workload(request=request, tasks=(), problems=problems)
    if request.node is not None:
        # The types are those of the node.
        node = described_board(request, ())
        return Workload(request=request, tasks=(), problems=problems, board=node)
    try:
        tasks = _collect(request, problems)
    except UnknownTypeError:
        # With `paths`, the workspace was searched, too, and what is missing is another error.
        if request.bags:
            raise
        if folders := _workspace(request):
            request = replace(request, paths=folders)
            tasks = _collect(request, problems)
        else:
            # Some of the types may exist: these are tested.
            tasks = collect_tasks(request.distros, request.types, problems=problems)
    board = None
    if request.board is not None:
        board = described_board(request, [task.name for task in tasks])
    return Workload(request=request, tasks=tasks, problems=problems, board=board)


def _collect(request: Request, problems: dict[str, Diagnostic]) -> list[TypeUnderTest]:
    """Return the types from where the request says; add errors to `problems`."""
    if request.bags:
        from firm_hdl.verify.ts3.replay import collect_recorded

        return collect_recorded(
            next(iter(request.distros), None),
            request.types,
            request.bags,
            wire=request.wire,
            problems=problems,
            depends=request.depends,
        )
    if request.paths:
        # An invalid type does not keep the others from being tested.
        return collect_own(
            request.distros or [DEFAULT_DISTRO],
            request.types,
            request.paths,
            depends=request.depends,
            problems=problems,
        )
    return collect_tasks(request.distros, request.types)


def _workspace(request: Request) -> tuple[str, ...]:
    """Return the folders of the active workspace with the packages of the named types."""
    packages = {name.partition("/")[0] for name in request.types}
    return tuple(
        folder
        for distro in request.distros or [DEFAULT_DISTRO]
        for folder in workspace_folders(distro, packages)
    )


def _request(given: argparse.Namespace) -> Request:
    """Check the arguments, and turn them into a request."""
    _check_replay(given)
    _check_libraries(given)
    _check_board(given)
    # Without named types, ``--bag`` means all types of the recordings.
    is_all = given.all or (bool(given.bag) and not given.types)
    if bool(given.types) == is_all and not (given.node and not is_all):
        given.usage_error("name types, or all of them with --all")
    if getattr(given, "as_json", False) and (given.sut or given.write_node):
        given.usage_error("--json is for test systems: not with --sut or --write-node")
    if given.report is not None and given.results is None:
        given.usage_error("--report needs --results")
    if given.depends and not (given.path or given.bag):
        given.usage_error("--depends needs --path or --bag")
    asked: dict[str, Any] = {
        each.name: getattr(given, option_of(each.name), None) for each in fields(Request)
    }
    # An option that repeats has a list, without repetitions; what is not given has its default.
    asked = {
        name: tuple(dict.fromkeys(value)) if isinstance(value, list | tuple) else value
        for name, value in asked.items()
        if value not in (None, [])
    }
    if given.reference:
        asked["references"] = tuple(name for name in asked["references"] if name != NO_REFERENCE)
    if given.board and not given.systems:
        asked["systems"] = ("board",)
    if (given.board is not None or given.write_node is not None) and not given.distro:
        # A node has one distribution.
        asked["distros"] = (DEFAULT_DISTRO,)
    return Request(**asked)


def _check_replay(given: argparse.Namespace) -> None:
    """Refuse arguments that cannot be combined with recordings, and the reverse."""
    if not given.bag:
        if given.max_message_bytes is not None:
            given.usage_error("--max-message-bytes needs --bag")
        return
    if given.path:
        given.usage_error("argument --bag: not allowed with argument --path")
    if set(given.systems or _USUAL_SYSTEMS) != {"ts3"}:
        given.usage_error("--bag requires --systems ts3")
    if given.sut:
        given.usage_error("--bag is for firm-hdl's own converters, not for --sut")
    if given.share_circuits:
        given.usage_error("--bag replays the messages of each type: not with --share-circuits")
    if len(given.distro or ()) > 1:
        given.usage_error("--bag takes one --distro")


def _check_libraries(given: argparse.Namespace) -> None:
    """Refuse arguments that cannot be combined with references or with libraries under test."""
    if NO_REFERENCE in given.reference and len(given.reference) > 1:
        given.usage_error(f"--reference {NO_REFERENCE} excludes other references")
    if not given.sut:
        return
    for name in _OTHERS:
        # The systems that run by default may also be named.
        if getattr(given, name) not in (given.default_of(name), _USUAL_SYSTEMS):
            given.usage_error(f"--{name.replace('_', '-')} does not go with --sut")
    if not (given.stalls and given.broken):
        given.usage_error("--no-stalls and --no-broken do not go with --sut")


def add_verify(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl verify``."""
    add_types_or_all(
        parser, "all types; with --path, all in those folders; with --bag, all that have topics"
    )
    parser.add_argument(
        "--distro",
        action="append",
        choices=list(DISTROS),
        help=f"repeatable; default: all that have the type, or {DEFAULT_DISTRO} with --path",
    )
    add_path(parser)
    add_depends(parser)
    parser.add_argument(
        "--systems",
        type=_systems,
        metavar="NAME,...",
        help=f"test systems: {', '.join(SYSTEM_NAMES)}; default: ts3, or board with --board",
    )
    add_wire(parser)
    parser.add_argument(
        "--bus-bytes",
        type=int,
        action="append",
        choices=BUS_BYTES,
        metavar="N",
        help=f"bytes per beat: {', '.join(map(str, BUS_BYTES))}; repeatable; default: 8",
    )
    parser.add_argument("--seed", type=int, default=0, metavar="S", help="default: %(default)s")
    add_jobs(parser)
    _add_ts1(parser.add_argument_group("options of ts1"))
    ts2 = parser.add_argument_group("options of ts2")
    ts2.add_argument("--golden", metavar="DIR", help="compare with the golden plans there, too")
    ts3 = parser.add_argument_group("options of ts3")
    _add_cases(ts3)
    _add_replay(parser.add_argument_group("options of ts3 with recordings"))
    _add_board(parser.add_argument_group("boards"))
    _add_libraries(parser.add_argument_group("client libraries"), ts3)
    _add_results(parser.add_argument_group("results"))
    add_json(parser)
    parser.set_defaults(run=run_verify, default_of=parser.get_default)


def _add_ts1(group: argparse._ArgumentGroup) -> None:
    group.add_argument(
        "--oracle",
        action="append",
        default=[],
        choices=ORACLE_NAMES,
        help="oracle to use; repeatable; default: all installed",
    )


def _add_cases(group: argparse._ArgumentGroup) -> None:
    group.add_argument(
        "--simulator",
        choices=["python", *SIMULATOR_NAMES],
        default="python",
        help="replay everything as well: the exported VHDL in ghdl, or the Verilog in iverilog or "
        "verilator; default: %(default)s",
    )
    group.add_argument(
        "--cases",
        type=positive,
        metavar="N",
        help="at most N cases of each type; default: all; for recordings, at most "
        f"{MOST_MESSAGES} messages of each type",
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


def _add_replay(group: argparse._ArgumentGroup) -> None:
    group.add_argument(
        "--bag",
        action="append",
        default=[],
        metavar="FILE",
        help="replay the messages of a recording (.bag, .mcap, .db3) with its definitions, at "
        f"most {MOST_MESSAGES} of each type (--cases N: N of each); without TYPE, of all types "
        "that have topics; repeatable",
    )
    group.add_argument(
        "--max-message-bytes",
        type=_size,
        metavar="N",
        help=f"leave out longer messages of recordings; default: {LONGEST}",
    )


def _add_libraries(group: argparse._ArgumentGroup, ts3: argparse._ArgumentGroup) -> None:
    group.add_argument(
        "--sut",
        action="append",
        default=[],
        choices=CLIENT_NAMES,
        metavar="NAME",
        help="compare a client library with ROS's own serializer, instead of running test systems: "
        f"{', '.join(CLIENT_NAMES)}; repeatable",
    )
    ts3.add_argument(
        "--reference",
        action="append",
        default=[],
        choices=[*WRITER_NAMES, NO_REFERENCE],
        metavar="NAME",
        help="library that has to write the same bytes as rosbags: "
        f"{', '.join(WRITER_NAMES)}, or {NO_REFERENCE}; repeatable; default: all installed",
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


def _add_board(group: argparse._ArgumentGroup) -> None:
    """Add the arguments to a group of a parser."""
    group.add_argument(
        "--board",
        metavar="BOARD",
        help="send the cases of ts3 through a board that sends them back: sim, udp://HOST[:PORT], "
        "tcp://HOST:PORT, serial:///dev/DEVICE[?baud=RATE] or zynq://UIO/BUFFER",
    )
    group.add_argument(
        "--node",
        metavar="FILE",
        help="description of the node on the board; without TYPE, all types that it sends back; "
        "default: that of --write-node",
    )
    group.add_argument(
        "--write-node",
        metavar="FILE",
        help="test nothing, but write the description of a node that sends the types back, for "
        "firm-hdl node build",
    )
    add_engine(group, "--board sim")
    group.add_argument(
        "--silent-seconds",
        type=seconds,
        metavar="S",
        help="a board that says nothing for so long fails; default: 5, or 60 for sim",
    )


def _check_board(given: argparse.Namespace) -> None:
    """Refuse arguments that cannot be combined with a board."""
    has_node = given.board is not None or given.write_node is not None
    if given.systems is not None and ("board" in given.systems) != (given.board is not None):
        given.usage_error("--systems board needs --board, and the reverse")
    for name in ("node", "engine", "silent_seconds"):
        if given.board is None and getattr(given, name) != given.default_of(name):
            given.usage_error(f"--{name.replace('_', '-')} needs --board")
    if not has_node:
        return
    if given.all or given.bag:
        given.usage_error("a board takes named types, or those of --node")
    if given.wire is not None:
        given.usage_error("a board has the wire format of its distribution: not with --wire")
    if len(given.distro or ()) > 1 or len(set(given.bus_bytes or ())) > 1:
        given.usage_error("a board has one --distro and one --bus-bytes")
    if given.node is None:
        return
    if given.write_node is not None:
        given.usage_error("argument --write-node: not allowed with argument --node")
    if given.distro or given.bus_bytes:
        given.usage_error("--distro and --bus-bytes are those of --node")
    if set(given.systems or ()) - {"board"}:
        given.usage_error("--node is for the test system board alone")


def _write_node(work: Workload, path: str) -> int:
    """Write the description of a node for the types of a request; return the exit status."""
    from firm_hdl.verify.board.description import write_description

    write_description(work.request, [task.name for task in work.tasks], path)
    print(f"wrote   {path}")
    return 0


def _systems(text: str) -> tuple[str, ...]:
    names = tuple(dict.fromkeys(text.split(",")))
    for name in names:
        if name not in SYSTEM_NAMES:
            raise argparse.ArgumentTypeError(
                f"no test system {name!r}; there are {', '.join(SYSTEM_NAMES)}"
            )
    return names


def _size(text: str) -> int:
    return number_between(text, 1, (1 << 31) - 1)
