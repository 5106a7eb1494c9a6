"""Streams between core and link in simulation, and packets of messages."""

from __future__ import annotations

import random
from types import SimpleNamespace

from amaranth.hdl import Cat

from firm_hdl.node.messages import MessageReceiver, MessageSender, NodeMessage
from firm_hdl.plan import build_plan
from firm_hdl.sim.payloads import packet_beats
from firm_hdl.wire import lay_out
from tests.gateware.traffic import random_packets

__all__ = [
    "counters_of",
    "frames_of",
    "link_beats",
    "link_output",
    "messages_of",
    "packets_of",
    "pieces_of",
    "received_by_host",
    "some",
]

SIZES = (0, 1, 7, 8, 9, 15, 16, 17, 31, 32, 33, 48, 100)


def packets_of(message, count, seed=0, most=10**9):
    """Return good packets of a type."""
    plan = build_plan(lay_out(message), bus_bytes=8)
    found = []
    for at in range(1000):
        found += [p for p in random_packets(plan, 4, f"{seed}/{at}") if len(p) <= most]
        if len(found) >= count:
            return found[:count]
    raise AssertionError


def link_beats(messages, bus_bytes):
    """Return the beats of messages on a `LinkSignature`, as bits."""
    side_at = 8 * bus_bytes + bus_bytes.bit_length() + 1
    noise = random.Random(3)
    beats = []
    for each in messages:
        side = each.topic | each.tag << 16 | len(each.packet) << 48
        beats += [b | side << side_at for b in packet_beats(each.packet, bus_bytes, noise)]
    return beats


def pieces_of(packet, bus_bytes, rng=None):
    """Return the transfers of a packet on a stream of `pieces_layout`, as bits.

    With `rng`, it comes in pieces that start and end in any lane, and its last transfer may be
    empty; lanes without bytes have noise.
    """
    out, at = [], 0
    while at < len(packet) or not out:
        start = rng.randrange(bus_bytes) if rng else 0
        size = bus_bytes - start if rng is None or rng.random() < 0.5 else rng.randrange(bus_bytes)
        size = min(size, bus_bytes - start, len(packet) - at)
        data = rng.getrandbits(8 * bus_bytes) if rng else 0
        mask = ((1 << 8 * size) - 1) << 8 * start
        data = data & ~mask | int.from_bytes(packet[at : at + size], "little") << 8 * start
        at += size
        out.append(data | ((1 << size) - 1) << start + 8 * bus_bytes)
    if rng and rng.random() < 0.3:
        out.append(rng.getrandbits(8 * bus_bytes))
    out[-1] |= 1 << 9 * bus_bytes
    return out


def link_output(port, bus_bytes):
    """Return a `LinkSignature` as an output of a `PacketBench`."""
    payload = port.payload
    packets = SimpleNamespace(payload=payload.beat, valid=port.valid, ready=port.ready)
    return packets, bus_bytes, Cat(payload.topic, payload.tag, payload.length)


def messages_of(seen, name):
    """Return the messages of an output of `link_output`; a side that changes is an error."""
    messages = []
    for packet, sides in zip(seen.packets[name], seen.sides[name], strict=True):
        (side,) = sides
        assert side >> 48 == len(packet)
        tag = side >> 16 & 0xFFFF_FFFF
        messages.append(NodeMessage(topic=side & 0xFFFF, packet=packet, tag=tag))
    return messages


def some(count, seed=0, sizes=SIZES):
    """Return random messages."""
    rng = random.Random(seed)
    return [
        NodeMessage(
            topic=rng.getrandbits(16),
            packet=rng.randbytes(rng.choice(sizes)),
            tag=rng.getrandbits(32),
        )
        for _ in range(count)
    ]


def frames_of(messages, frame_bytes=None, sequence=0):
    """Return the frames that the host sends."""
    sender = MessageSender(frame_bytes, sequence=sequence)
    return [frame for message in messages for frame in sender.frames(message)]


def received_by_host(frames):
    """Return the messages that the host makes of frames, and its counters."""
    receiver = MessageReceiver()
    out = [m for frame in frames if (m := receiver.take(frame)) is not None]
    return out, receiver.counters


def counters_of(bench):
    """Return the counters of a `PacketBench` that are not 0."""
    return {name: value for name, value in bench.state.items() if value}
