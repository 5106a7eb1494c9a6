"""What the command prints: a line for each type and bus, failures, and the sum."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from lab.fuzz.run import Failure, FuzzTask, Outcome

__all__ = ["HEAD", "failure_text", "line", "summary"]

_STATUSES = {
    "OK": "ok",
    "TRUNCATED": "trunc.",
    "TRAILING": "trail.",
    "LENGTH": "length",
    "ENCAPSULATION": "encaps.",
    "STRING": "string",
    "FULL": "full",
    "LARGE": "large",
    "OVERRUN": "overrun",
}
_NAME_WIDTH = 44
HEAD = " ".join(
    [
        f"{'type':{_NAME_WIDTH}} wire bus  packets     bad",
        *(f"{title:>8}" for title in _STATUSES.values()),
        "    cycles packets/s",
    ]
)
"""The titles of the columns."""


def line(outcome: Outcome) -> str:
    """Return the row of a type and a bus."""
    task = outcome.task
    rate = outcome.packets / outcome.run_seconds if outcome.run_seconds else 0.0
    counts = (f"{outcome.statuses.get(status, 0):8}" for status in _STATUSES)
    return " ".join(
        [
            f"{task.type:{_NAME_WIDTH}} {outcome.wire:4} {task.bus_bytes:3}",
            f"{outcome.packets:8} {outcome.bad:7}",
            *counts,
            f"{outcome.cycles:10} {rate:9.0f}",
        ]
    )


def failure_text(outcome: Outcome, failure: Failure) -> str:
    """Describe a failure, with the command that repeats it."""
    task: FuzzTask = outcome.task
    what = f"FAILED: {task.type} ({outcome.wire}), bus of {task.bus_bytes} bytes"
    lines = [f"{what}, {failure.circuit}" if failure.circuit else what, failure.rule]
    if failure.packet is not None:
        lines.append(f"packet {failure.packet} of seed {task.seed}: {failure.hex}")
    if failure.expected or failure.came:
        lines += [f"expected: {failure.expected}", f"came:     {failure.came}"]
    if failure.cycle is not None:
        lines.append(f"cycle {failure.cycle} after the reset at the start of its episode")
    lines.append(f"repeat: {task.command(failure)}")
    return "\n    ".join(lines)


def summary(outcomes: Sequence[Outcome]) -> str:
    """Add up all outcomes."""
    statuses: Counter[str] = Counter()
    for outcome in outcomes:
        statuses.update(outcome.statuses)
    packets = sum(outcome.packets for outcome in outcomes)
    seconds = sum(outcome.run_seconds for outcome in outcomes)
    build = sum(outcome.build_seconds for outcome in outcomes)
    types = {(outcome.task.type, outcome.wire) for outcome in outcomes}
    widths = sorted({outcome.task.bus_bytes for outcome in outcomes})
    failures = sum(len(outcome.failures) for outcome in outcomes)
    counted = ", ".join(f"{statuses[name]:,} {name}" for name in _STATUSES if statuses[name])
    return (
        f"{packets:,} packets, {sum(outcome.bad for outcome in outcomes):,} of them bad, through "
        f"{sum(len(outcome.by_circuit) for outcome in outcomes)} circuits of {len(types)} types on "
        f"buses of {', '.join(map(str, widths))} bytes\n"
        f"{counted}; {sum(outcome.discarded for outcome in outcomes):,} lost in "
        f"{sum(outcome.resets for outcome in outcomes):,} resets\n"
        f"{sum(outcome.cycles for outcome in outcomes):,} cycles in {seconds:.0f} s of processor "
        f"time, after {build:.0f} s to build\n"
        f"{failures or 'no'} failure{'' if failures == 1 else 's'}"
    )
