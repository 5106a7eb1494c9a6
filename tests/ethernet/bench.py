"""An edge in simulation: symbols and datagrams go in, frames and datagrams come out."""

from __future__ import annotations

import binascii
import random
from collections import Counter
from dataclasses import dataclass, field

from amaranth.sim import Simulator

from firm_hdl.ethernet.drops import DROPS
from firm_hdl.ethernet.edge import EthernetEdge, EthernetSettings

MAC, HOST_MAC, OTHER_MAC = "02:00:00:00:00:01", "02:11:22:33:44:55", "02:66:77:88:99:aa"
NODE, HOST, OTHER, GROUP = "192.168.1.50", "192.168.1.9", "192.168.1.77", "239.255.0.1"
GROUP_MAC = "01:00:5e:7f:00:01"
PREAMBLE = bytes([0x55] * 7 + [0xD5])


def number(address):
    """Return an address of IPv4 as a number."""
    return int.from_bytes(bytes(map(int, address.split("."))), "big")


def settings(**options):
    usual = {
        "mac": int(MAC.replace(":", ""), 16),
        "address": number(NODE),
        "ports": (7400, 7411),
        "tick_bits": 13,
    }
    return EthernetSettings(**(usual | options))


def checked(frame):
    """Append the frame check sequence."""
    return frame + binascii.crc32(frame).to_bytes(4, "little")


def wire(packet):
    """Return a packet of scapy as a PHY has it, from the preamble on."""
    frame = bytes(packet)
    return PREAMBLE + checked(frame + bytes(max(0, 60 - len(frame))))


@dataclass
class Seen:
    """What came out.

    Attributes
    ----------
    frames : list of bytes
        Without preamble and frame check sequence, which were right.
    datagrams : list of (bytes, ip, source port, destination port)
    drops : Counter of str
    times : list of (str, int)
        When frames and datagrams began, and when those that were sent ended, in cycles.
    """

    frames: list = field(default_factory=list)
    datagrams: list = field(default_factory=list)
    drops: Counter = field(default_factory=Counter)
    times: list = field(default_factory=list)


@dataclass
class Datagram:
    """A datagram for the edge to send."""

    payload: bytes
    to: str = HOST
    to_port: int = 5000
    port: int = 7400
    length: int | None = None


class Pause(int):
    """Cycles without anything."""


def run(steps, own=None, *, holes=0.0, stalls=0.0, slow=0.0, gap=12, after=300, seed=1):
    """Do steps one after another, and return what was seen.

    Parameters
    ----------
    steps : list of bytes, lists of (byte, error), Datagram or Pause
        Bytes are those of a frame from the preamble on. A datagram ends before the next step.
    holes, stalls, slow : float
        How often there is no symbol, `received` is held, and the transmitter is held.
    """
    rnd = random.Random(seed)
    edge = EthernetEdge(own or settings())
    passes_on, width = not edge.settings.memory_bytes, edge.settings.word_bytes
    seen, done = Seen(), []

    async def drive(ctx):
        async def symbol(data, enable, error=0):
            while rnd.random() < holes:
                await ctx.tick()
            ctx.set(edge.symbols_in.payload, {"data": data, "enable": enable, "error": error})
            ctx.set(edge.symbols_in.valid, 1)
            await ctx.tick()
            ctx.set(edge.symbols_in.valid, 0)

        for step in steps:
            if isinstance(step, Pause):
                await ctx.tick().repeat(step)
            elif isinstance(step, Datagram):
                count = len(step.payload)
                for place in range(0, count, width):
                    while rnd.random() < holes:
                        await ctx.tick()
                    word, last = step.payload[place : place + width], place + width >= count
                    payload = {"data": int.from_bytes(word, "little"), "src_port": step.port}
                    payload |= {"last": last, "last_be": last << len(word) - 1}
                    payload |= {"dst_port": step.to_port, "ip_address": number(step.to)}
                    payload["length"] = count if step.length is None else step.length
                    ctx.set(edge.sent.payload, payload)
                    ctx.set(edge.sent.valid, 1)
                    await ctx.tick().until(edge.sent.ready)
                    ctx.set(edge.sent.valid, 0)
                    ctx.set(edge.sent.payload, {"length": 0x5A5A, "dst_port": 0x1234})
                seen.times.append(("datagram sent", now[0]))
            else:
                pairs = [(byte, 0) for byte in step] if isinstance(step, bytes) else step
                for byte, error in pairs:
                    await symbol(byte, 1, error)
                seen.times.append(("frame sent", now[0]))
                await symbol(0, 0)
                await ctx.tick().repeat(gap - 1)
        await ctx.tick().repeat(after)
        done.append(True)

    now = [0]

    async def watch(ctx):
        frame, since = bytearray(), 0
        out, streams = edge.symbols_out, [edge.received]
        if edge.settings.is_split:
            streams.append(edge.joined)
        parts, about = [bytearray() for _ in streams], {}
        ready, goes = 1, 1
        came = [each for stream in streams for each in (stream.valid, stream.payload)]
        values = (out.valid, out.payload, edge.drops, *came)
        while True:
            for stream in streams:
                ctx.set(stream.ready, ready)
            ctx.set(out.ready, goes)
            _, _, *sampled = await ctx.tick().sample(*values)
            now[0] += 1
            out_valid, symbol, drops, *sampled = sampled
            if out_valid and goes:
                if symbol.enable:
                    if not frame:
                        seen.times.append(("frame", now[0]))
                        assert not seen.frames or since >= 12, f"a gap of {since}"
                    frame.append(symbol.data)
                    since = 0
                else:
                    since += 1
            elif goes:
                since += 1
            if frame and goes and not (out_valid and symbol.enable):
                whole, frame = bytes(frame), bytearray()
                assert whole[:8] == PREAMBLE and checked(whole[8:-4]) == whole[8:]
                assert 64 <= len(whole) - 8 <= 1518
                seen.frames.append(whole[8:-4])
            for number, part in enumerate(parts):
                valid, payload = sampled[2 * number : 2 * number + 2]
                if not valid or not (ready or passes_on):
                    continue
                fields = (payload.ip_address, payload.src_port, payload.dst_port, payload.length)
                if not part:
                    seen.times.append(("datagram", now[0]))
                    about[number] = fields
                size = payload.last_be.bit_length() or width
                part += payload.data.to_bytes(width, "little")[:size]
                if not payload.last:
                    continue
                assert passes_on or not payload.error
                if not payload.error:
                    assert fields == about[number]
                    assert payload.length == len(part)
                    seen.datagrams.append((bytes(part), *fields[:3]))
                part.clear()
            for name in DROPS:
                seen.drops[name] += drops[name]
                if drops[name]:
                    seen.times.append((name, now[0]))
            ready, goes = int(rnd.random() >= stalls), int(rnd.random() >= slow)

    simulator = Simulator(edge)
    simulator.add_clock(8e-9)
    simulator.add_testbench(drive)
    simulator.add_testbench(watch, background=True)
    simulator.run()
    assert done
    seen.drops = +seen.drops
    return seen
