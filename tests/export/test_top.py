"""Top levels in simulation: AXI4-Stream on one side, named ports on the other."""

from __future__ import annotations

from typing import Any

import pytest
from amaranth.hdl import Elaboratable, Module, Signal
from amaranth.sim import Simulator

from firm_hdl import Deserializer, Serializer, load_message
from firm_hdl.export.top import MAX_INPUT_BITS, Top, _ones, leaf_names, ports_of
from firm_hdl.frontend import Library
from firm_hdl.plan import build_plan, encode
from firm_hdl.sim import to_transfers
from firm_hdl.wire import lay_out


class Loopback(Elaboratable):
    """A deserializer's top wired to a serializer's, port by port, as a VHDL user would do it."""

    def __init__(self, rx: Top, tx: Top):
        self.rx, self.tx = rx, tx
        self.aclk, self.aresetn = Signal(name="aclk"), Signal(name="aresetn", init=1)

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.rx, m.submodules.tx = self.rx, self.tx
        for top in (self.rx, self.tx):
            m.d.comb += [top.aclk.eq(self.aclk), top.aresetn.eq(self.aresetn)]
        leaves = {port.name for port in ports_of(self.rx.core.plan, "deserializer")
                  if port.leaf is not None}
        for name in sorted(leaves):
            source, sink = getattr(self.rx, name), getattr(self.tx, name)
            m.d.comb += source.eq(sink) if name.endswith("_ready") else sink.eq(source)
        m.d.comb += [self.rx.m_axis_status_tready.eq(1), self.tx.m_axis_status_tready.eq(1)]
        return m


def axi_loopback(type_: str, packets: list[bytes], *, distro: str, bus_bytes: int) -> list[Any]:
    """Send packets over AXI; return those that come out, checking tkeep on the way."""
    message = load_message(type_, distro=distro)
    rx = Top(Deserializer(message, bus_bytes=bus_bytes))
    tx = Top(Serializer(message, bus_bytes=bus_bytes))
    bench = Loopback(rx, tx)
    beats = []
    for packet in packets:
        for at in range(0, max(1, len(packet)), bus_bytes):
            part = packet[at : at + bus_bytes]
            data = int.from_bytes(part, "little")
            beats.append((data, (1 << len(part)) - 1, at + bus_bytes >= len(packet)))
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


@pytest.mark.parametrize("bus_bytes", [1, 4, 8, 64])
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


def test_tkeep_counts_up_to_the_first_zero():
    class Count(Elaboratable):
        def __init__(self) -> None:
            self.keep, self.count = Signal(5), Signal(8)

        def elaborate(self, platform: object) -> Module:
            m = Module()
            m.d.comb += self.count.eq(_ones(self.keep))
            return m

    dut = Count()

    async def run(ctx: Any) -> None:
        for keep in range(32):
            ctx.set(dut.keep, keep)
            await ctx.delay(1e-9)
            want = next(n for n in range(6) if n == 5 or not keep >> n & 1)
            assert ctx.get(dut.count) == want

    simulator = Simulator(dut)
    simulator.add_testbench(run)
    simulator.run()


@pytest.mark.parametrize("distro", ["noetic", "lyrical"])
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
        "in stamp_sec_valid 1 stamp.sec: offered.",
        "out stamp_sec_ready 1 stamp.sec: taken.",
        "in frame_id_items_data 32 "
        "frame_id.items: 4 x uint8 (unsigned), the first item in the lowest bits.",
        "in frame_id_items_last 1 frame_id.items: the transfer ends its array.",
        "in frame_id_items_valid 1 frame_id.items: offered.",
        "out frame_id_items_ready 1 frame_id.items: taken.",
    ]
    assert MAX_INPUT_BITS == 65_535
