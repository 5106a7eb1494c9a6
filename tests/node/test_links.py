# amaranth: UnusedElaboratable=no
"""The links, against the host's side of the frame: whole messages pass, and all else is counted."""

from __future__ import annotations

import random

import pytest
from amaranth.hdl import Module, Signal

from firm_hdl.ethernet.datagrams import datagram_layout
from firm_hdl.node import Link
from firm_hdl.node.bytestream import ByteStreamReader, write_frame
from firm_hdl.node.links import AxiDmaLink, ByteLink, StreamLink, UartLink, UdpLink
from firm_hdl.node.messages import NodeMessage
from firm_hdl.sim import Stalls
from tests.depth import by_depth
from tests.gateware.packets.bench import PacketBench, beats
from tests.node.traffic import (
    counters_of,
    frames_of,
    link_beats,
    link_output,
    messages_of,
    pieces_of,
    received_by_host,
    some,
)

STALLS = Stalls(0.25, max_cycles=5)


class LinkBench:
    """A link with both of its sides driven and watched; `design` is what it is a part of."""

    def __init__(self, link, bus, sources, outputs=None, others=None, design=None):
        self.bus = bus
        self.bench = PacketBench(
            design or link,
            {"sent": link.sent, **sources},
            {"received": link_output(link.received, bus), **(outputs or {})},
            others=others,
            final={name: link.counters[name] for name in link.counters.shape().members},
        )

    def run(self, sources, want, **options):
        seen = self.bench.run(sources, want, **({"settle": 60, "deadline": 3000} | options))
        return seen, messages_of(seen, "received"), counters_of(self.bench)


def stream_bench(bus):
    link = StreamLink(bus)
    outputs = {"frames_out": (link.frames_out, bus, link.dest)}
    return LinkBench(link, bus, {"frames_in": link.frames_in}, outputs)


@pytest.mark.parametrize("bus", by_depth([1, 8], [1, 2, 4, 8, 16]))
@pytest.mark.parametrize("stalls", by_depth([STALLS], [None, STALLS]))
@pytest.mark.sampled(2)
def test_a_stream_carries_messages_both_ways(bus, stalls):
    bench, down, up = stream_bench(bus), some(20, 1), some(20, 2)
    sources = {"frames_in": beats(frames_of(down), bus), "sent": link_beats(up, bus)}
    seen, out, counters = bench.run(sources, {"received": 20, "frames_out": 20}, stalls=stalls)
    assert out == down and counters == {"passed": 20}
    host, counts = received_by_host(seen.packets["frames_out"])
    assert host == up and counts.lost == counts.cut == 0
    assert seen.packets["frames_out"] == frames_of(up)
    assert seen.sides["frames_out"] == [{message.topic} for message in up]


def test_what_is_no_frame_of_a_stream_is_dropped():
    bench, messages = stream_bench(8), some(8, 3)
    good = frames_of(messages)
    wrong = [b"", b"\xf1", good[0][:15], b"\xf2" + good[1][1:], bytes(16), bytes(99)]
    wrong += frames_of([NodeMessage(topic=1, packet=bytes(30))], 32)
    mixed = [frame for pair in zip(good, wrong, strict=True) for frame in pair]
    _, out, counters = bench.run({"frames_in": beats(mixed, 8)}, {"received": 8})
    assert out == messages and counters == {"passed": 8, "malformed": 8}


def dma_bench(bus):
    memory = {"memory_bytes": 2048, "packets": 16, "buffer_bytes": 48}
    part = AxiDmaLink(bus, Link(kind="axi_dma", **memory))
    sources, outputs = {"pieces_in": part.pieces_in}, {"frames_out": (part.frames_out, bus, None)}
    return LinkBench(part, bus, sources, outputs)


