# amaranth: UnusedElaboratable=no
"""The orders of the sequencer, compared with the interpreter: steps, positions, sizes, ends."""

from __future__ import annotations

import random

import pytest
from amaranth.hdl import Module, Value
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out
from amaranth.sim import Simulator

from firm_hdl import Status
from firm_hdl.gateware.parse.buffer import Buffer
from firm_hdl.gateware.parse.orders import order_layout
from firm_hdl.gateware.parse.sequencer import Sequencer
from firm_hdl.gateware.positions import Ring
from firm_hdl.gateware.signatures import PacketSignature
from firm_hdl.plan import BeginRun, RunStep, build_plan
from firm_hdl.plan.cycles import packet_of
from firm_hdl.sim.payloads import all_beats
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.gateware.traffic import random_packets
from tests.strategies import make

TEXT = make("ros2", {"s": "string", "d": "float64"}, "Text")
OLD = make("ros1", {"s": "string", "d": "float64"}, "Old")
CELL = make("ros1", {"x": "uint16"}, "Cell")
ROW = make("ros1", {"x": "uint32", "c": (CELL, "[]")}, "Row")
MESSAGES = {
    # Every alignment of maps and items; a loop; a constant count; a rest at the end.
    "cdr": make("ros2", {"a": "uint8", "s": "string", "d": "float64[]", "t": (TEXT, "[]")}),
    "ros1": make("ros1", {"a": "uint8", "s": "string", "d": "float64[]", "t": (OLD, "[]")}),
    # Lengths of one kind, and the same kind of step after each; loops that end together.
    "same": make("ros1", {"s": "string", "t": "string", "d": "float64[]", "r": (ROW, "[]")}),
    "array": make("ros2", {"a": "uint8[40]", "s": "uint16[]", "x": "float64"}),
}


class Ordering(wiring.Component):
    """A buffer and a sequencer."""

    def __init__(self, plan):
        self.plan = plan
        super().__init__(
            {
                "packets": In(PacketSignature(plan.bus_bytes)),
                "orders": Out(stream.Signature(order_layout(plan))),
            }
        )

    def elaborate(self, platform):
        m = Module()
        m.submodules.buffer = buffer = Buffer(self.plan)
        m.submodules.sequencer = sequencer = Sequencer(self.plan)
        wiring.connect(m, wiring.flipped(self.packets), buffer.packets)
        wiring.connect(m, sequencer.orders, wiring.flipped(self.orders))
        m.d.comb += [
            sequencer.beat.eq(buffer.beat),
            sequencer.limit.eq(buffer.limit),
            sequencer.ended.eq(buffer.ended),
            sequencer.following.eq(buffer.following),
            buffer.next.eq(sequencer.next),
            buffer.freed.eq(sequencer.oldest),
        ]
        return m


def expected(plan, packets):
    """Return the meaningful fields of orders, by the interpreter."""
    bus, ring = plan.bus_bytes, Ring(plan)
    orders, base = [], 0

    def place(position):
        return (base + position) % (1 << (ring.bits - 1))

    for data in packets:
        packet = packet_of(plan, data)
        after = 0
        for index, visit in enumerate(packet.visits):
            step = plan.steps[visit.step]
            start = visit.end - (bus if isinstance(step, RunStep) else step.bytes)
            order = {"step": visit.step, "blank": 0, "items": 0}
            if isinstance(step, RunStep) and plan.runs[step.run].counted:
                order |= {"items": 1, "last": 0, "items_at": place(start), "items_bytes": bus}
            elif isinstance(step, RunStep):
                order |= {"map_at": place(start), "map_bytes": bus}
            elif step.bytes > bus:
                order |= {"items_at": place(start), "map_at": place(start + bus)}
            elif step.bytes:
                order |= {"map_at": place(start), "map_bytes": bus}
            if step.rest is not None:
                size = visit.bytes - step.bytes
                # The NUL is no item. In CDR, a run with a NUL has at least the NUL.
                size -= bool(size) and plan.runs[step.rest].terminated
                order["items"] = int(size > 0)
                if size:
                    order |= {"items_at": place(after), "items_bytes": size, "last": 1}
            is_last = index == len(packet.visits) - 1 and step.begin is None
            order["ends"] = int(is_last)
            if is_last:
                order["status"] = Status.OK.value
            orders.append(order)
            if index < len(packet.visits) - 1:
                after = packet.next_start(index)
        if step.begin is not None:
            orders.append({"blank": 1, "ends": 1, "status": Status.OK.value})
        base += packet.beats * bus
    return orders


def compare(plan, packets, tamper=lambda name, value: value):
    """Run packets through a sequencer, compare all its orders, and return their number."""
    dut, rng = Ordering(plan), random.Random(1)
    want = expected(plan, packets)
    beats = list(all_beats(packets, plan.bus_bytes, counts=True))

    async def testbench(ctx):
        sent = got = idle = 0
        payload = dut.packets.payload
        while got < len(want):
            offers, ready = sent < len(beats) and rng.random() < 0.8, rng.random() < 0.7
            if offers:
                ctx.set(payload.as_value(), beats[sent])
            ctx.set(dut.packets.valid, offers)
            ctx.set(dut.orders.ready, ready)
            sent += offers and ctx.get(dut.packets.ready)
            idle += 1
            if ready and ctx.get(dut.orders.valid):
                order = dut.orders.payload
                for name, value in want[got].items():
                    found = ctx.get(Value.cast(order[name]))
                    assert tamper(name, found) == value, (got, name, want[got])
                got, idle = got + 1, 0
            assert idle < 200, "no order comes"
            await ctx.tick()

    simulator = Simulator(dut)
    simulator.add_clock(1e-6)
    simulator.add_testbench(testbench)
    simulator.run()
    return len(want)


# Each message, and each width but one.
QUICK = {("cdr", 16), ("cdr", 4), ("ros1", 8), ("same", 8), ("array", 2)}


@pytest.mark.parametrize(
    ("name", "bus_bytes"),
    [
        pytest.param(name, bus, marks=[] if (name, bus) in QUICK else [pytest.mark.thorough])
        for name in MESSAGES
        for bus in (1, 2, 4, 8, 16)
    ],
)
def test_orders_are_those_of_the_interpreter(name, bus_bytes):
    plan = build_plan(lay_out(MESSAGES[name]), bus_bytes=bus_bytes)
    assert compare(plan, random_packets(plan, by_depth(8, 15))) >= 30


@pytest.mark.parametrize("field", ["step", "items_at", "map_at", "items_bytes", "items", "ends"])
def test_each_field_matters(field):
    plan = build_plan(lay_out(MESSAGES["cdr"]), bus_bytes=8)
    with pytest.raises(AssertionError):
        compare(
            plan,
            random_packets(plan, 15),
            tamper=lambda name, value: value ^ 1 if name == field else value,
        )


def test_alignments_of_items_occur():
    # Otherwise the tests above would not cover them.
    aligns = set()
    for bus_bytes in (8, 16):
        plan = build_plan(lay_out(MESSAGES["cdr"]), bus_bytes=bus_bytes)
        aligns |= {s.begin.align for s in plan.steps if isinstance(s.begin, BeginRun)}
    assert aligns == {1, 8}
