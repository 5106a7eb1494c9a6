"""Whole messages in a user's own testbench: an accelerator between two converters."""

from __future__ import annotations

import pytest
from amaranth.hdl import Cat, Module
from amaranth.lib import wiring

from firm_hdl.frontend import load_message
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.gateware.signatures import MessageSignature, Status
from firm_hdl.sim import (
    DeadlineError,
    MessagePort,
    Stalls,
    receive_packets,
    receive_statuses,
    send_packets,
    watch,
)
from tests.sim.components import run_testbenches
from tests.sim.test_loopback import IMAGE, JOINTS, PACKET, TRAJECTORY, VALUE
from tests.strategies import make

COLOUR = load_message("std_msgs/msg/ColorRGBA", distro="humble")
IMU = load_message("sensor_msgs/msg/Imu", distro="humble")
STALLS = [None, Stalls(0.4, 1, 4, seed=2), {"message.header": Stalls.bits("0001")}]


class Wires(wiring.Component):
    """An accelerator that does nothing, between message interfaces."""

    def __init__(self, message):
        signature = MessageSignature(message, 8)
        super().__init__({"i": wiring.In(signature), "o": wiring.Out(signature)})

    def elaborate(self, platform):
        m = Module()
        wiring.connect(m, wiring.flipped(self.i), wiring.flipped(self.o))
        return m


@pytest.mark.parametrize("stalls", STALLS)
@pytest.mark.parametrize(("message", "value"), [(IMAGE, VALUE), (JOINTS, TRAJECTORY)])
@pytest.mark.sampled(2)
def test_messages_pass_an_accelerator(message, value, stalls):
    dut = Wires(message)
    i, o = MessagePort(dut.i, message), MessagePort(dut.o, message)
    got = []

    async def source(ctx):
        for _ in range(3):
            await i.send(ctx, value, stalls=stalls)

    async def sink(ctx):
        for _ in range(3):
            got.append(await o.receive(ctx, stalls=stalls))

    names = {f"o.{leaf}": port for leaf, port in o.streams.items()}
    run_testbenches(dut, source, sink, background=[watch(names)])
    assert got == [value] * 3


@pytest.mark.parametrize("stalls", STALLS)
@pytest.mark.sampled(3)
def test_packets_become_messages(stalls):
    rx = Deserializer(IMAGE)
    port = MessagePort(rx.message, IMAGE)
    got = []

    async def source(ctx):
        await send_packets(ctx, rx.packets, [PACKET] * 2)

    async def sink(ctx):
        got.extend([await port.receive(ctx, stalls=stalls), await port.receive(ctx)])

    async def statuses(ctx):
        assert await receive_statuses(ctx, rx.status, 2) == [Status.OK] * 2

    run_testbenches(rx, source, sink, statuses)
    assert got == [VALUE] * 2


@pytest.mark.parametrize(("wire", "packet"), [("ros1", b"\7\2\0\0\0hi"), ("cdr", None)])
def test_a_port_has_the_bus_and_the_wire_of_its_converter(wire, packet):
    message, value, got = make("ros2", {"a": "uint8", "s": "string"}), {"a": 7, "s": "hi"}, []
    tx = Serializer(message, wire=wire, bus_bytes=2)
    port = MessagePort(tx.message, message, wire=wire, bus_bytes=2)
    assert port.plan.bus_bytes == 2 and port.plan.wire == wire

    async def source(ctx):
        await port.send(ctx, value)

    async def sink(ctx):
        got.extend(await receive_packets(ctx, tx.packets, 1))

    async def statuses(ctx):
        assert await receive_statuses(ctx, tx.status, 1) == [Status.OK]

    run_testbenches(tx, source, sink, statuses)
    assert got == [packet or b"\0\1\0\0\7\0\0\0\3\0\0\0hi\0"]


def test_one_message_is_taken_and_no_more():
    dut = Wires(IMU)
    i, o = MessagePort(dut.i, IMU), MessagePort(dut.o, IMU)
    transfers = [0]

    async def source(ctx):
        leaves = {leaf: [0, 0] if plan.kind != "items" else [] for leaf, plan in leaves_of(i)}
        await i.send_transfers(ctx, leaves)

    async def sink(ctx):
        arrays = {leaf for leaf, each in leaves_of(o) if each.kind == "items"}
        with pytest.raises(DeadlineError) as caught:
            await o.receive(ctx, deadline=5)
        assert str(caught.value).startswith("No transfer of a message in 6 cycles; outstanding: ")
        for leaf in arrays - {min(arrays)}:
            assert f"message.{o.plan.leaves[leaf]} (" in str(caught.value)
        _, _, *valid = await ctx.tick().sample(*(port.valid for port in o.streams.values()))
        transfers[0] = sum(valid)

    run_testbenches(dut, sink, background=[source])
    scalars = sum(leaf.kind != "items" for leaf in i.plan.leaves)
    assert transfers[0] == scalars


def leaves_of(port):
    return list(enumerate(port.plan.leaves))


@pytest.mark.parametrize("side", ["source", "sink"])
def test_stalls_of_a_leaf_are_those_that_were_asked_for(side):
    """Each leaf of a colour has one transfer, in the first cycle that its pattern lets through."""
    dut = Wires(COLOUR)
    i, o = MessagePort(dut.i, COLOUR), MessagePort(dut.o, COLOUR)
    patterns = {"message.r": "1", "message.g": "01", "message.b": "00001", "message.a": "001"}
    stalls = {leaf: Stalls.bits(pattern) for leaf, pattern in patterns.items()}
    taken = {}

    async def source(ctx):
        value = dict.fromkeys("rgba", 1.0)
        await i.send(ctx, value, stalls=stalls if side == "source" else None)

    async def sink(ctx):
        await o.receive(ctx, stalls=stalls if side == "sink" else None)

    async def observe(ctx):
        ports = list(o.streams.values())
        both = Cat(port.valid & port.ready for port in ports)
        for cycle in range(8):
            _, _, now = await ctx.tick().sample(both)
            taken.update({leaf: cycle for leaf in range(4) if now >> leaf & 1})

    run_testbenches(dut, source, sink, observe)
    assert taken == {0: 0, 1: 1, 2: 4, 3: 2}


@pytest.mark.parametrize("leaf", ["message.r", "message.a"])
def test_deadline_of_a_message_allows_for_the_longest_stall_of_any_leaf(leaf):
    dut = Wires(COLOUR)
    i, o = MessagePort(dut.i, COLOUR), MessagePort(dut.o, COLOUR)
    stalls, got = {leaf: Stalls.bits("0" * 30 + "1")}, []

    async def source(ctx):
        await i.send(ctx, dict.fromkeys("rgba", 1.0))

    async def sink(ctx):
        got.append(await o.receive(ctx, stalls=stalls, deadline=5))
        # What is offered on a leaf that has had its transfer is none.
        ctx.set(i.streams[0].valid, 1)
        await o.receive(ctx, stalls=stalls, deadline=5)

    message = r"^No transfer of a message in 36 cycles; outstanding: .*message\.g \(1\), "
    with pytest.raises(DeadlineError, match=message):
        run_testbenches(dut, source, sink)
    assert got == [dict.fromkeys("rgba", 1.0)]
