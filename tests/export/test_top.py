"""Top levels in simulation: AXI4-Stream on one side, named ports on the other."""

from __future__ import annotations

import random
from collections.abc import Iterator
from typing import Any

import pytest
from amaranth.hdl import Elaboratable, Module, Signal
from amaranth.sim import Simulator

from firm_hdl import Deserializer, Serializer, Status, load_message
from firm_hdl.export.top import MAX_INPUT_BITS, Top, leaf_names, ports_of
from firm_hdl.frontend import Library
from firm_hdl.plan import build_plan, encode
from firm_hdl.sim import to_transfers
from firm_hdl.wire import lay_out
from tests.depth import by_depth


class Loopback(Elaboratable):
    """A deserializer and a serializer whose top levels are connected port by port, as in VHDL."""

    def __init__(self, rx: Top, tx: Top):
        self.rx, self.tx = rx, tx
        self.aclk, self.aresetn = Signal(name="aclk"), Signal(name="aresetn", init=1)

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.rx, m.submodules.tx = self.rx, self.tx
        for top in (self.rx, self.tx):
            m.d.comb += [top.aclk.eq(self.aclk), top.aresetn.eq(self.aresetn)]
        leaves = {
            port.name
            for port in ports_of(self.rx.core.plan, "deserializer")
            if port.leaf is not None
        }
        for name in sorted(leaves):
            source, sink = getattr(self.rx, name), getattr(self.tx, name)
            m.d.comb += source.eq(sink) if name.endswith("_ready") else sink.eq(source)
        m.d.comb += [self.rx.m_axis_status_tready.eq(1), self.tx.m_axis_status_tready.eq(1)]
        return m


def noisy_beats(
    packet: bytes, bus_bytes: int, noise: random.Random
) -> Iterator[tuple[int, int, bool]]:
    """Yield data, keep and last of beats, with noise in all bits that do not count."""
    for at in range(0, max(1, len(packet)), bus_bytes):
        part = packet[at : at + bus_bytes]
        last = at + bus_bytes >= len(packet)
        data = int.from_bytes(part + noise.randbytes(bus_bytes - len(part)), "little")
        keep = noise.getrandbits(bus_bytes)
        if last:
            # The first 0 of `tkeep` ends the beat; any 1 after it does not count.
            ones = (1 << len(part)) - 1
            keep = ones | keep & ~(2 * ones + 1)
        yield data, keep, last


def axi_loopback(type_: str, packets: list[bytes], *, distro: str, bus_bytes: int) -> list[Any]:
    """Send packets over AXI, check `tkeep`, and return the output packets."""
    message = load_message(type_, distro=distro)
    rx = Top(Deserializer(message, bus_bytes=bus_bytes))
    tx = Top(Serializer(message, bus_bytes=bus_bytes))
    bench = Loopback(rx, tx)
    noise = random.Random(bus_bytes)
    beats = [beat for packet in packets for beat in noisy_beats(packet, bus_bytes, noise)]
    received: list[Any] = []

    async def run(ctx: Any) -> None:
        async def edge() -> None:
            ctx.set(bench.aclk, 1)
            await ctx.delay(5e-7)
            ctx.set(bench.aclk, 0)
            await ctx.delay(5e-7)

        ctx.set(bench.aresetn, 0)
        await edge()
        ctx.set(bench.aresetn, 1)
        ctx.set(tx.m_axis_tready, 1)
        current = b""
        todo = list(beats)
        for _ in range(10 * len(beats) + 200):
            data, keep, last = todo[0] if todo else (0, 0, 0)
            ctx.set(rx.s_axis_tdata, data)
            ctx.set(rx.s_axis_tkeep, keep)
            ctx.set(rx.s_axis_tlast, last)
            ctx.set(rx.s_axis_tvalid, bool(todo))
            await ctx.delay(1e-9)
            if todo and ctx.get(rx.s_axis_tready):
                todo.pop(0)
            if ctx.get(tx.m_axis_tvalid):
                count = ctx.get(tx.m_axis_tkeep).bit_length()
                assert ctx.get(tx.m_axis_tkeep) == (1 << count) - 1
                current += ctx.get(tx.m_axis_tdata).to_bytes(bus_bytes, "little")[:count]
                if ctx.get(tx.m_axis_tlast):
                    received.append(current if not ctx.get(tx.m_axis_tuser) else None)
                    current = b""
                else:
                    assert count == bus_bytes
            await edge()
            if len(received) == len(packets):
                return

    simulator = Simulator(bench)
    simulator.add_testbench(run)
    simulator.run()
    return received


