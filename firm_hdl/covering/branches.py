"""The branches that the generator takes for a type, in layout, plan and elaboration.

A branch is a step from one line of the generator's code to the next one within a function, as
Python's tracing reports it. The names of branches contain line numbers. So they are valid only
within one run on one version of Python, to compare types with each other. The code of the export is
left out, because it only writes the elaborated circuit, and takes ten times as long.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

from amaranth.hdl import Fragment

from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.model import Message
from firm_hdl.plan import Plan, build_plan
from firm_hdl.wire import lay_out

__all__ = ["PARTS", "branches", "traced"]

PARTS = ("wire", "plan", "gateware")
"""The parts of the package whose branches are counted."""

_ROOT = Path(__file__).parents[1]


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
