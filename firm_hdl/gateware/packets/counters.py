"""Counters that stop at their largest value."""

from __future__ import annotations

from collections.abc import Mapping

from amaranth.hdl import Module, Signal, Value
from amaranth.lib import data

__all__ = ["add_counters", "counters_layout"]

COUNTER_BITS = 32


def counters_layout(*names: str) -> data.StructLayout:
    """Return a structure of counters."""
    return data.StructLayout(dict.fromkeys(names, COUNTER_BITS))


def add_counters(m: Module, counters: data.View, events: Mapping[str, Value]) -> None:
    """Add logic that counts cycles in which an event is high.

    Events are registered first, so a counter changes 2 cycles after its event.

    * `events`: by the name of the counter.
    """
    for name, event in events.items():
        seen = Signal(name=f"{name}_seen")
        # The carry tells that the counter is at its largest value.
        more = Signal(COUNTER_BITS + 1, name=f"{name}_more")
        m.d.comb += more.eq(counters[name] + 1)
        m.d.sync += seen.eq(event)
        with m.If(seen & ~more[-1]):
            m.d.sync += counters[name].eq(more)
