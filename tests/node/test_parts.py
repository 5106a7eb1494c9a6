# amaranth: UnusedElaboratable=no
"""The parts of links and of the core, against the host's side of the frame and a second COBS."""

from __future__ import annotations

import random
from types import SimpleNamespace

import pytest
from amaranth.hdl import Const, Module, Mux, Signal
from amaranth.sim import Simulator

from firm_hdl.node.bytestream import write_frame
from firm_hdl.node.description import Link, Store
from firm_hdl.node.gateware.clock import NodeClock
from firm_hdl.node.gateware.cobs import ByteFrameReader, CobsDecoder, CobsEncoder
from firm_hdl.node.gateware.fragments import Fragmenter, Reassembler
from firm_hdl.node.gateware.services import RequestGate
from firm_hdl.node.gateware.uart import UartReceiver, UartTransmitter
from firm_hdl.node.links import UartLink
from firm_hdl.node.messages import MessageSender, NodeMessage
from firm_hdl.sim import Stalls
from tests.depth import by_depth
from tests.gateware.packets.bench import PacketBench, beats, with_side
from tests.node import cobs
from tests.node.traffic import counters_of, frames_of, received_by_host, some
from tests.strategies import make

STALLS = Stalls(0.25, max_cycles=5)
BUSES = by_depth([1, 8], [1, 2, 4, 8, 16])


def run_fragmenter(bus, frame_bytes, messages, stalls=None):
    part = Fragmenter(bus, frame_bytes)
    bench = PacketBench(part, {"i": part.i}, {"o": (part.frames, bus, part.size)})
    count = len(frames_of(messages, frame_bytes))
    seen = bench.run({"i": beats(frames_of(messages), bus)}, {"o": count}, stalls=stalls)
    assert seen.sides["o"] == [{len(frame)} for frame in seen.packets["o"]]
    return seen.packets["o"]


@pytest.mark.parametrize("bus", BUSES)
@pytest.mark.sampled(2)
def test_fragments_are_those_of_the_host(bus):
    messages = some(12, bus)
    for stalls in (None, STALLS):
        assert run_fragmenter(bus, 48, messages, stalls) == frames_of(messages, 48)


def reassemble(bus, frames, bad=(), stalls=None):
    """Return the messages that are whole, and the counters."""
    part = Reassembler(bus)
    bench = PacketBench(
        part,
        {"i": with_side(part.i, part.bad)},
        {"o": (part.o, bus, part.abort & part.o.payload.last)},
        final={"lost": part.lost}
        | {name: part.counters[name] for name in part.counters.shape().members},
    )
    sides = [number in bad for number in range(len(frames))]
    source = list(beats(frames, bus, [(lambda last, b=b: b & last) for b in sides]))
    seen = bench.run({"i": source}, {"i": len(source)}, stalls=stalls, settle=80, deadline=200)
    whole = [
        packet
        for packet, sides in zip(seen.packets["o"], seen.sides["o"], strict=True)
        if 1 not in sides
    ]
    aborted = len(seen.packets["o"]) - len(whole)
    return received_by_host(whole)[0], aborted, counters_of(bench)


@pytest.mark.parametrize("bus", BUSES)
@pytest.mark.sampled(2)
def test_fragments_become_messages(bus):
    messages = some(20, 7)
    for stalls in (None, STALLS):
        out, aborted, counters = reassemble(bus, frames_of(messages, 48), stalls=stalls)
        assert (out, aborted, counters) == (messages, 0, {})


