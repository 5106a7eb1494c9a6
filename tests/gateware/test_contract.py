# amaranth: UnusedElaboratable=no
"""The contract of time and order: no leaf waits for another one that it does not need."""

from __future__ import annotations

from functools import cache

import pytest
from amaranth.sim import Simulator

from firm_hdl import Deserializer, Serializer, Status
from firm_hdl.sim import (
    Harness,
    RunOptions,
    Stalls,
    encode,
    loopback,
    receive_packets,
    send_packets,
)
from firm_hdl.wire import RULES
from tests.depth import by_depth
from tests.strategies import make

PAIR = make("ros1", {"x": "uint8", "y": "uint8"})
POINT = make("ros1", {"x": "uint32", "name": "string", "y": "uint32"})


def simulate(dut, *testbenches):
    sim = Simulator(dut)
    sim.add_clock(1e-8)
    for testbench in testbenches:
        sim.add_testbench(testbench)
    sim.run()


async def put(ctx, stream, value, deadline=50):
    ctx.set(stream.payload, value)
    ctx.set(stream.valid, 1)
    for _ in range(deadline):
        _, _, ready = await ctx.tick().sample(stream.ready)
        if ready:
            ctx.set(stream.valid, 0)
            return
    raise AssertionError("not taken")


async def until_valid(ctx, stream, deadline=50):
    for _ in range(deadline):
        if ctx.get(stream.valid):
            return ctx.get(stream.payload)
        await ctx.tick()
    raise AssertionError("not valid")


def test_every_leaf_and_the_status_come_without_one_being_taken():
    dut = Deserializer(POINT)

    async def feed(ctx):
        await send_packets(ctx, dut.packets, [b"\1\0\0\0\2\0\0\0hi\7\0\0\0"])

    async def watch(ctx):
        message = dut.message
        assert await until_valid(ctx, message.x) == 1
        assert await until_valid(ctx, message.name.length) == 2
        items = await until_valid(ctx, message.name.items)
        assert [items.data[k] for k in range(3)] == [0x68, 0x69, 0]
        assert items.last
        assert await until_valid(ctx, message.y) == 7
        assert await until_valid(ctx, dut.status) == Status.OK

    simulate(dut, feed, watch)


def test_a_leaf_that_is_held_does_not_hold_an_earlier_one_of_the_next_message():
    # Both leaves are in one step; x of the second message needs the register of x alone.
    dut = Deserializer(PAIR)

    async def feed(ctx):
        await send_packets(ctx, dut.packets, [b"\1\2", b"\3\4"])

    async def take(ctx):
        assert await until_valid(ctx, dut.message.y) == 2
        ctx.set(dut.message.x.ready, 1)
        ctx.set(dut.status.ready, 1)
        await ctx.tick()
        ctx.set(dut.message.x.ready, 0)
        assert await until_valid(ctx, dut.message.x) == 3
        await ctx.tick().repeat(5)
        assert ctx.get(dut.message.y.payload) == 2
        ctx.set(dut.message.y.ready, 1)
        await ctx.tick()
        assert await until_valid(ctx, dut.message.y) == 4

    simulate(dut, feed, take)


def test_leaves_become_valid_in_wire_order():
    # The register of x is full, that of y is free: y of the second message must wait for its x.
    dut = Deserializer(PAIR)

    async def feed(ctx):
        await send_packets(ctx, dut.packets, [b"\1\2", b"\3\4"])

    async def take(ctx):
        assert await until_valid(ctx, dut.message.y) == 2
        ctx.set(dut.message.y.ready, 1)
        ctx.set(dut.status.ready, 1)
        await ctx.tick()
        for _ in range(10):
            assert not ctx.get(dut.message.y.valid)
            await ctx.tick()

    simulate(dut, feed, take)


@pytest.mark.parametrize("bus_bytes", [1, 2, 4, 8])
@pytest.mark.sampled(4)
def test_a_producer_may_offer_one_leaf_after_the_other(bus_bytes):
    dut = Serializer(POINT, bus_bytes=bus_bytes)
    result = []

    async def produce(ctx):
        message = dut.message
        for _ in range(2):
            await put(ctx, message.x, 5)
            await put(ctx, message.name.length, 1)
            await put(
                ctx, message.name.items, {"data": [0x41] + [0xEE] * (bus_bytes - 1), "last": 1}
            )
            await put(ctx, message.y, 6)

    async def consume(ctx):
        ctx.set(dut.status.ready, 1)
        result.extend(await receive_packets(ctx, dut.packets, 2))

    simulate(dut, produce, consume)
    # Values of unused lanes do not reach the wire.
    assert result == [b"\5\0\0\0\1\0\0\0A\6\0\0\0"] * 2


