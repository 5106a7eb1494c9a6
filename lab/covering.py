"""Choose types that also take every branch of the generator, in layout, plan and elaboration.

``python -m lab.covering --distro lyrical --out FILE`` does what ``firm-hdl cover`` does, with
branches as one more family of features; ``--check FILE`` lists those that the types of FILE lack. A
branch is a step from one line of the generator's code to the next one within a function, as
Python's tracing reports it. The names of branches contain line numbers. So they are valid only
within one run on one version of Python, to compare types with each other. The code of the export is
left out, because it only writes the elaborated circuit, and takes ten times as long.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

from amaranth.hdl import Fragment

import firm_hdl
from firm_hdl.covering.choose import all_features, choose, cost
from firm_hdl.covering.command import read_chosen
from firm_hdl.export.build import plan_of
from firm_hdl.frontend import DISTROS, Library
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.model import Message
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES, Plan, build_plan
from firm_hdl.wire import lay_out

__all__ = ["PARTS", "branches", "main", "traced"]

PARTS = ("wire", "plan", "gateware")
"""The parts of the package whose branches are counted."""

_ROOT = Path(firm_hdl.__file__).parent


def branches(message: Message, plan: Plan) -> frozenset[str]:
    """Elaborate a type's converters to Amaranth's fragments; return the names of the branches.

    Parameters
    ----------
    plan : Plan
        A plan of the message; the converters get its wire format, bus width and limit.
    """

    def make() -> None:
        build_plan(
            lay_out(message, plan.wire),
            bus_bytes=plan.bus_bytes,
            max_message_bytes=plan.max_message_bytes,
        )
        for converter in (Deserializer, Serializer):
            made = converter(
                message,
                wire=plan.wire,
                bus_bytes=plan.bus_bytes,
                max_message_bytes=plan.max_message_bytes,
            )
            # This also elaborates the modules inside.
            Fragment.get(made, None)

    return traced(make, [_ROOT / part for part in PARTS])


def traced(work: Callable[[], object], folders: Iterable[Path]) -> frozenset[str]:
    """Call a function, and return the branches that it took in the code of the folders."""
    prefixes = tuple(f"{folder}{os.sep}" for folder in folders)
    wanted: dict[CodeType, bool] = {}
    found: set[tuple[CodeType, int, int]] = set()

    def enter(frame: FrameType, event: str, argument: object) -> Any:
        code = frame.f_code
        is_wanted = wanted.get(code)
        if is_wanted is None:
            is_wanted = wanted[code] = code.co_filename.startswith(prefixes)
        if not is_wanted:
            return None
        last = code.co_firstlineno

        def step(frame: FrameType, event: str, argument: object) -> Any:
            nonlocal last
            if event == "line":
                found.add((code, last, frame.f_lineno))
                last = frame.f_lineno
            return step

        return step

    # Restore the tracing of another tool, such as one for coverage.
    before = sys.gettrace()
    sys.settrace(enter)
    try:
        work()
    finally:
        sys.settrace(before)
    return frozenset(f"{_where(code)}:{start}->{end}" for code, start, end in found)


def _where(code: CodeType) -> str:
    path = Path(code.co_filename)
    inside = path.relative_to(_ROOT).as_posix() if path.is_relative_to(_ROOT) else path.name
    return f"{inside} {code.co_name}"


def main(arguments: Sequence[str] | None = None) -> int:
    """Choose types, or check those of a file; the exit status is 1 if a feature is missing."""
    parser = argparse.ArgumentParser(prog="lab.covering", description=__doc__.split("\n")[0])
    parser.add_argument("types", nargs="*", help="types to choose from; default: all")
    parser.add_argument("--distro", choices=list(DISTROS), default="lyrical")
    do = parser.add_mutually_exclusive_group(required=True)
    do.add_argument("--out", type=Path)
    do.add_argument("--check", type=Path)
    given = parser.parse_args(arguments)
    library = Library(given.distro)
    types: dict[str, frozenset[str]] = {}
    costs: dict[str, float] = {}
    for name in given.types or library.names():
        message = library.message(name)
        plan = plan_of(message, None, 8, DEFAULT_MAX_MESSAGE_BYTES)
        taken = {f"branch: {branch}" for branch in branches(message, plan)}
        types[name] = all_features(library, message, plan) | taken
        costs[name] = cost(plan)
    everything = frozenset().union(*types.values())
    if given.out is not None:
        names = sorted(each.name for each in choose(types, costs))
        head = f"# Types that take every branch that any of {given.distro} takes (lab.covering).\n"
        given.out.write_text(head + "".join(f"{name}\n" for name in names), encoding="utf-8")
        print(f"{len(names)} of {len(types)} types have all {len(everything)} features")
        return 0
    missing = everything.difference(*(types[name] for name in read_chosen(given.check)))
    print(*sorted(missing), f"{len(missing)} of {len(everything)} features are missing", sep="\n")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