@pytest.mark.parametrize("bus", BUSES)
@pytest.mark.parametrize("seed", range(by_depth(2, 30)))
@pytest.mark.sampled(2)
def test_losses_repeats_and_damage_are_as_on_the_host(bus, seed):
    """The host's receiver is the model; only the order of fragments is not changed."""
    rng = random.Random(seed)
    messages = some(30, seed)
    frames = []
    for frame in frames_of(messages, 48, sequence=65530):
        what = rng.random()
        if what < 0.1:
            continue
        frames += [frame] * (1 + (what < 0.2 and frame[14:][:2] == b"\0\0"))
        if what > 0.95:
            frames.append(rng.randbytes(rng.choice((0, 3, 15, 16, 40))))
    out, aborted, counters = reassemble(bus, frames)
    host, expected = received_by_host(frames)
    assert out == host
    assert counters.get("lost", 0) == expected.lost
    assert counters.get("malformed", 0) == expected.malformed
    assert aborted == counters.get("cut", 0)


@pytest.mark.parametrize("seed", range(by_depth(1, 10)))
def test_damaged_numbers_are_believed_as_on_the_host(seed):
    rng = random.Random(seed)
    frames = []
    for number in range(200):
        bit = 1 << rng.randrange(16) if rng.random() < 0.1 else 0
        message = NodeMessage(topic=1, packet=b"%d" % number)
        frames += MessageSender(sequence=(65500 + number) ^ bit, starts=False).frames(message)
    out, _, counters = reassemble(8, frames)
    host, expected = received_by_host(frames)
    assert out == host
    assert (counters["lost"], counters["late"]) == (expected.lost, expected.late)
    # A number is wrong by thousands in a third of them.
    assert expected.lost < 200


BLOCKS = [b"a", b"\0", b"\0\0", b"ab\0", b"\0a", *(b"\1" * n for n in (253, 254, 255, 508, 509))]
BLOCKS += [b"\1" * 253 + b"\0", b"\1" * 254 + b"\0", b"\1" * 254 + b"\0\1", bytes(300)]


@pytest.mark.parametrize("stalls", by_depth([STALLS], [None, STALLS]))
def test_the_encoder_is_cobs(stalls):
    part = CobsEncoder()
    want = b"".join(b"\0" + cobs.encode(block) + b"\0" for block in BLOCKS)
    bench = PacketBench(part, {"i": part.i}, {}, others={"o": part.o})
    seen = bench.run({"i": beats(BLOCKS, 1)}, {"o": len(want)}, stalls=stalls, deadline=700)
    assert bytes(seen.others["o"]) == want


@pytest.mark.parametrize("stalls", by_depth([STALLS], [None, STALLS]))
def test_the_decoder_undoes_cobs(stalls):
    part = CobsDecoder()
    stream = b"".join(b"\0" + cobs.encode(block) + b"\0" for block in BLOCKS) + b"\0\5ab\0"
    total = sum(len(block) + 1 for block in BLOCKS) + 3
    bench = PacketBench(part, {"i": part.i}, {}, others={"o": part.o})
    seen = bench.run({"i": list(stream)}, {"o": total}, stalls=stalls, deadline=700)
    found, block = [], b""
    for bits in seen.others["o"]:
        if bits >> 8 & 1:
            found.append((block, bits >> 9))
            block = b""
        else:
            block += bytes([bits & 255])
    assert found == [*((block, 0) for block in BLOCKS), (b"ab", 1)]


def test_a_reader_without_a_check_is_found():
    """The twin: a reader that trusts every CRC passes damage."""

    class Trusts(ByteFrameReader):
        def elaborate(self, platform):
            m = super().elaborate(platform)
            m.d.comb += m.submodules.slice.i.payload.bad.eq(0)
            return m

    for kind, flag in ((ByteFrameReader, 1), (Trusts, 0)):
        part = kind()
        stream = bytearray(write_frame(b"abcdefgh"))
        stream[4] ^= 3
        bench = PacketBench(part, {"i": part.i}, {"frames": (part.frames, 1, part.bad)})
        seen = bench.run({"i": list(stream)}, {"frames": 1})
        assert max(seen.sides["frames"][0]) == flag


