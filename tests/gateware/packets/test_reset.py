# amaranth: UnusedElaboratable=no
"""A reset of one cycle, at any time: a part is as it was at first, and nothing is left inside."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from amaranth.hdl import Cat, ClockDomain, Const, Module, Value
from amaranth.sim import Simulator

from firm_hdl import PacketArbiter, PacketFifo, PacketGate, PacketRouter, PacketWidth, Parser
from firm_hdl.gateware.packets.tail_drop import TailDrop
from firm_hdl.sim.levels import divided
from tests.depth import by_depth
from tests.gateware.packets.bench import beats, with_side
from tests.strategies import make

SIZES = (5, 1, 8, 3, 6, 12)
PACKETS = [bytes(range(16 * n, 16 * n + size)) for n, size in enumerate(SIZES)]
NOTHING = Const(0, 1)
LATE = 3
"""Cycles after the reset before the first input offers its packets; the others do so at once."""


def arbiter():
    part = PacketArbiter(2, 3)
    given = [(port, list(beats(PACKETS[n::3], 2))) for n, port in enumerate(part.packets_in)]
    return part, given, [(part.packets_out, part.source)], NOTHING


def router():
    part = PacketRouter(2, 2, topic_bits=2, side_bits=4)
    topics = (0, 1, 3, 1, 0, 2)
    sides = [topic | (8 + n) << 2 for n, topic in enumerate(topics)]
    came = with_side(part.packets_in, Cat(part.topic, part.side_in))
    outputs = [(port, part.side_out) for port in part.packets_out]
    return part, [(came, list(beats(PACKETS, 2, sides)))], outputs, Value.cast(part.counters)


def fifo(when_full):
    part = PacketFifo(2, 16, 2, when_full=when_full)
    came, sides = with_side(part.packets_in, part.abort), (0, 1, 0, 0, 1, 0)
    outputs = [(part.packets_out, part.size)]
    return part, [(came, list(beats(PACKETS, 2, sides)))], outputs, Value.cast(part.counters)


def tail_drop():
    part = TailDrop(2)
    out, payload = part.packets_out, part.packets_out.payload
    beat = SimpleNamespace(payload=payload.beat, valid=out.valid, ready=out.ready)
    side = Cat(payload.aborted, payload.dropped, part.drops)
    return part, [(part.packets_in, list(beats(PACKETS, 2)))], [(beat, side)], NOTHING


# A string of ROS 1 each; the second one is cut, and the fourth one too long.
TEXTS = [b"\2\0\0\0ab", b"\5\0\0\0ab", b"\0\0\0\0", b"\1\0\0\0abc", b"\3\0\0\0abc"]
TEXT = make("ros1", {"s": "string"}, "Text")


def parser():
    part = Parser(TEXT, bus_bytes=2)
    return part, [(part.packets, list(beats(TEXTS, 2)))], [(part.status, part.sizes)], NOTHING


def gate(when_full):
    part = PacketGate(TEXT, bus_bytes=2, memory_bytes=16, packets=2, when_full=when_full)
    outputs = [(part.packets_out, part.size), (part.status, NOTHING)]
    given = [(part.packets_in, list(beats(TEXTS, 2)))]
    return part, given, outputs, Value.cast(part.counters)


def width(in_bytes, out_bytes):
    part = PacketWidth(in_bytes, out_bytes)
    given = [(part.packets_in, list(beats(PACKETS, in_bytes)))]
    return part, given, [(part.packets_out, NOTHING)], NOTHING


PARTS = {
    "arbiter": arbiter,
    "router": router,
    "fifo": lambda: fifo("wait"),
    "fifo that drops": lambda: fifo("drop"),
    "tail drop": tail_drop,
    "parser": parser,
    "gate": lambda: gate("wait"),
    "gate that drops": lambda: gate("drop"),
    "wider": lambda: width(2, 8),
    "narrower": lambda: width(8, 2),
    "as wide": lambda: width(4, 4),
}


class Bench:
    """A part in a clock domain with a reset; it is offered all packets before and after it."""

    def __init__(self, part, given, outputs, counters):
        self.given, self.outputs, self.counters = given, outputs, counters
        top = Module()
        top.domains.sync = self.domain = ClockDomain("sync")
        top.submodules.part = part
        self.simulator = Simulator(divided(top))
        self.simulator.add_clock(1e-6)
        self.simulator.add_testbench(self._testbench)
        self.used = False

    def run(self, at, free):
        """Return what leaves after a reset in cycle `at`, and the counters at the end.

        `free`: number of cycles in which outputs are ready before the reset.
        """
        if self.used:
            self.simulator.reset()
        self.used, self.at, self.free, self.left = True, at, free, []
        self.simulator.run()
        return self.left, self.counted

    async def _testbench(self, ctx):
        readies = Cat(port.ready for port, _ in self.given)
        valids = Cat(port.valid for port, _ in self.outputs)
        payloads = [part for port, side in self.outputs for part in (port.payload, side)]
        for cycle in range(self.at + 45):
            since = cycle - self.at - 1
            if cycle == 0 or since == 0:
                pending = [list(offered) for _, offered in self.given]
            ctx.set(self.domain.rst, cycle == self.at)
            offers = [
                bool(left) and not (number == 0 and 0 <= since < LATE)
                for number, left in enumerate(pending)
            ]
            for (port, _), left, is_offered in zip(self.given, pending, offers, strict=True):
                ctx.set(port.valid, is_offered)
                ctx.set(Value.cast(port.payload), left[0] if is_offered else 0)
            for port, _ in self.outputs:
                ctx.set(port.ready, cycle < self.free if since < 0 else since % 4 > 0)
            _, _, ready, valid, *bits = await ctx.tick().sample(readies, valids, *payloads)
            for number, left in enumerate(pending):
                if offers[number] and ready >> number & 1:
                    left.pop(0)
            for number, (beat, side) in enumerate(zip(bits[::2], bits[1::2], strict=True)):
                if since >= 0 and valid >> number & 1:
                    is_beat = hasattr(beat, "count")
                    what = (bytes(beat.data)[: beat.count], beat.last) if is_beat else beat
                    self.left.append((since, number, what, side))
        self.counted = ctx.get(self.counters)


@pytest.mark.sampled(6)
@pytest.mark.parametrize("name", PARTS)
def test_a_part_is_after_a_reset_as_it_was_at_first(name, monkeypatch):
    # Few beats wait for the parser of a gate that drops packets.
    monkeypatch.setattr("firm_hdl.gateware.packets.gate.BACKLOG_BEATS", 5)
    bench = Bench(*PARTS[name]())
    at_first = bench.run(0, 0)
    assert len(at_first[0]) > 5
    for at in by_depth((1, 2, 3, 4, 8, 11), (1, 2, 3, 4, 5, 8, 11, 17)):
        # Outputs are ready before the reset, at first, or not at all.
        assert bench.run(at, (0, 3, at + 1)[at % 3]) == at_first, at
