# amaranth: UnusedElaboratable=no
"""The record view: a message as one structure with one `valid`."""

from __future__ import annotations

from functools import partial

import pytest
from amaranth.back import rtlil
from amaranth.hdl import ClockDomain, Module, signed, unsigned
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out, connect, flipped
from amaranth.sim import Simulator

from firm_hdl import (
    Deserializer,
    PacketSignature,
    RecordReader,
    RecordWriter,
    Serializer,
    Status,
    StatusSignature,
    load_message,
    record_layout,
)
from firm_hdl.gateware import record
from firm_hdl.plan import encode
from firm_hdl.sim import receive_packets, receive_statuses, send_packets, to_transfers
from tests.depth import by_depth
from tests.strategies import make

POINT = make("ros1", {"x": "uint16", "y": "int16"}, "Point")
SHAPE = make(
    "ros1",
    {"name": "string", "corners": (POINT, "[3]"), "holes": "uint8[11]", "closed": "bool"},
)
SHAPE_FIELDS = "corners, holes, closed"


class Loop(wiring.Component):
    """A deserializer, a reader, a writer and a serializer."""

    def __init__(self, message, **options):
        self.parts = {
            "rx": Deserializer(message, bus_bytes=options.get("bus_bytes", 8)),
            "reader": RecordReader(message, **options),
            "writer": RecordWriter(message, **options),
            "tx": Serializer(message, bus_bytes=options.get("bus_bytes", 8)),
        }
        width = options.get("bus_bytes", 8)
        super().__init__(
            {
                "i": In(PacketSignature(width)),
                "o": Out(PacketSignature(width)),
                "rx_status": Out(StatusSignature()),
                "tx_status": Out(StatusSignature()),
            }
        )

    def elaborate(self, platform):
        m = Module()
        for name, part in self.parts.items():
            m.submodules[name] = part
        rx, reader, writer, tx = self.parts.values()
        connect(m, flipped(self.i), rx.packets)
        connect(m, rx.message, reader.message)
        connect(m, reader.record, writer.record)
        if hasattr(reader, "rest"):
            connect(m, reader.rest, writer.rest)
        connect(m, writer.message, tx.message)
        connect(m, tx.packets, flipped(self.o))
        connect(m, rx.status, flipped(self.rx_status))
        connect(m, tx.status, flipped(self.tx_status))
        return m


def through(message, packets, **options):
    dut = Loop(message, **options)
    out = []

    async def source(ctx):
        await send_packets(ctx, dut.i, packets)

    async def sink(ctx):
        out.extend(await receive_packets(ctx, dut.o, len(packets)))

    async def statuses(ctx, port):
        assert await receive_statuses(ctx, port, len(packets)) == [Status.OK] * len(packets)

    sim = Simulator(dut)
    sim.add_clock(1e-8)
    sim.add_testbench(source)
    sim.add_testbench(sink)
    # `last` of each array counts, too, which packets do not show.
    for port in (dut.rx_status, dut.tx_status):
        sim.add_testbench(partial(statuses, port=port))
    sim.run()
    return out


def packets_of(message, values, bus_bytes=8):
    plan = Deserializer(message, bus_bytes=bus_bytes).plan
    return [encode(plan, to_transfers(plan, message, value))[0] for value in values]


def test_the_layout_has_the_fields_of_the_message():
    vector = data.StructLayout({axis: unsigned(64) for axis in "xyz"})
    assert record_layout(load_message("geometry_msgs/msg/Twist")) == data.StructLayout(
        {"linear": vector, "angular": vector}
    )
    assert record_layout(SHAPE) == data.StructLayout(
        {
            "corners": data.ArrayLayout(data.StructLayout({"x": unsigned(16), "y": signed(16)}), 3),
            "holes": data.ArrayLayout(unsigned(8), 11),
            "closed": unsigned(1),
        }
    )


@pytest.mark.parametrize(
    ("fields", "bus_bytes"),
    by_depth(
        [(None, 16), (["corners"], 8), (["holes", "closed"], 1), (["holes", "closed"], 8)],
        [(f, b) for f in (None, ["corners"], ["holes", "closed"]) for b in (1, 4, 8, 16)],
    ),
)
@pytest.mark.sampled(4)
def test_records_come_through_with_the_rest_beside_them(bus_bytes, fields):
    values = [
        {
            "name": "abcdefghij"[:count],
            "corners": [{"x": 3 * count + k, "y": -k} for k in range(3)],
            "holes": [count + k for k in range(11)],
            "closed": bool(count % 2),
        }
        for count in (0, 3, 8)
    ]
    packets = packets_of(SHAPE, values, bus_bytes)
    assert through(SHAPE, packets, bus_bytes=bus_bytes, fields=fields) == packets


@pytest.mark.parametrize(
    ("dialect", "member"), [("ros1", "trigger"), ("ros2", "structure_needs_at_least_one_member")]
)
@pytest.mark.parametrize("bus_bytes", [1, 8])
@pytest.mark.sampled(2)
def test_an_empty_message_is_a_member_of_a_record(dialect, member, bus_bytes):
    empty = make(dialect, {}, "Empty")
    message = make(dialect, {"a": "uint8", "e": empty, "b": "uint16", "es": (empty, "[2]")})
    layout = record_layout(message)
    assert [name for name, _ in layout["e"].shape] == [member]
    octet = {"a": 7, "e": {}, "b": 515, "es": [{}, {}]}
    packets = packets_of(message, [octet, {**octet, "a": 9}], bus_bytes)
    assert through(message, packets, bus_bytes=bus_bytes) == packets