def test_the_uart_sends_and_receives():
    m = Module()
    m.submodules.tx = tx = UartTransmitter(5)
    m.submodules.rx = rx = UartReceiver(5)
    m.d.comb += rx.rx.eq(tx.tx)
    bench = PacketBench(m, {"i": tx.i}, {}, others={"o": rx.o}, events={"line": (Const(1), tx.tx)})
    data = [0, 255, 0x55, 0xAA, 1, 128, *range(20)]
    seen = bench.run({"i": data}, {"o": len(data)})
    assert seen.others["o"] == data
    # Ten bits of five cycles for each byte, and their levels in the middle of each bit.
    levels = [value for _, value in seen.events["line"]]
    start = levels.index(0)
    for number, byte in enumerate(data[:4]):
        bits = [levels[start + 50 * number + 5 * bit + 2] for bit in range(10)]
        assert bits == [0, *(byte >> bit & 1 for bit in range(8)), 1]


@pytest.mark.parametrize("off", [-0.02, 0.0, 0.02])
@pytest.mark.parametrize("baud", [25_000_000, 20_400_000, 12_260_000, 12_750_000])
def test_a_uart_hears_a_sender_that_is_fast_or_slow(baud, off):
    """Bytes follow each other without a pause, and their edges are anywhere in a cycle.

    Of 100 MHz, these are 4 cycles, and rates whose nearest number of cycles is 2 % off.
    """
    link = UartLink(8, Link(kind="uart", baud=baud), 100e6)
    m = Module()
    m.submodules.part = part = UartReceiver(link.cycles)
    line = SimpleNamespace(payload=Signal(), valid=Signal(), ready=Const(1))
    m.d.comb += part.rx.eq(Mux(line.valid, line.payload, 1))
    data = [0, 255, 0x55, 0xAA, 1, 128, 0xFE, 0x7F]
    bits = "1" + "".join(f"0{f'{byte:08b}'[::-1]}1" for byte in data)
    per_bit = 100e6 / (baud * (1 + off))
    levels = [int(bits[int(cycle / per_bit)]) for cycle in range(int(len(bits) * per_bit))]
    bench = PacketBench(m, {"line": line}, {}, others={"o": part.o})
    assert bench.run({"line": levels}, {"o": len(data)}).others["o"] == data


def test_a_line_that_breaks_is_no_byte():
    """A 0 in place of the stop bit, a line that stays 0, and a glitch."""
    m = Module()
    m.submodules.part = part = UartReceiver(4)
    source = SimpleNamespace(payload=Signal(), valid=Signal(), ready=Const(1))
    m.d.comb += part.rx.eq(Mux(source.valid, source.payload, 1))
    flags = {"broken": (part.broken, Const(0, 1)), "overrun": (part.overrun, Const(0, 1))}
    bench = PacketBench(m, {"line": source}, {}, others={"o": part.o}, events=flags)
    bits = [*"0", *f"{0x5A:08b}"[::-1], *"1", *"0", *"0" * 8, *"0000", *"1", *"0", *"1" * 9]
    levels = [int(bit) for bit in bits for _ in range(4)]
    levels[-40:-36] = [1, 0, 1, 1]  # A start bit that is too short.
    seen = bench.run({"line": levels}, {"line": len(levels), "broken": 1})
    assert seen.others["o"] == [0x5A] and len(seen.events["broken"]) == 1
    late = {"o": Stalls.bits("0" * 200 + "1" * 200)}
    seen = bench.run({"line": levels[:40] * 3}, {"line": 120, "o": 1}, stalls=late, deadline=400)
    assert seen.others["o"] == [0x5A] and len(seen.events["overrun"]) == 2
    # A byte without a stop bit is no overrun, though the one before it was not taken.
    seen = bench.run({"line": levels[:92]}, {"line": 92, "o": 1}, stalls=late, deadline=400)
    assert len(seen.events["broken"]) == 1 and not seen.events["overrun"]
    with pytest.raises(ValueError, match=r"^A bit must take 4 cycles at least, not 3$"):
        UartReceiver(3)


# The gate of a service.

TEXT = make("ros1", {"text": "string"})
ROOM = 64


