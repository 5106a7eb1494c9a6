"""Client libraries against ROS's own serializers, over many types, in several processes."""

from __future__ import annotations

from collections.abc import Generator, Sequence

from firm_hdl.cases import NotJudgedError
from firm_hdl.cases.effort import all_cases
from firm_hdl.cases.user_oracle import judge_of
from firm_hdl.cases.values import Plain, from_objects
from firm_hdl.errors import DefinitionError
from firm_hdl.jobs import run_each
from firm_hdl.model import Message
from firm_hdl.plan import build_plan
from firm_hdl.verify.clients.judge import LibraryComparison, LibraryResult
from firm_hdl.verify.references.clients import REFERENCES, client
from firm_hdl.verify.results.verdict import NotJudged
from firm_hdl.verify.systems.options import Request, command_again
from firm_hdl.verify.systems.tasks import TypeUnderTest, library_of
from firm_hdl.wire import Wire, lay_out

__all__ = ["command_of", "comparison_of", "judge_type", "judge_types", "reference_of"]

BUS_BYTES = 8
"""Lengths of sequences and texts are chosen as for a bus of this width."""


def command_of(request: Request, distro: str, name: str, library: str) -> str:
    """Return the command that judges one library on one type again."""
    return command_again(
        name,
        sut=library,
        distro=distro,
        path=request.paths,
        depends=request.depends,
        wire=request.wire,
        seed=request.seed or None,
        cases=request.most_cases,
    )


def reference_of(library: str, wire: Wire, installed: Sequence[str]) -> str | None:
    """Return the first reference for a library on a wire; `None` if none is installed."""
    return next(iter(_references(library, wire, installed)), None)


def _references(library: str, wire: Wire, installed: Sequence[str]) -> list[str]:
    own, *others = REFERENCES[wire]
    # ROS's own serializer is judged by rosbags first, and only then by other releases of itself.
    names = reversed(others) if library == own else (own, *others)
    return [name for name in names if name in installed and name != library]


def comparison_of(result: LibraryResult, wire: Wire) -> LibraryComparison:
    """Return the comparison of a result, to repeat its questions."""
    return LibraryComparison(client(result.library), client(result.reference), wire)


def judge_type(
    distro: str, name: str, options: Request, installed: Sequence[str]
) -> list[LibraryResult]:
    """Judge all libraries on one type. Errors are not raised, but are in the results.

    Parameters
    ----------
    options : Request
        `libraries`, `wire`, `seed`, `most_cases`, `paths`, `depends` and `names_wires` are used. If
        the user chose wires, a library that lacks one of them counts as not judged.
    installed : sequence of str
        References that can be used.
    """
    try:
        message = library_of(distro, options).message(name)
        wire = options.wire or message.wire
        values = _values(distro, message, wire, options)
    # The other types are judged in any case.
    except (NotJudgedError, DefinitionError, ValueError) as error:
        return [_not_judged(library, name, str(error)) for library in options.libraries]
    results = [_judged(library, message, wire, values, installed) for library in options.libraries]
    for result in results:
        result.is_asked = options.names_wires or wire in client(result.library).wires
    return results


def _judged(
    library: str, message: Message, wire: Wire, values: Sequence[Plain], installed: Sequence[str]
) -> LibraryResult:
    """Judge a library by the first reference that has the type."""
    first: LibraryResult | None = None
    for reference in _references(library, wire, installed):
        result = LibraryComparison(client(library), client(reference), wire).judge(message, values)
        if not isinstance(result.obstacle, NotJudged):
            return result
        first = first or result
    return first or _not_judged(library, message.name, f"no reference for {wire} is installed")


def _not_judged(library: str, name: str, why: str) -> LibraryResult:
    return LibraryResult(library=library, reference="", type=name, obstacle=NotJudged(why))


def _values(distro: str, message: Message, wire: Wire, options: Request) -> list[Plain]:
    """Choose values as TS3 does: all lengths and extremes, and values for a plan's decisions."""
    judge = judge_of(message, None if options.paths else distro, stand_in=True)
    plan = build_plan(lay_out(message, wire), bus_bytes=BUS_BYTES)
    seed, most = options.seed, options.most_cases
    cases = all_cases(judge.oracle, judge.name, plan, seed=seed, most=most)
    return [from_objects(message, case.value) for case in cases]


def judge_types(
    tasks: Sequence[TypeUnderTest], options: Request, installed: Sequence[str]
) -> Generator[tuple[TypeUnderTest, list[LibraryResult]], None, None]:
    """Judge all libraries on types, and yield each type's results when they are done."""
    work = [(task, (task.distro, task.name, options, installed)) for task in tasks]
    for task, results in run_each(judge_type, work, jobs=options.jobs):
        if isinstance(results, Exception):
            # A worker process died, or our own code raised: the run has no result.
            raise results
        yield task, results
