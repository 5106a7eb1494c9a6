"""Exported text against the Python simulation, cycle by cycle.

All runs of a type's converters in Python are recorded. A simulator of exported text replays them in
one go, with a reset between two runs. The first output that differs, of any port in any cycle, is
reported. Inputs and outputs come from the same recording. So what is missing in the recording of
one side is a difference, and no packet, transfer or status is lost unseen.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

from firm_hdl.cases import NotJudgedError
from firm_hdl.export.build import BuildError, check_size
from firm_hdl.export.top import Top
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.jobs.processes import ToolError
from firm_hdl.plan import Plan
from firm_hdl.verify.simulators.programs import TextSimulator
from firm_hdl.verify.simulators.trace import Trace, read_row

__all__ = ["check_exportable", "first_difference", "replay_failures"]


def replay_failures(
    simulator: TextSimulator, trace: Trace, make: Callable[[], Sequence[Deserializer | Serializer]]
) -> list[str]:
    """Replay all runs of a trace, and return what is wrong.

    Parameters
    ----------
    make : callable
        Returns new instances of the converters of the trace, to be exported.
    """
    try:
        with tempfile.TemporaryDirectory(prefix="firm-hdl-") as folder:
            rows = simulator.replay(trace, [Top(core) for core in make()], Path(folder))
    except ToolError as error:
        return [f"{simulator.title}: {error}"]
    if not rows:
        return [f"{simulator.title}: no cycle was compared"]
    difference = first_difference(trace, [row.rstrip() for row in rows])
    return [f"{simulator.title}: {difference}"] if difference else []


def check_exportable(plan: Plan) -> None:
    """Raise `NotJudgedError` if converters with that plan are too large to be exported."""
    try:
        check_size(plan)
    except BuildError as error:
        raise NotJudgedError(f"it cannot be exported: {error}") from None


def first_difference(trace: Trace, rows: Sequence[str]) -> str | None:
    """Describe the first output that is not as recorded; `None` if all are."""
    if trace.expected == rows:
        return None
    ports = {pin.number: pin for pin in trace.outputs}
    right: dict[int, str] = {}
    shown: dict[int, str] = {}
    for index, (row, other) in enumerate(zip(trace.expected, rows, strict=False)):
        if row == other:
            changes = dict(read_row(row))
            right.update(changes)
            shown.update(changes)
            continue
        right.update(read_row(row))
        shown.update(read_row(other))
        for number, bits in right.items():
            if shown.get(number) != bits:
                pin = ports[number]
                run, cycle = trace.run_of(index)
                return (
                    f"{run}, cycle {cycle}: {pin.port.name} of the "
                    f"{trace.devices[pin.device].direction} is {_short(shown.get(number, 'U'))} "
                    f"instead of {_short(bits)}"
                )
    if len(rows) != len(trace.expected):
        return f"{len(rows)} cycles instead of {len(trace.expected)}"
    # The values are equal. One of the rows has a port that did not change.
    return None


def _short(bits: str) -> str:
    return hex(int(bits, 2)) if len(bits) > 4 and not set(bits) - {"0", "1"} else f"'{bits}'"