@pytest.mark.parametrize("bus", by_depth([8], [1, 2, 4, 8, 16]))
@pytest.mark.parametrize("stalls", by_depth([STALLS], [None, STALLS]))
def test_buffers_of_a_dma_carry_messages_both_ways(bus, stalls):
    """Frames come in pieces, and whole or in fragments; none that goes is longer than a buffer."""
    bench, down, up = dma_bench(bus), some(12, 1), some(12, 2)
    frames, back = frames_of(down[:6]) + frames_of(down[6:], 48, 6), frames_of(up, 48)
    rng = random.Random(bus)
    sources = {
        "pieces_in": [bits for frame in frames for bits in pieces_of(frame, bus, rng)],
        "sent": link_beats(up, bus),
    }
    # The node is silent until the host has spoken.
    late = Stalls.bits("0" * 400 + "1" * 10**4)
    waits = {"pieces_in": stalls or Stalls(), "frames_out": stalls or Stalls(), "sent": late}
    seen, out, counters = bench.run(
        sources, {"received": 12, "frames_out": len(back)}, stalls=waits
    )
    assert out == down and counters == {"passed": 12}
    assert seen.packets["frames_out"] == back and max(map(len, back)) <= 48


def test_nothing_is_sent_to_a_dma_before_the_host_has_spoken():
    seen, _, counters = dma_bench(8).run({"sent": link_beats(some(4, 2, (40,)), 8)}, {"sent": 20})
    assert seen.packets["frames_out"] == [] and counters == {"unsent": 8}


def test_resets_of_a_dma_end_the_frames_under_way():
    """Both directions are reset after three beats of their second frames."""
    part = AxiDmaLink(8, Link(kind="axi_dma", memory_bytes=1024, packets=8, buffer_bytes=4096))
    m = Module()
    m.submodules.link = part
    came, gone, waits = Signal(16), Signal(16), Signal(8)
    down, up = some(4, 1, (64,)), some(4, 2, (64,))
    beats_of = 2 + 64 // 8
    dma, memory = (each.signature.create() for each in list(part.medium(8).values())[:2])
    # Both are held when the second frame has three beats, until the resets are over.
    holds_in = (came == beats_of + 3) & (waits != 40)
    holds_out = (gone == beats_of + 3) & (waits != 40)
    is_low = (waits >= 20) & (waits < 36)
    m.d.sync += [
        came.eq(came + (dma.valid & dma.ready)),
        gone.eq(gone + (memory.valid & memory.ready)),
        waits.eq(waits + (holds_in & holds_out)),
    ]
    m.d.comb += [
        part.mm2s_aresetn.eq(~is_low),
        part.s2mm_aresetn.eq(~is_low),
        part.pieces_in.payload.eq(dma.payload),
        part.pieces_in.valid.eq(dma.valid & ~holds_in),
        dma.ready.eq(part.pieces_in.ready & ~holds_in),
        memory.payload.eq(part.frames_out.payload),
        memory.valid.eq(part.frames_out.valid & ~holds_out),
        part.frames_out.ready.eq(memory.ready & ~holds_out),
    ]
    bench = LinkBench(part, 8, {"pieces_in": dma}, others={"frames_out": memory}, design=m)
    frames = frames_of(down)
    source = [bits for frame in frames for bits in pieces_of(frame, 8)]
    # The DMA has forgotten the rest of the second frame.
    del source[beats_of + 3 : 2 * beats_of]
    sent = link_beats(up, 8)
    seen, out, counters = bench.run(
        {"pieces_in": source, "sent": sent},
        {"received": 3, "frames_out": beats_of + 3 + 2 * beats_of},
        # The third message comes after the host has spoken again.
        stalls={"sent": Stalls.bits("0" * 60 + "1" * 14 + "0" * 200 + "1" * 10**4)},
    )
    assert out == [down[0], *down[2:]]
    assert counters == {"passed": 3, "cut": 1, "lost": 1, "unsent": 1}
    words = [bits & ((1 << 64) - 1) for bits in seen.others["frames_out"]]
    data = b"".join(word.to_bytes(8, "little") for word in words)
    whole = frames_of(up)
    assert data == whole[0] + whole[1][:24] + whole[2] + whole[3]


