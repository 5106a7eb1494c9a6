"""``firm-hdl prove``: prove converters, with a line for each of them and a summary."""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Iterable, Sequence

from firm_hdl.arguments import add_jobs, add_types_or_all, check_types_or_all, positive
from firm_hdl.equivalence.converters import Attempt, ProofTask, both_directions, run_tasks
from firm_hdl.equivalence.proof import DEFAULT_TIMEOUT
from firm_hdl.equivalence.tools import find_tools
from firm_hdl.errors import DefinitionError
from firm_hdl.export.build import plan_of
from firm_hdl.frontend import Library, all_names, load_all, open_library
from firm_hdl.jobs import ProgramMissingError, ToolError
from firm_hdl.terminal import stage

__all__ = ["add_prove_arguments", "add_timeout", "run_proofs", "run_prove"]


def add_prove_arguments(command: argparse.ArgumentParser) -> None:
    """Add the arguments that only this command has."""
    add_types_or_all(command, "all types")
    add_jobs(command)
    add_timeout(command)


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

    Raises
    ------
    DefinitionError, BuildError
        If a type is invalid, or the options do not fit it. Nothing was proved.
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

    Parameters
    ----------
    with_summary : bool
        Print a summary.
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
