# amaranth: UnusedElaboratable=no
"""Whole messages inside an accelerator."""

from __future__ import annotations

import pytest
from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out
from amaranth.sim import Simulator

from firm_hdl import Deserializer, MessageSignature, load_message
from firm_hdl.accelerator import offer_message, offer_messages, take_message, tie_off
from firm_hdl.sim import MessagePort, Stalls
from tests.strategies import make

TWIST = load_message("geometry_msgs/msg/Twist")
FLOAT = load_message("std_msgs/msg/Float64")
EMPTY = load_message("std_msgs/msg/Empty")
HALTS = Stalls(probability=0.5, seed=1)


class Circuit(wiring.Component):
    """Ports of messages by name, and the logic of a test between them."""

    def __init__(self, logic, came=(), sent=()):
        self.logic, self.came, self.sent = logic, dict(came), dict(sent)
        super().__init__(
            {
                **{name: In(MessageSignature(kind)) for name, kind in self.came.items()},
                **{name: Out(MessageSignature(kind)) for name, kind in self.sent.items()},
            }
        )

    def elaborate(self, platform):
        m = Module()
        # `sync` has to be there, also if only constants are sent.
        m.d.sync += Signal().eq(1)
        self.logic(m, self)
        return m


def run(dut, sent, count):
    """Send values, under stalls, to the ports that take some; return what the others gave."""
    got = {name: [] for name in dut.sent}

    def source(name):
        async def bench(ctx):
            port = MessagePort(getattr(dut, name), dut.came[name])
            for value in sent[name]:
                await port.send(ctx, value, stalls=HALTS)

        return bench

    def sink(name):
        async def bench(ctx):
            port = MessagePort(getattr(dut, name), dut.sent[name])
            for _ in range(count):
                got[name].append(await port.receive(ctx, stalls=HALTS))

        return bench

    simulator = Simulator(dut)
    simulator.add_clock(1e-8)
    for name in dut.came:
        simulator.add_testbench(source(name))
    for name in dut.sent:
        simulator.add_testbench(sink(name))
    simulator.run()
    return got


def twist(*numbers):
    return {
        part: dict(zip("xyz", numbers[first : first + 3], strict=True))
        for part, first in (("linear", 0), ("angular", 3))
    }


def test_fields_are_taken_and_sent_as_one_stream():
    def logic(m, self):
        command = take_message(m, self.command, fields=["linear.x", "angular.z"])
        speeds = offer_messages(m, left=self.left, right=self.right)
        m.d.comb += [
            command.ready.eq(speeds.ready),
            speeds.valid.eq(command.valid),
            speeds.payload.left.data.eq(command.payload.angular.z),
            speeds.payload.right.data.eq(command.payload.linear.x),
        ]

    dut = Circuit(logic, {"command": TWIST}, {"left": FLOAT, "right": FLOAT})
    values = [twist(n, 1.0, 2.0, 3.0, 4.0, -n) for n in (0.5, 1.5, 2.5, 3.5)]
    assert run(dut, {"command": values}, 4) == {
        "left": [{"data": -n} for n in (0.5, 1.5, 2.5, 3.5)],
        "right": [{"data": n} for n in (0.5, 1.5, 2.5, 3.5)],
    }


INNER = make("ros2", {"flag": "bool", "text": "string"}, name="Inner")
MIXED = make(
    "ros2",
    {
        "number": "int32",
        "name": "string",
        "gains": "float32[3]",
        "texts": "string[2]",
        "list": "uint16[]",
        "none": (INNER, "[]"),
        "one": INNER,
        "wide": "wstring",
    },
)


def test_what_is_no_part_of_the_stream_is_constant_or_empty():
    constants = {
        "name": "a text of more than one bus word",
        "texts": ["", "two"],
        "list": [1, 2, 3, 4, 5],
        "one.text": "inner",
        "wide": "ö",
    }

    def logic(m, self):
        event = take_message(m, self.event)
        out = offer_message(m, self.out, fields=["number", "gains"], constants=constants)
        count = Signal(32)
        m.d.comb += [
            event.ready.eq(out.ready),
            out.valid.eq(event.valid),
            out.payload.number.eq(count),
            out.payload.gains[1].eq(0x3F80_0000),
        ]
        with m.If(out.valid & out.ready):
            m.d.sync += count.eq(count + 1)

    dut = Circuit(logic, {"event": EMPTY}, {"out": MIXED})
    want = {
        "number": 0,
        "gains": [0.0, 1.0, 0.0],
        "none": [],
        **{name: value for name, value in constants.items() if "." not in name},
        "one": {"flag": False, "text": "inner"},
    }
    assert run(dut, {"event": [{}] * 3}, 3) == {"out": [{**want, "number": n} for n in range(3)]}


def test_a_message_without_numbers_is_sent_on_an_event():
    text = load_message("std_msgs/msg/String")

    def logic(m, self):
        tie_off(m, self.command)
        hello = offer_message(m, self.out, constants={"data": "hello"})
        m.d.comb += hello.valid.eq(1)

    dut = Circuit(logic, {"command": TWIST}, {"out": text})
    assert run(dut, {"command": [twist(*range(6))] * 3}, 2) == {"out": [{"data": "hello"}] * 2}


def test_messages_of_converters_inside_are_taken_too():
    m = Module()
    m.submodules.rx = rx = Deserializer(TWIST)
    command = take_message(m, rx.message)
    m.d.comb += [command.ready.eq(1), rx.status.ready.eq(1)]
    with pytest.raises(wiring.ConnectionError, match="connected twice"):
        take_message(m, rx.message)


def test_parts_of_a_message_are_taken_and_ignored():
    def logic(m, self):
        tie_off(m, self.command.angular, self.command.linear.y, self.command.linear.z)
        x = self.command.linear.x
        m.d.comb += [self.out.data.payload.eq(x.payload), self.out.data.valid.eq(x.valid)]
        m.d.comb += x.ready.eq(self.out.data.ready)

    dut = Circuit(logic, {"command": TWIST}, {"out": FLOAT})
    assert run(dut, {"command": [twist(*[k] * 6) for k in (3.0, 4.0)]}, 2)["out"] == [
        {"data": 3.0},
        {"data": 4.0},
    ]
    with pytest.raises(TypeError, match=r"^A message interface is needed, not \(sig"):
        tie_off(Module(), Signal())


def test_mistakes_are_named():
    dut = Circuit(None, {"command": TWIST}, {"out": MIXED})
    m = Module()
    with pytest.raises(TypeError, match=r"whole message is needed, not 'command\.linear'$"):
        take_message(m, dut.command.linear)
    with pytest.raises(ValueError, match=r"has no field of fixed size 'linear.w'"):
        take_message(m, dut.command, fields=["linear.w"])
    for constants, text in (
        ({"names": "x"}, "has no field 'names'$"),
        ({"number": 1}, "^Field 'number' is in the stream: assign its payload$"),
        ({"list": [1 << 16]}, r"^list\[0\] must be from 0 to 65535"),
    ):
        with pytest.raises(ValueError, match=text):
            offer_message(Module(), dut.out, constants=constants)