ADDRESS, PORT, NODE_PORT = 0xC0A80105, 5005, 7798


def words_of(datagram, words, ip=ADDRESS, port=PORT, error=0):
    """Return the words of a datagram as bits of `datagram_layout`."""
    layout = datagram_layout(words)
    out = []
    for at in range(0, max(1, len(datagram)), words):
        last = at + words >= len(datagram)
        value = {
            "data": int.from_bytes(datagram[at : at + words], "little"),
            "last": last,
            "error": last and error,
            "length": len(datagram),
            "ip_address": ip,
            "src_port": port,
            "dst_port": NODE_PORT,
        }
        out.append(sum(int(v) << layout[name].offset for name, v in value.items()))
    return out


def datagrams_of(bits, words):
    """Return the datagrams of words, each with address and port."""
    layout, out, part = datagram_layout(words), [], b""
    for each in bits:
        value = {name: each >> field.offset & ((1 << field.width) - 1) for name, field in layout}
        used = value["last_be"].bit_length() if value["last"] else words
        assert value["last_be"] in (0, 1 << used - 1) and bool(value["last_be"]) == value["last"]
        part += value["data"].to_bytes(words, "little")[:used]
        if value["last"]:
            assert value["length"] == len(part) and value["src_port"] == NODE_PORT
            out.append((part, value["ip_address"], value["dst_port"]))
            part = b""
    return out


def udp_bench(bus, **options):
    usual = {"memory_bytes": 512, "packets": 8, "datagram_bytes": 48, "port": NODE_PORT}
    link = Link(kind="udp", **(usual | options))
    part = UdpLink(bus, link)
    return LinkBench(
        part, bus, {"datagrams_in": part.datagrams_in}, others={"datagrams_out": part.datagrams_out}
    ), link.data_bytes


WIDTHS = by_depth([(8, 1), (16, 8)], [(8, 1), (8, 4), (1, 8), (16, 16), (2, 2)])