@pytest.mark.parametrize(
    ("message", "fields", "error"),
    [
        (
            SHAPE,
            ["corner"],
            "Message p/T has no field of fixed size 'corner'; it has " + SHAPE_FIELDS,
        ),
        (
            SHAPE,
            ["name"],
            "Message p/T has no field of fixed size 'name'; it has " + SHAPE_FIELDS,
        ),
        (
            make("ros1", {"s": "string"}),
            None,
            "Message p/T has no field of fixed size for a record; its fields: s (string)",
        ),
        (
            make("ros1", {"a": "uint64[1025]"}),
            None,
            "Record of p/T is too wide: a has 65600 bits, and Amaranth elaborates at most 65535",
        ),
        (
            make("ros1", {"a": "uint64[600]", "b": "uint64[600]"}),
            None,
            "Record of p/T is too wide: record has 76800 bits, and Amaranth elaborates at most "
            "65535",
        ),
    ],
)
def test_messages_without_a_record_are_refused(message, fields, error):
    with pytest.raises(ValueError) as caught:
        record_layout(message, fields=fields)
    assert str(caught.value) == error


@pytest.mark.parametrize("bits", [64, 130, 200])
@pytest.mark.sampled(4)
def test_arrays_are_collected_in_registers_that_amaranth_can_elaborate(monkeypatch, bits):
    monkeypatch.setattr(record, "MAX_CELL_BITS", bits)
    message = make("ros1", {"rows": (make("ros1", {"row": "uint8[9]"}, "Row"), "[5]")})
    values = [
        {"rows": [{"row": [(k * j + start) % 256 for j in range(9)]} for k in range(5)]}
        for start in (0, 1)
    ]
    packets = packets_of(message, values)
    assert through(message, packets) == packets


def test_lanes_that_no_record_has_may_be_wider_than_a_cell(monkeypatch):
    # 650 bytes, which take 1280 lanes.
    monkeypatch.setattr(record, "MAX_CELL_BITS", 8 * 1000)
    message = make("ros1", {"rows": (make("ros1", {"row": "uint8[65]"}, "Row"), "[10]")})
    for adapter in (RecordReader, RecordWriter):
        assert rtlil.convert(adapter(message, bus_bytes=64))


# Arrays of several transfers, which counters collect and split.
MANY = make("ros1", {"a": "uint8[5]", "z": "uint8"})


def run_with_reset(dut, before, after):
    """Run testbenches before and after a reset of one cycle."""
    top = Module()
    top.domains.sync = domain = ClockDomain("sync")
    top.submodules.dut = dut

    async def testbench(ctx):
        await before(ctx)
        ctx.set(domain.rst, 1)
        await ctx.tick()
        ctx.set(domain.rst, 0)
        await after(ctx)

    simulator = Simulator(top)
    simulator.add_clock(1e-6)
    simulator.add_testbench(testbench)
    simulator.run()


@pytest.mark.parametrize("count", [1, 2, 3])
def test_reset_of_the_reader_discards_collected_items(count):
    dut = RecordReader(MANY, bus_bytes=2)
    a, z = dut.message.a.items, dut.message.z

    async def give(ctx, values):
        for value in values:
            ctx.set(a.payload, {"data": value, "last": 0})
            ctx.set(a.valid, 1)
            assert ctx.get(a.ready)
            await ctx.tick()
        ctx.set(a.valid, 0)

    async def before(ctx):
        await give(ctx, [(91, 92)] * count)

    async def after(ctx):
        await give(ctx, [(1, 2), (3, 4), (5, 0)])
        assert not ctx.get(dut.record.valid)
        ctx.set(z.payload, 6)
        ctx.set(z.valid, 1)
        assert ctx.get(dut.record.valid)
        payload = ctx.get(dut.record.payload)
        assert (list(payload["a"]), payload["z"]) == ([1, 2, 3, 4, 5], 6)

    run_with_reset(dut, before, after)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_writer_begins_again(count):
    dut = RecordWriter(MANY, bus_bytes=2)
    a = dut.message.a.items

    async def take(ctx, number):
        got = []
        for _ in range(number):
            assert ctx.get(a.valid)
            payload = ctx.get(a.payload)
            got.append((tuple(payload.data), payload.last))
            ctx.set(a.ready, 1)
            await ctx.tick()
        ctx.set(a.ready, 0)
        return got

    async def before(ctx):
        ctx.set(dut.record.payload, {"a": [9] * 5, "z": 9})
        ctx.set(dut.record.valid, 1)
        await take(ctx, count)
        ctx.set(dut.record.valid, 0)

    async def after(ctx):
        ctx.set(dut.record.payload, {"a": [1, 2, 3, 4, 5], "z": 6})
        ctx.set(dut.record.valid, 1)
        assert await take(ctx, 3) == [((1, 2), 0), ((3, 4), 0), ((5, 0), 1)]
        assert not ctx.get(a.valid)

    run_with_reset(dut, before, after)


@pytest.mark.parametrize("adapter", [RecordReader, RecordWriter])
def test_fields_are_a_list_of_names(adapter):
    message = make("ros1", {"a": "uint8", "b": "uint8"})
    with pytest.raises(TypeError, match=r"^Fields must be a list of names, not the text 'a'$"):
        adapter(message, fields="a")
    adapter(message, fields=["a"])


def test_a_layout_is_that_of_its_wire():
    """CDR gives a message without fields a byte; on the wire of ROS 1, it is a trigger."""
    message = make("ros2", {"a": "uint8", "e": make("ros2", {}, "Empty")})
    sizes = {wire: record_layout(message, wire=wire).size for wire in (None, "cdr", "ros1")}
    assert sizes[None] == sizes["cdr"] != sizes["ros1"]
    for wire in ("cdr", "ros1"):
        assert RecordReader(message, wire=wire).record.payload.shape().size == sizes[wire]
