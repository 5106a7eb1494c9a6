"""Streams between core and link in simulation, and packets of messages."""

from __future__ import annotations

import random
from types import SimpleNamespace

from amaranth.hdl import Cat

from firm_hdl.node.messages import NodeMessage
from firm_hdl.plan import build_plan
from firm_hdl.sim.payloads import packet_beats
from firm_hdl.wire import lay_out
from tests.gateware.traffic import random_packets

__all__ = ["link_beats", "link_output", "messages_of", "packets_of"]


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
