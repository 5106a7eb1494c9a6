"""The sender beside a cache that is played: a machine whose entry is stale is asked again."""

from __future__ import annotations

import pytest
from amaranth.sim import Simulator

from firm_hdl.ethernet.sender import FrameSender
from tests.ethernet.bench import HOST, HOST_MAC, MAC, NODE, number

scapy = pytest.importorskip("scapy.layers.inet")
ARP = pytest.importorskip("scapy.layers.l2").ARP


def number_of(mac):
    return int(mac.replace(":", ""), 16)


def test_a_stale_machine_gets_its_datagram_and_is_asked_again_once():
    sender = FrameSender(number_of(MAC), number(NODE), 24, 0, (), 100)
    header = bytes(6) + number(HOST).to_bytes(4, "big") + bytes([0, 33]) + bytes(4)
    header += bytes.fromhex("1ce80007000d0000") + bytes(8)
    slot, out, frames, releases = sender.datagrams, sender.frames, [], []

    async def test(ctx):
        ctx.set(slot.full, 1)
        ctx.set(slot.payload_byte, 0x5A)
        ctx.set(out.ready, 1)
        ctx.set(sender.mac, number_of(HOST_MAC))
        part = bytearray()
        for _ in range(400):
            ctx.set(slot.header_byte, header[ctx.get(slot.header_at)])
            for name in ("found", "stale", "done"):
                ctx.set(getattr(sender, name), ctx.get(sender.look))
            valid, payload, release = (ctx.get(v) for v in (out.valid, out.payload, slot.release))
            if valid:
                part.append(payload.data)
                if payload.last:
                    frames.append(scapy.Ether(bytes(part)))
                    part.clear()
            releases.append(release)
            await ctx.tick()

    simulator = Simulator(sender)
    simulator.add_clock(1e-6)
    simulator.add_testbench(test)
    simulator.run()
    ask = frames.pop(1)
    assert (ask[ARP].op, ask[ARP].pdst, ask[ARP].psrc) == (1, HOST, NODE)
    assert len(frames) >= 3 and sum(releases) == len(frames)
    for frame in frames:
        assert (frame.dst, frame[scapy.IP].dst) == (HOST_MAC, HOST)
        assert bytes(frame[scapy.UDP].payload) == b"\x5a" * 5
