"""Whether a topic has passed on all that came."""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Cat, Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.node.control import GATE_COUNTERS
from firm_hdl.node.description import Topic
from firm_hdl.node.gateware.core import NodeCore

__all__ = ["TopicIdle"]

_DROPS = tuple(name for name in GATE_COUNTERS if name != "passed")


class TopicIdle(wiring.Component):
    """Count the messages in the gate of a topic.

    Members
    -------
    came, left : In(1)
        A message has come, or has left the gate.
    drops : In(len(GATE_COUNTERS) - 1)
        The lowest bits of the counters of messages that the gate drops. Each change is a message.
    idle : Out(1)
        As many have left or were dropped as came. A counter that has reached its end, after
        ``2**32 - 1`` messages, no longer changes, and then idle is late.
    """

    def __init__(self) -> None:
        super().__init__({"came": In(1), "left": In(1), "drops": In(len(_DROPS)), "idle": Out(1)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        before, inside, dropped = (
            Signal.like(self.drops),
            Signal(16),
            Signal(range(len(_DROPS) + 1)),
        )
        changes = self.drops ^ before
        m.d.sync += [
            before.eq(self.drops),
            dropped.eq(sum(changes[place] for place in range(len(_DROPS)))),
            inside.eq(inside + self.came - self.left - dropped),
        ]
        m.d.comb += self.idle.eq((inside == 0) & ~self.came)
        return m

    @staticmethod
    def of(m: Module, topic: Topic, core: NodeCore) -> Signal:
        """Add one for a topic of a core; return its `idle`."""
        m.submodules[f"idle_{topic.port}"] = counter = TopicIdle()
        is_service = topic.kind == "serve"
        port: Any = getattr(getattr(core, topic.kind), topic.port)
        packets = port.request.packets if is_service else port
        counters = core.counters[f"{'request' if is_service else 'subscribe'}_{topic.port}"]
        came = core.received
        m.d.comb += [
            counter.came.eq(
                came.valid & came.ready & came.payload.beat.last & (came.payload.topic == topic.id)
            ),
            counter.left.eq(packets.valid & packets.ready & packets.payload.last),
            counter.drops.eq(Cat(counters[name][0] for name in _DROPS)),
        ]
        return counter.idle