def test_status_waits_until_it_is_taken_and_holds_the_next_packet():
    dut = Deserializer(make("ros1", {"x": "uint8"}))

    async def feed(ctx):
        await send_packets(ctx, dut.packets, [b"\1", b"", b"\3"])

    async def take(ctx):
        ctx.set(dut.message.x.ready, 1)
        await ctx.tick().repeat(20)
        got = []
        for _ in range(3):
            got.append(await until_valid(ctx, dut.status))
            ctx.set(dut.status.ready, 1)
            await ctx.tick()
            ctx.set(dut.status.ready, 0)
        assert got == [Status.OK, Status.TRUNCATED, Status.OK]

    simulate(dut, feed, take)


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("dialect", "bus_bytes"),
    by_depth([("ros1", 8), ("ros2", 1)], [(d, b) for d in ("ros1", "ros2") for b in (1, 2, 4, 8)]),
)
def test_an_empty_sequence_in_an_element_does_not_end_the_message(dialect, bus_bytes):
    # The rest of a sequence has a step of its own here, which is the last one or goes on with the
    # next element. A packet leaves this step out if it is the last one and there is no rest.
    element = make(dialect, {"x": "uint64", "a": "uint8[]"}, "E")
    message = make(dialect, {"e": (element, "[]")})
    packet = b"\0\1\0\0" * (dialect == "ros2")
    body = b"\5\0\0\0"
    for items in (b"", b"", b"ab", b"abcdefghi", b""):
        body += bytes(-len(body) % 8) if dialect == "ros2" else b""
        body += b"\7" + bytes(7) + len(items).to_bytes(4, "little") + items
    packet += body
    packets, statuses = loopback(message, [packet] * 2, bus_bytes=bus_bytes)
    assert packets == [packet] * 2
    assert statuses == [Status.OK] * 2


@pytest.mark.parametrize("kinds", [("uint8[]", "uint8[<=1]"), ("uint8[<=1]", "uint8[]")])
@pytest.mark.sampled(2)
def test_a_long_sequence_and_a_short_one_have_a_counter_for_the_long_one(kinds):
    message = make("ros2", dict(zip("ab", kinds, strict=True)))
    long, short = (300).to_bytes(4, "little") + bytes(range(150)) * 2, b"\1\0\0\0\7"
    parts = (long, short) if kinds[0] == "uint8[]" else (short + bytes(3), long)
    packet = b"\0\1\0\0" + b"".join(parts)
    packets, statuses = loopback(message, [packet] * 2, bus_bytes=1, max_message_bytes=512)
    assert (packets, statuses) == ([packet] * 2, [Status.OK] * 2)


@pytest.mark.parametrize("bus_bytes", by_depth([1, 8], [1, 2, 4, 8]))
@pytest.mark.parametrize("field", ["uint8", "uint16[2]", "uint8[40]", "float64[9]", "string"])
@pytest.mark.sampled(4)
def test_a_packet_begins_only_with_its_message(field, bus_bytes):
    # On a narrow bus, the encapsulation header has beats of its own.
    dut = Serializer(make("ros2", {"x": field}), bus_bytes=bus_bytes)

    async def watch(ctx):
        ctx.set(dut.packets.ready, 1)
        for _ in range(20):
            await ctx.tick()
            assert not ctx.get(dut.packets.valid)

    simulate(dut, watch)


def test_a_length_over_its_bound_is_sent_as_promised_and_marked():
    message = make("ros2", {"name": "string<=3", "z": "uint8"})
    five = {0: [5], 1: [((1, 2, 3, 4, 5, 0, 0, 0), True)], 2: [9]}
    good = {0: [1], 1: [((7, 0, 0, 0, 0, 0, 0, 0), True)], 2: [8]}
    sent = encode(message, [five, good])
    assert sent.statuses == [Status.LENGTH, Status.OK]
    assert sent.packet_errors == [True, False]
    assert sent.packets == [
        b"\0\1\0\0\6\0\0\0\1\2\3\4\5\0\x09",
        b"\0\1\0\0\2\0\0\0\7\0\x08",
    ]


