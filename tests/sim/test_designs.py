"""Mistakes in a design of a user: helpers say what is wrong, instead of giving wrong packets."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from amaranth.hdl import ClockDomain, DomainRenamer, Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out
from amaranth.sim import Simulator

from firm_hdl import (
    Deserializer,
    MessageSignature,
    PacketCrossing,
    PacketFifo,
    PacketSignature,
    Serializer,
    load_message,
)
from firm_hdl.sim import (
    ClockDomainError,
    DeadlineError,
    Harness,
    MessagePort,
    Stalls,
    receive,
    receive_packets,
    receive_statuses,
    send,
    send_packets,
    watch,
)
from firm_hdl.verilog import convert
from tests.sim.components import Relay

TWIST = load_message("geometry_msgs/msg/Twist")
POINT = load_message("geometry_msgs/msg/Point")
PACKETS = [bytes([0, 1, 0, 0, number]) + bytes(47) for number in range(4)]


class Loop(wiring.Component):
    """A deserializer, a serializer, and a crossing to another clock domain."""

    def __init__(self, connect: Callable[[Module, Any, Any], None], *, statuses: bool = True):
        self.connect, self.statuses = connect, statuses
        signature = PacketSignature(8)
        super().__init__({"packets_in": In(signature), "packets_out": Out(signature)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.rx = rx = Deserializer(TWIST)
        m.submodules.tx = tx = Serializer(TWIST)
        m.submodules.crossing = out = PacketCrossing(8, write_domain="sync", read_domain="slow")
        wiring.connect(m, wiring.flipped(self.packets_in), rx.packets)
        wiring.connect(m, tx.packets, out.packets_in)
        wiring.connect(m, out.packets_out, wiring.flipped(self.packets_out))
        self.connect(m, rx, tx)
        if self.statuses:
            m.d.comb += [rx.status.ready.eq(1), tx.status.ready.eq(1)]
        return m


def whole(m: Module, rx: Any, tx: Any) -> None:
    wiring.connect(m, rx.message, tx.message)


def simulate(design: Any, *testbenches: Any, clocks: dict[str, float] | None = None) -> None:
    simulator = Simulator(design)
    for domain, period in (clocks or {"sync": 1e-6, "slow": 3.7e-6}).items():
        simulator.add_clock(period, domain=domain)
    for testbench in testbenches:
        simulator.add_testbench(testbench)
    simulator.run()


def run(design: Any, loop: Any = None, *, domain: Any = "slow", **options: Any) -> list[bytes]:
    loop, got = loop or design, list[bytes]()

    async def source(ctx: Any) -> None:
        await send_packets(ctx, loop.packets_in, PACKETS)

    async def sink(ctx: Any) -> None:
        got.extend(await receive_packets(ctx, loop.packets_out, len(PACKETS), domain=domain))

    simulate(design, source, sink, **options)
    return got


def only_send(design: Any, part: Any = None, **options: Any) -> None:
    """Send without a receiver, which Python would miss if the first error came before it began."""

    async def source(ctx: Any) -> None:
        await send_packets(ctx, (part or design).packets_in, PACKETS, **options)

    simulate(design, source)


# Clock domains.


def test_packets_are_received_in_a_slower_domain() -> None:
    assert run(Loop(whole)) == PACKETS


@pytest.mark.parametrize("period", [0.4e-6, 3.7e-6])
def test_every_helper_has_a_domain(period: float) -> None:
    dut, got = Relay(8), list[Any]()
    top = Module()
    top.submodules.dut = DomainRenamer("link")(dut)
    top.submodules.rx = DomainRenamer("link")(rx := Deserializer(POINT))
    tick = Signal()
    top.d.sync += tick.eq(~tick)
    port = MessagePort(rx.message, POINT, domain="link")
    packet = bytes([0, 1, 0, 0]) + bytes(24)

    async def source(ctx: Any) -> None:
        await send(ctx, dut.i, range(20), domain="link", stalls=Stalls(0.3))
        await send_packets(ctx, rx.packets, [packet], domain="link")

    async def sink(ctx: Any) -> None:
        got.extend(await receive(ctx, dut.o, 20, domain="link", stalls=Stalls(0.3)))
        got.append(await port.receive(ctx))
        got.extend(await receive_statuses(ctx, rx.status, 1, domain="link"))

    simulator = Simulator(top)
    simulator.add_clock(1e-6)
    simulator.add_clock(period, domain="link")
    streams = {"i": dut.i, "o": dut.o, "packets": rx.packets}
    simulator.add_testbench(watch(streams, domain="link"), background=True)
    for each in (source, sink):
        simulator.add_testbench(each)
    simulator.run()
    assert got[:20] == list(range(20))
    assert got[20] == {"x": 0.0, "y": 0.0, "z": 0.0} and got[21].name == "OK"


@pytest.mark.parametrize(
    ("domain", "error"),
    [
        ("sync", r"^Stream 'packets_out' is in the clock domain 'slow', not in 'sync': .*'slow'$"),
        (
            "fast",
            r"^The design has no clock domain 'fast'; the names for domain= are 'slow', 'sync'",
        ),
        (ClockDomain("own"), r"^The clock domain 'own' has no clock: call add_clock"),
    ],
)
@pytest.mark.sampled(3)
def test_a_stream_in_another_domain_is_an_error(domain: Any, error: str) -> None:
    with pytest.raises(ClockDomainError, match=error):
        run(Loop(whole), domain=domain)


@pytest.mark.parametrize("when_full", ["wait", "drop"])
def test_the_domain_of_a_stream_is_that_of_its_registers(when_full: Any) -> None:
    # With "drop", `packets_in.ready` is constant, and only what reads the stream has a domain.
    fifo = PacketFifo(8, 64, 2, when_full=when_full)
    top, tick = Module(), Signal()
    top.submodules.fifo = DomainRenamer("slow")(fifo)
    top.d.sync += tick.eq(~tick)

    with pytest.raises(ClockDomainError, match="'packets_in' is in the clock domain 'slow', not"):
        only_send(top, fifo)


def test_a_domain_without_a_clock_is_an_error() -> None:
    with pytest.raises(ClockDomainError, match=r"^The clock domain 'slow' has no clock: call add_"):
        run(Loop(whole), clocks={"sync": 1e-6})


def test_a_design_in_one_renamed_domain_needs_no_domain() -> None:
    fifo = PacketFifo(8, 64, 2)
    assert run(DomainRenamer("slow")(fifo), fifo, domain="sync", clocks={"slow": 1e-6}) == PACKETS


# Connections.


def test_a_message_that_is_connected_twice_is_an_error() -> None:
    def twice(m: Module, rx: Any, tx: Any) -> None:
        m.submodules.other = other = Serializer(TWIST)
        wiring.connect(m, rx.message, tx.message)
        with pytest.raises(wiring.ConnectionError, match=r"Twist .* is connected twice in one mod"):
            wiring.connect(m, rx.message, other.message)

    assert run(Loop(twice)) == PACKETS


def test_a_message_that_comes_from_two_is_an_error() -> None:
    m, tx = Module(), Serializer(TWIST)
    wiring.connect(m, Deserializer(TWIST).message, tx.message)
    with pytest.raises(wiring.ConnectionError, match="is connected twice in one module"):
        wiring.connect(m, Deserializer(TWIST).message, tx.message)


def test_a_leaf_that_is_connected_twice_is_an_error() -> None:
    def twice(m: Module, rx: Any, tx: Any) -> None:
        m.submodules.other = other = Serializer(TWIST)
        wiring.connect(m, rx.message, tx.message)
        wiring.connect(m, rx.message.linear.x, other.message.linear.x)

    error = r"^Stream 'rx\.message\.linear\.x' is connected twice"
    with pytest.raises(wiring.ConnectionError, match=error):
        only_send(Loop(twice))
    with pytest.raises(wiring.ConnectionError, match=error):
        convert(Loop(twice))


def test_a_message_may_be_connected_in_each_elaboration_and_pass_an_interface() -> None:
    def through(m: Module, rx: Any, tx: Any) -> None:
        wire = MessageSignature(TWIST).create(path=("wire",))
        wiring.connect(m, rx.message, wiring.flipped(wire))
        wiring.connect(m, wire, tx.message)
        # A constant before a connection is a default.
        m.d.comb += rx.status.ready.eq(0)

    design = Loop(through)
    assert run(design) == run(design) == PACKETS


def test_connected_messages_of_two_types_are_named() -> None:
    m, rx, tx = Module(), Deserializer(TWIST), Serializer(POINT)
    error = r"messages geometry_msgs/msg/Twist .* and geometry_msgs/msg/Point .*: their leaves"
    with pytest.raises(wiring.ConnectionError, match=error):
        wiring.connect(m, rx.message, tx.message)


def test_a_wrong_member_is_answered_with_the_right_ones() -> None:
    rx, tx = Deserializer(TWIST), Serializer(TWIST)
    with pytest.raises(AttributeError, match=r"^Message .*Twist has no member 'spin'; it has lin"):
        rx.message.spin  # noqa: B018
    with pytest.raises(AttributeError, match=r"no member 'w'; it has x, y, z$"):
        tx.message.linear.w  # noqa: B018


# What waits.


@pytest.mark.parametrize(
    ("connect", "statuses", "error"),
    [
        (whole, False, r"offered while no logic drives `ready`: rx\.status, tx\.status; "),
        (
            lambda m, rx, tx: wiring.connect(m, rx.message.linear, tx.message.linear),
            True,
            r"no logic drives `ready`: rx\.message\.angular\.x, rx\.message\.angular\.y, .*"
            r"; offered while `ready` is low: packets_in, rx\.packets, rx\.message\.linear\.x",
        ),
    ],
)
@pytest.mark.sampled(2)
def test_the_streams_that_wait_are_named(connect: Any, statuses: bool, error: str) -> None:
    with pytest.raises(DeadlineError, match=error):
        run(Loop(connect, statuses=statuses))


def test_who_only_sends_has_a_deadline() -> None:
    error = r"^No transfer on stream 'packets_in' in 51 cycles; .*`ready`: rx\.message\.linear\.x, "
    with pytest.raises(DeadlineError, match=error):
        only_send(Loop(lambda m, rx, tx: None), deadline=50)


def test_packets_without_room_are_named() -> None:
    # A FIFO does not know the size of its packets.
    fifo = PacketFifo(8, 32, 2)
    with pytest.raises(DeadlineError, match=r"packets were dropped: PacketFifo \(4 large\)$"):
        run(fifo, domain="sync", clocks={"sync": 1e-6})


def test_a_bench_has_one_clock_domain() -> None:
    class Other(Deserializer):
        def elaborate(self, platform: object) -> Any:
            return DomainRenamer("fast")(super().elaborate(platform))

    with pytest.raises(ClockDomainError, match=r"one clock domain, 'sync'; .* 'fast'"):
        Harness(Other(TWIST), None)
