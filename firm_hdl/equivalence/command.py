"""``firm-hdl prove``: prove converters in several processes, with a line for each and a summary."""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from amaranth.back import rtlil as amaranth_rtlil

from firm_hdl.arguments import add_jobs, add_options, add_types_or_all, check_types_or_all, positive
from firm_hdl.equivalence.circuit import ProofError
from firm_hdl.equivalence.proof import DEFAULT_TIMEOUT, Proof, prove
from firm_hdl.equivalence.tools import find_tools
from firm_hdl.errors import DefinitionError, UserError
from firm_hdl.export.build import check_size, plan_of
from firm_hdl.export.top import DIRECTIONS, Direction, Top, converter_of
from firm_hdl.frontend import Library, all_names, load_all, open_library
from firm_hdl.jobs import ProgramMissingError, ToolError, run_each
from firm_hdl.model import Message
from firm_hdl.names.identifiers import identifier
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES
from firm_hdl.terminal import stage
from firm_hdl.vhdl.convert import Vhdl, convert
from firm_hdl.wire import Wire

__all__ = [
    "Attempt",
    "ProofTask",
    "add_prove",
    "add_timeout",
    "both_directions",
    "converter_vhdl",
    "run_proofs",
    "run_prove",
]


@dataclass(frozen=True, slots=True, kw_only=True)
class ProofTask:
    """The proof of one converter.

    Attributes
    ----------
    distro, paths, bags, depends
        As for `open_library`.
    """

    distro: str
    name: str  # Name of the type.
    direction: Direction
    paths: tuple[str, ...] = ()
    bags: tuple[str, ...] = ()
    depends: tuple[str, ...] = ()
    # As for the converters.
    wire: Wire | None = None
    bus_bytes: int = 8
    max_message_bytes: int = DEFAULT_MAX_MESSAGE_BYTES
    timeout: float = DEFAULT_TIMEOUT  # Seconds for each solver.


@dataclass(frozen=True, slots=True, kw_only=True)
class Attempt:
    """The result of a task. Without a proof, `problem` says why."""

    proof: Proof | None
    problem: str = ""

    @property
    def result(self) -> str:
        """The result in one word."""
        return self.proof.result if self.proof is not None else "failed"


def converter_vhdl(
    message: Message,
    direction: Direction,
    *,
    wire: Wire | None = None,
    bus_bytes: int = 8,
    max_message_bytes: int = DEFAULT_MAX_MESSAGE_BYTES,
) -> tuple[str, Vhdl]:
    """Return a converter as RTLIL, and as the VHDL that ``firm-hdl build`` writes for it.

    The VHDL is that of the entity with flat ports, without the comments at the head of the files.

    Raises `BuildError` if the converter cannot be built with these options.
    """
    plan = plan_of(message, wire, bus_bytes, max_message_bytes)
    check_size(plan)
    top = Top(converter_of(message, plan, direction))
    base = identifier(f"{identifier(message.name)}_{plan.wire}_{bus_bytes}").lower()
    name = f"{base}_{direction}_flat"
    rtlil: str = amaranth_rtlil.convert(top, name=name, emit_src=False)
    return rtlil, convert(rtlil, name=name)


def attempt(task: ProofTask) -> Attempt:
    """Run a task; errors become a result without a proof."""
    try:
        library = open_library(task.distro, task.paths, task.bags, depends=task.depends)
        message = library.message(task.name)
        rtlil, vhdl = converter_vhdl(
            message,
            task.direction,
            wire=task.wire,
            bus_bytes=task.bus_bytes,
            max_message_bytes=task.max_message_bytes,
        )
        return Attempt(proof=prove(rtlil, vhdl, timeout=task.timeout))
    except (ProofError, UserError, DefinitionError, ValueError) as error:
        return Attempt(proof=None, problem=str(error))


def run_tasks(
    tasks: Sequence[ProofTask], jobs: int | None = None
) -> Iterator[tuple[ProofTask, Attempt]]:
    """Run tasks in `jobs` processes (`None`: one per processor); yield results as they finish."""
    work = [(task, (task,)) for task in tasks]
    for task, result in run_each(attempt, work, jobs=jobs):
        if isinstance(result, Exception):
            yield task, Attempt(proof=None, problem=repr(result))
        else:
            yield task, result