@pytest.mark.parametrize("count", [3, 8, 40])
@pytest.mark.sampled(3)
def test_elements_far_over_their_bound_are_all_sent(count):
    message = make("ros1", {"e": (make("ros1", {"x": "uint8"}, "E"), "[<=2]"), "z": "uint8"})
    items = list(range(count))
    sent = encode(message, [{0: [count], 1: items, 2: [9]}, {0: [1], 1: [7], 2: [8]}])
    assert sent.statuses == [Status.LENGTH, Status.OK]
    assert sent.packet_errors == [True, False]
    packet = count.to_bytes(4, "little") + bytes(items) + b"\x09"
    assert sent.packets == [packet, b"\1\0\0\0\7\x08"]


@cache
def converters(bus_bytes, *fields):
    """Return both converters of a type, in series: they are built once for all packets."""
    message = make("ros2", dict(fields))
    return Harness(*(kind(message, bus_bytes=bus_bytes) for kind in (Deserializer, Serializer)))


@pytest.mark.parametrize("slack", range(6))
@pytest.mark.sampled(6)
def test_cdr_packets_may_be_padded_by_up_to_three_bytes(slack):
    packet = b"\0\1\0\0\5\0\0\0"
    for bus_bytes in by_depth((1, 8, 16), (1, 2, 4, 8, 16)):
        both = converters(bus_bytes, ("x", "uint32"))
        seen = both.run_packets([packet + bytes(slack), packet])
        assert seen.packets == [packet, packet]
        assert list(seen.statuses) == [Status.OK if slack <= 3 else Status.TRAILING, Status.OK]


@pytest.mark.parametrize("bus_bytes", by_depth([1, 8], [1, 2, 4, 8]))
@pytest.mark.parametrize("slack", range(5))
@pytest.mark.sampled(10)
def test_padding_may_come_long_after_the_message(bus_bytes, slack):
    # The step that ends the message does not see where the packet ends, and its own end is where no
    # step starts.
    fixed = converters(bus_bytes, ("x", "uint16"))
    text = converters(bus_bytes, ("x", "uint16"), ("s", "string"))
    start = [0, 1, 0, 0, 7, 7]
    texts = [[*start, 0, 0, count + 1, 0, 0, 0, *range(1, count + 1), 0] for count in range(9)]
    for both, packets in (
        (fixed, [start] * 2),
        (text, [each for each in texts for _ in range(by_depth(1, 2))]),
    ):
        seen = both.run_packets(
            [bytes([*packet, *[0xFF] * slack]) for packet in packets],
            RunOptions(stalls={"packets_in": Stalls.bits("10000")}),
        )
        wanted = Status.OK if slack <= 3 else Status.TRAILING
        assert list(seen.statuses) == [wanted] * len(packets)


@pytest.mark.parametrize("bus_bytes", [1, 8, 32])
@pytest.mark.sampled(4)
def test_a_message_of_many_empty_ones_is_an_empty_packet(bus_bytes):
    empty = make("ros1", {}, "E")
    nested = make("ros1", {"e": empty}, "N")
    message = make("ros1", {"a": empty, "b": (nested, "[2]"), "c": empty})
    packets, statuses = loopback(message, [b"", b"", b"x"], bus_bytes=bus_bytes)
    assert packets == [b"", b"", b""]
    assert statuses == [Status.OK, Status.OK, Status.TRAILING]


def test_a_cdr_string_of_length_zero_is_empty():
    message = make("ros2", {"s": "string", "x": "uint32"})
    packets, statuses = loopback(message, [b"\0\1\0\0\0\0\0\0\5\0\0\0"])
    assert statuses == [Status.OK]
    assert packets == [b"\0\1\0\0\1\0\0\0\0\0\0\0\5\0\0\0"]


@pytest.mark.parametrize(
    ("argument", "value", "error"),
    [
        ("bus_bytes", 3, "Bus width must be one of 1, 2, 4, 8, 16, 32, 64 bytes, not 3"),
        ("wire", "can", f"Wire must be one of {', '.join(map(repr, RULES))}, not 'can'"),
        (
            "max_message_bytes",
            1,
            "Maximum message size must be from 2 bytes, the least that a p/T has, to 4294967295, "
            "not 1",
        ),
    ],
)
def test_wrong_arguments_are_refused(argument, value, error):
    for converter in (Deserializer, Serializer):
        with pytest.raises(ValueError) as caught:
            converter(make("ros1", {"x": "uint8", "y": "uint8"}, "T"), **{argument: value})
        assert str(caught.value) == error