def packet(size):
    """Return a good request of `size` bytes."""
    return (size - 4).to_bytes(4, "little") + bytes(range(1, size - 3))


def through_gate(requests, bus=8, most=1000, **options):
    """Send pairs of a packet and a tag; return those that came out, and the counters."""
    store = Store(
        message=TEXT, max_message_bytes=most, memory_bytes=ROOM, packets=4, when_full="drop"
    )
    gate = RequestGate(bus, store, "ros1")
    bench = PacketBench(
        gate,
        {"in": with_side(gate.packets_in, gate.tag_in)},
        {"out": (gate.packets_out, bus, gate.tag_out)},
        final={name: gate.counters[name] for name in gate.counters.shape().members},
    )
    # The tag counts with the last beat alone.
    sides = [(lambda last, tag=tag: tag if last else 99) for _, tag in requests]
    source = list(beats([each for each, _ in requests], bus, sides))
    seen = bench.run({"in": source}, {"in": len(source)}, **({"settle": 120} | options))
    pairs = zip(seen.packets["out"], seen.sides["out"], strict=True)
    return [(each, tag) for each, (tag,) in pairs], counters_of(bench)


@pytest.mark.parametrize("bus", [1, 8])
@pytest.mark.sampled(2)
def test_each_cause_has_its_counter_and_good_requests_keep_their_tags(bus):
    good = [(packet(size), 1000 + size) for size in (4, 5, 12, 33, ROOM - bus)]
    bad = {
        "truncated": packet(20)[:-1],
        "trailing": packet(9) + b"x",
        "length": (997).to_bytes(4, "little") + b"abc",
        # It is a good one, but larger than the memory.
        "large": packet(ROOM + 20),
    }
    requests = []
    for number, each in enumerate(good):
        requests += [(wrong, number) for wrong in bad.values()] + [each]
    pause = {"in": Stalls.bits("0" * 40 + "1" * 40)}
    out, counters = through_gate(requests, bus, stalls=pause, settle=400, deadline=1000)
    assert out == good
    assert counters == {"passed": 5, **dict.fromkeys(bad, 5)}


def test_requests_that_nobody_takes_are_dropped_whole_and_counted():
    rng = random.Random(1)
    requests = [(packet(rng.choice((4, 12, 30))), number) for number in range(60)]
    late = {"out": Stalls.bits("0" * 300 + "1" * 10**4)}
    out, counters = through_gate(requests, stalls=late, settle=800, deadline=1000)
    assert set(out) <= set(requests)
    assert [tag for _, tag in out] == sorted(tag for _, tag in out)
    assert counters == {"passed": len(out), "full": 60 - len(out)}
    assert 3 < len(out) < 40


def test_a_request_has_the_size_that_is_allowed_at_most():
    requests = [(packet(size), size) for size in (20, 21, 19)]
    assert through_gate(requests, most=20) == (requests[::2], {"passed": 2, "length": 1})


# The clock and the counters of bytes, alone.


def simulated(part, use):
    simulator = Simulator(part)
    simulator.add_clock(1e-6)
    simulator.add_testbench(use)
    simulator.run()


@pytest.mark.parametrize("pause", range(8))
def test_a_clock_that_is_set_at_the_end_of_a_second_has_the_time_that_is_set(pause):
    clock, seen = NodeClock(100e6), []

    async def use(ctx):
        for seconds, nanoseconds, ticks in ((1, 999_999_970, pause), (7, 999_999_985, 7)):
            ctx.set(clock.to, {"sec": seconds, "nanosec": nanoseconds})
            ctx.set(clock.sets, 1)
            await ctx.tick()
            ctx.set(clock.sets, 0)
            await ctx.tick().repeat(ticks) if ticks else None
            seen.append((ctx.get(clock.time.sec), ctx.get(clock.time.nanosec)))

    simulated(clock, use)
    # The output has the time that was set 2 cycles later, of 8; a cycle has 10 ns.
    assert seen[1] == (8, 999_999_985 + 10 * 6 - 10**9)