@pytest.mark.parametrize(("bus", "data_bytes"), WIDTHS)
@pytest.mark.parametrize("stalls", by_depth([STALLS], [None, STALLS]))
@pytest.mark.sampled(2)
def test_datagrams_carry_messages_both_ways(bus, data_bytes, stalls):
    memory = {"memory_bytes": 2048, "packets": 16}
    bench, words = udp_bench(bus, data_bytes=data_bytes, host="10.0.0.7", host_port=99, **memory)
    down, up = some(12, 1), some(12, 2)
    frames, answers = frames_of(down, 48), frames_of(up, 48)
    sources = {
        "datagrams_in": [w for frame in frames for w in words_of(frame, words)],
        "sent": link_beats(up, bus),
    }
    total = sum(-(-len(frame) // words) for frame in answers)
    seen, out, counters = bench.run(
        sources, {"received": 12, "datagrams_out": total}, stalls=stalls
    )
    assert out == down and counters == {"passed": 12}
    datagrams = datagrams_of(seen.others["datagrams_out"], words)
    assert datagrams == [(frame, 0x0A000007, 99) for frame in answers]


def test_a_lost_or_damaged_datagram_loses_one_message():
    bench, words = udp_bench(8)
    messages = some(12, 3, (20, 70, 100))
    frames = frames_of(messages, 48)
    numbers = [n for n, m in enumerate(messages) for _ in frames_of([m], 48)]
    lost, wrong = numbers.index(4) + 1, numbers.index(7)
    source = [
        word
        for number, frame in enumerate(frames)
        if number != lost
        for word in words_of(frame, words, error=number == wrong)
    ]
    _, out, counters = bench.run({"datagrams_in": source}, {"received": 10})
    gone = {numbers[lost], numbers[wrong]}
    assert out == [m for n, m in enumerate(messages) if n not in gone]
    assert counters["lost"] == 2 and counters["passed"] == 10


def test_the_node_answers_whom_it_heard_last():
    bench, words = udp_bench(8)
    up = some(3, 2, (20,))
    sent = link_beats(up, 8)
    frame = frames_of(some(1, 1, (5,)))[0]
    source = words_of(frame, words) + words_of(b"\xf1" * 20, words, ip=1, port=2)
    # The messages come after the host has been heard.
    late = {"sent": Stalls.bits("0" * 150 + "1" * 10**4)}
    seen, _, counters = bench.run(
        {"datagrams_in": source, "sent": sent}, {"datagrams_out": 3 * 36}, stalls=late
    )
    assert {(ip, port) for _, ip, port in datagrams_of(seen.others["datagrams_out"], 1)} == {
        (ADDRESS, PORT)
    }
    assert "unsent" not in counters


@pytest.mark.parametrize(
    ("data_bytes", "datagram_bytes", "stalls"),
    # Where the receiver stalls, the shortest datagrams follow each other without a pause.
    [(1, 48, Stalls()), (16, 32, Stalls(0.3, max_cycles=3))],
)
@pytest.mark.sampled(2)
def test_the_host_does_not_change_within_a_datagram(data_bytes, datagram_bytes, stalls):
    sizes = {"data_bytes": data_bytes, "datagram_bytes": datagram_bytes}
    bench, words = udp_bench(8, memory_bytes=4096, packets=64, **sizes)
    layout = datagram_layout(words)
    frames = frames_of(some(30, 1, (5,)))
    source = [
        word
        for number, frame in enumerate(frames)
        for word in words_of(frame, words, ip=ADDRESS + number, port=PORT + number)
    ]
    # The messages come after the first host has been heard.
    late = {"sent": Stalls.bits("0" * 60 + "1" * 10**4), "datagrams_out": stalls}
    up = some(12, 2, (32,))
    total = sum(-(-len(frame) // words) for frame in frames_of(up, datagram_bytes))
    seen, _, _ = bench.run(
        {"datagrams_in": source, "sent": link_beats(up, 8)}, {"datagrams_out": total}, stalls=late
    )
    inside, hosts = set(), set()
    for bits in seen.others["datagrams_out"]:
        names = ("ip_address", "dst_port", "last")
        address, port, last = (
            bits >> layout[name].offset & ((1 << layout[name].width) - 1) for name in names
        )
        inside.add((address, port))
        if last:
            assert len(inside) == 1
            hosts |= inside
            inside = set()
    assert all(address - ADDRESS == port - PORT for address, port in hosts) and len(hosts) > 3


def test_without_a_host_nothing_is_sent_and_all_is_counted():
    bench, _ = udp_bench(8)
    seen, _, counters = bench.run(
        {"sent": link_beats(some(4, 2, (40,)), 8)}, {"sent": 20}, settle=400
    )
    assert seen.others["datagrams_out"] == [] and counters == {"unsent": 8}


def test_messages_larger_than_the_memory_are_dropped():
    bench, words = udp_bench(8, memory_bytes=64)
    messages = some(4, 1, (40,)) + some(1, 2, (100,)) + some(3, 3, (40,))
    source = [w for frame in frames_of(messages, 48) for w in words_of(frame, words)]
    _, out, counters = bench.run({"datagrams_in": source}, {"received": 7})
    assert len(out) == 7 and counters == {"passed": 7, "large": 1}


def byte_bench(bus=8):
    part = ByteLink(bus, Link(kind="uart", memory_bytes=512, packets=8))
    return LinkBench(part, bus, {"bytes_in": part.bytes_in}, others={"bytes_out": part.bytes_out})


@pytest.mark.parametrize("bus", by_depth([8], [1, 8, 16]))
@pytest.mark.parametrize("stalls", by_depth([STALLS], [None, STALLS]))
def test_bytes_carry_messages_both_ways_through_garbage(bus, stalls):
    bench, down, up, rng = byte_bench(bus), some(8, 1), some(8, 2), random.Random(3)
    stream = b""
    for frame in frames_of(down):
        stream += rng.randbytes(rng.randrange(6)) + write_frame(frame)
    back = b"".join(map(write_frame, frames_of(up)))
    sources = {"bytes_in": list(stream), "sent": link_beats(up, bus)}
    seen, out, _ = bench.run(sources, {"received": 8, "bytes_out": len(back)}, stalls=stalls)
    assert out == down
    assert bytes(seen.others["bytes_out"]) == back
    assert received_by_host(ByteStreamReader().feed(back))[0] == up


def test_damaged_bytes_lose_their_own_frame_only():
    bench, messages, rng = byte_bench(), some(12, 5, (20, 40)), random.Random(6)
    parts = [bytearray(write_frame(frame)) for frame in frames_of(messages)]
    wrong = {3, 4, 9}
    for number in wrong:
        at = rng.randrange(1, len(parts[number]) - 1)
        parts[number][at] ^= 1 << rng.randrange(8)
    stream = b"".join(map(bytes, parts)) + b"\0\1\0\5ab\0"
    _, out, counters = bench.run({"bytes_in": list(stream)}, {"received": 9})
    assert out == [m for n, m in enumerate(messages) if n not in wrong]
    assert counters["passed"] == 9 and counters["lost"] == 3 and counters["malformed"] >= 2


def test_a_block_that_is_cut_is_no_frame_whatever_its_crc_says():
    messages = some(3, 1, (20,))
    parts = [bytearray(write_frame(frame)) for frame in frames_of(messages)]
    # The last block says that a byte more follows; those that came have the right CRC.
    at = 1
    while at + parts[1][at] < len(parts[1]) - 1:
        at += parts[1][at]
    parts[1][at] += 1
    stream = b"".join(parts)
    _, out, counters = byte_bench().run({"bytes_in": list(stream)}, {"received": 2})
    assert out == [messages[0], messages[2]]
    assert counters == {"passed": 2, "cut": 1, "lost": 1}
    assert received_by_host(ByteStreamReader().feed(stream))[0] == out


def test_a_link_stores_as_many_messages_as_it_may():
    bench = LinkBench(
        part := ByteLink(8, Link(kind="uart", memory_bytes=4096, packets=2)), 8,
        {"bytes_in": part.bytes_in},
    )  # fmt: skip
    messages = some(20, 1, (1,))
    stream = b"".join(map(write_frame, frames_of(messages)))
    late = {"received": Stalls.bits("0" * 4 * len(stream) + "1" * 10**4)}
    _, out, counters = bench.run({"bytes_in": list(stream)}, {"received": 2}, stalls=late)
    # Besides those two, some are on their way to the output.
    assert 2 <= len(out) <= 10 and counters == {"passed": len(out), "full": 20 - len(out)}


def test_a_uart_link_talks_to_itself():
    """Two links on a line, both ways at once."""
    m = Module()
    link = Link(kind="uart", memory_bytes=256, packets=4, baud=25_000_000)
    m.submodules.a = a = UartLink(8, link, 100e6)
    m.submodules.b = b = UartLink(8, link, 100e6)
    m.d.comb += [a.rx.eq(b.tx), b.rx.eq(a.tx)]
    bench = PacketBench(
        m,
        {"a": a.sent, "b": b.sent},
        {"at": link_output(a.received, 8), "bt": link_output(b.received, 8)},
    )
    there, back = some(1, 1, (5,)), some(1, 2, (0,))
    sources = {"a": link_beats(there, 8), "b": link_beats(back, 8)}
    seen = bench.run(sources, {"at": 1, "bt": 1}, deadline=4000)
    assert messages_of(seen, "bt") == there and messages_of(seen, "at") == back