@pytest.mark.parametrize("bus_bytes", by_depth([1, 4, 8], [1, 4, 8, 64]))
@pytest.mark.sampled(4)
def test_packets_come_back(bus_bytes):
    message = load_message("std_msgs/msg/Header")
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
    packets = []
    for size in (0, 1, 2, 3, 4, 7, 8, 9):
        value = {"stamp": {"sec": -size, "nanosec": 7}, "frame_id": "x" * size}
        packets.append(encode(plan, to_transfers(plan, message, value))[0])
    assert axi_loopback("std_msgs/msg/Header", packets, distro="lyrical", bus_bytes=bus_bytes) == (
        packets
    )


def test_empty_packets_have_no_tkeep():
    packets = [b"", b"", b""]
    assert axi_loopback("std_msgs/Empty", packets, distro="noetic", bus_bytes=4) == packets


@pytest.mark.sampled(3)
@pytest.mark.parametrize("bus_bytes", [1, 4, 16])
def test_tuser_marks_the_last_beat_of_a_packet_that_is_to_be_dropped(bus_bytes):
    top = Top(Serializer(load_message("std_msgs/msg/String"), bus_bytes=bus_bytes))
    seen: list[tuple[int, int]] = []
    statuses: list[int] = []

    async def run(ctx: Any) -> None:
        ctx.set(top.m_axis_tready, 1)
        ctx.set(top.m_axis_status_tready, 1)
        # The second message's string is not complete.
        for last in (1, 0, 1):
            for port, payload in (("length", {"data": 1}), ("items", {"data": 0x61, "last": last})):
                for name, value in payload.items():
                    ctx.set(getattr(top, f"data_{port}_{name}"), value)
                await put(ctx, getattr(top, f"data_{port}_valid"), f"data_{port}_ready")
        for _ in range(40):
            await edge(ctx)

    async def put(ctx: Any, valid: Any, ready: str) -> None:
        ctx.set(valid, 1)
        while not ctx.get(getattr(top, ready)):
            await edge(ctx)
        await edge(ctx)
        ctx.set(valid, 0)

    async def edge(ctx: Any) -> None:
        await ctx.delay(1e-9)
        if ctx.get(top.m_axis_tvalid):
            seen.append((ctx.get(top.m_axis_tlast), ctx.get(top.m_axis_tuser)))
        if ctx.get(top.m_axis_status_tvalid):
            statuses.append(ctx.get(top.m_axis_status_tdata))
        ctx.set(top.aclk, 1)
        await ctx.delay(5e-7)
        ctx.set(top.aclk, 0)
        await ctx.delay(5e-7)

    simulator = Simulator(top)

    async def start(ctx: Any) -> None:
        ctx.set(top.aresetn, 1)
        await run(ctx)

    simulator.add_testbench(start)
    simulator.run()
    # Encapsulation, length, letter and NUL: 10 bytes.
    beats = -(-10 // bus_bytes)
    assert [last for last, _ in seen] == [*[0] * (beats - 1), 1] * 3
    assert [user for _, user in seen] == [*[0] * beats, *[0] * (beats - 1), 1, *[0] * beats]
    assert statuses == [Status.OK.value, Status.ITEMS.value, Status.OK.value]


@pytest.mark.parametrize("distro", ["noetic", "lyrical"])
@pytest.mark.sampled(2)
def test_no_two_ports_of_any_type_have_one_name(distro):
    library = Library(distro)
    for name in library.names():
        plan = build_plan(lay_out(library.message(name)))
        assert len(leaf_names(plan)) == len(plan.leaves)
        for direction in ("deserializer", "serializer"):
            ports = [port.name.lower() for port in ports_of(plan, direction)]
            assert len(set(ports)) == len(ports), name


def test_ports_and_their_meaning():
    plan = build_plan(lay_out(load_message("std_msgs/msg/Header")), bus_bytes=4)
    assert [
        f"{port.direction} {port.name} {port.width} {port.meaning}"
        for port in ports_of(plan, "serializer")
        if port.name.startswith(("stamp_sec", "frame_id_items"))
    ] == [
        "in stamp_sec_data 32 stamp.sec: int32 (two's complement).",
        "in stamp_sec_valid 1 stamp.sec: valid.",
        "out stamp_sec_ready 1 stamp.sec: ready.",
        "in frame_id_items_data 32 "
        "frame_id.items: 4 x uint8 (unsigned), first item in the lowest bits.",
        "in frame_id_items_last 1 frame_id.items: last transfer of the array or sequence.",
        "in frame_id_items_valid 1 frame_id.items: valid.",
        "out frame_id_items_ready 1 frame_id.items: ready.",
    ]
    assert MAX_INPUT_BITS == 65_535