def both_directions(name: str, **options: object) -> list[ProofTask]:
    """Return the tasks for both converters of a type."""
    return [
        ProofTask(name=name, direction=direction, **options)  # type: ignore[arg-type]
        for direction in DIRECTIONS
    ]


def add_prove(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl prove``, besides the origins of definitions."""
    add_types_or_all(command, "all types")
    add_jobs(command)
    add_timeout(command)
    add_options(command)
    command.set_defaults(run=run_prove)


def add_timeout(command: argparse.ArgumentParser) -> None:
    """Add ``--timeout``."""
    command.add_argument(
        "--timeout",
        type=positive,
        default=int(DEFAULT_TIMEOUT),
        metavar="SECONDS",
        help="time limit of each of two solvers; default: %(default)s",
    )


def run_prove(given: argparse.Namespace) -> int:
    """Run the command; return 0 if all converters are proved equal, and 1 if not.

    Raises `DefinitionError` or `BuildError` if a type is invalid, or the options do not fit it.
    Nothing was proved.
    """
    check_types_or_all(given)
    library = open_library(given.distro, given.path, given.bag, depends=given.depends)
    if given.all:
        names = _all_messages(library, all_names(given.distro, given.path, given.bag))
    else:
        messages = load_all(library, given.types)
        for message in messages:
            plan_of(message, given.wire, given.bus_bytes, given.max_message_bytes)
        names = [message.name for message in messages]
    tasks = [
        task
        for name in names
        for task in both_directions(
            name,
            distro=library.distro,
            paths=tuple(given.path),
            bags=tuple(given.bag),
            depends=tuple(given.depends),
            wire=given.wire,
            bus_bytes=given.bus_bytes,
            max_message_bytes=given.max_message_bytes,
            timeout=float(given.timeout),
        )
    ]
    return run_proofs(tasks, given.jobs, with_summary=given.all)


def _all_messages(library: Library, types: Iterable[str]) -> list[str]:
    """List the messages of types, and the types with errors: their tasks tell what is wrong."""
    names: dict[str, None] = {}
    for name in types:
        try:
            names |= dict.fromkeys(each.name for each in library.interface(name).messages)
        except DefinitionError:
            names[name] = None
    return list(names)


def run_proofs(tasks: Sequence[ProofTask], jobs: int | None, *, with_summary: bool) -> int:
    """Run tasks, and print the result of each; return the exit status.

    * `with_summary`: print a summary.
    """
    try:
        find_tools()
    except (ProgramMissingError, ToolError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    results: list[tuple[ProofTask, Attempt]] = []
    for task, attempt in run_tasks(tasks, 1 if len(tasks) == 1 else jobs):
        results.append((task, attempt))
        stage("prove: converters", len(results), len(tasks))
        print(_line(task, attempt), flush=True)
    if with_summary:
        print(_summary(results))
    if not results:
        print("there was no converter to prove")
    proved = sum(attempt.result == "equal" for _, attempt in results)
    return 0 if 0 < proved == len(tasks) else 1


def _line(task: ProofTask, attempt: Attempt) -> str:
    seconds = f"{attempt.proof.seconds:6.1f} s" if attempt.proof is not None else " " * 8
    wire = f", {task.wire}" if task.wire else ""
    what = f"{task.name} {task.direction} ({task.distro}{wire}, {task.bus_bytes} bytes)"
    lines = [f"{attempt.result:9} {seconds}  {what}"]
    if attempt.proof is None:
        lines += attempt.problem.splitlines()
    elif attempt.result != "equal":
        lines += str(attempt.proof).splitlines()[1:]
    return "\n    ".join(line.strip() for line in lines)


def _summary(results: Sequence[tuple[ProofTask, Attempt]]) -> str:
    counted = Counter(attempt.result for _, attempt in results)
    types = {(task.distro, task.name, task.wire) for task, _ in results}
    seconds = sorted(
        (attempt.proof.seconds, f"{task.name} {task.direction}")
        for task, attempt in results
        if attempt.proof is not None
    )
    parts = ", ".join(f"{count} {result}" for result, count in sorted(counted.items()))
    text = f"{len(results)} converters of {len(types)} types: {parts}"
    if seconds:
        most, slowest = seconds[-1]
        text += (
            f"\nseconds per converter: median {seconds[len(seconds) // 2][0]:.1f}, most {most:.1f} "
            f"({slowest}), {sum(each for each, _ in seconds):.0f} in total"
        )
    return text
