"""Packets made length by length, and plans in which lengths claim other bytes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from firm_hdl.plan import Charge, Fixed, Item, Length, Loop, Plan, Step, decode

__all__ = ["header_of", "next_length", "with_charges"]


def header_of(plan: Plan) -> bytes:
    steps = [step for step in plan.steps if isinstance(step, Step)]
    return b"".join(s.data for step in steps for s in step.slices if isinstance(s, Fixed))


def next_length(plan: Plan, packet: bytes) -> tuple[int, Length] | None:
    """Return where the interpreter finds the first length behind a packet, and the length."""
    for visit in decode(plan, packet).steps:
        begin = plan.begins.get(visit.step)
        if begin is not None and isinstance(begin.count, Length) and visit.end > len(packet):
            return visit.end - 4, begin.count
    return None


def with_charges(plan: Plan, change: Callable[[Charge], Charge | None]) -> Plan:
    """Return a plan in which lengths claim something else."""

    def changed(items: Sequence[Item]) -> Iterator[Item]:
        for item in items:
            if isinstance(item, Loop):
                item = replace(item, body=tuple(changed(item.body)))
            if not isinstance(item, Step) and isinstance(item.count, Length) and item.count.charge:
                item = replace(item, count=replace(item.count, charge=change(item.count.charge)))
            yield item

    return replace(plan, items=tuple(changed(plan.items)))
