"""Waveforms for the documentation, from simulated runs.

    python docs/figures/waveform.py

writes ``deserializer.json5`` and ``serializer.json5``, the sources of the pictures, and, if the
package `wavedrom` is installed, the pictures themselves. A test compares the sources with new runs.
"""

from __future__ import annotations

import json
import re
from collections.abc import Awaitable, Callable, Mapping
from pathlib import Path
from typing import Any

from amaranth.hdl import Value
from amaranth.lib import stream
from amaranth.sim import Simulator, SimulatorContext

from firm_hdl import Deserializer, Serializer, Status, load_message
from firm_hdl.sim import MessagePort, Stalls, send_packets

__all__ = ["FIGURES", "main", "source_of"]

HERE = Path(__file__).parent
HEADER = load_message("std_msgs/msg/Header")
VALUE = {"stamp": {"sec": 7, "nanosec": 9}, "frame_id": "camera"}
# Encapsulation, sec, nanosec, length with NUL, characters, NUL.
PACKET = bytes.fromhex("00010000 07000000 09000000 07000000 63616d657261 00")
LEAVES = ("stamp.sec", "stamp.nanosec", "frame_id.length", "frame_id.items")

Testbench = Callable[[SimulatorContext], Awaitable[None]]
Lanes = list[dict[str, Any]]


def record(
    dut: Any, ports: Mapping[str, stream.Interface], cycles: int, *testbenches: Testbench
) -> list[dict[str, tuple[int, int, int]]]:
    """Run testbenches; return valid, ready and the payload's bits of each stream in each cycle."""
    seen: list[dict[str, tuple[int, int, int]]] = []
    values = [
        value
        for port in ports.values()
        for value in (port.valid, port.ready, Value.cast(port.payload))
    ]

    async def watch(ctx: SimulatorContext) -> None:
        for _ in range(cycles):
            _, _, *bits = await ctx.tick().sample(*values)
            triples = zip(bits[::3], bits[1::3], bits[2::3], strict=True)
            seen.append(dict(zip(ports, triples, strict=True)))

    simulator = Simulator(dut)
    simulator.add_clock(1e-8)
    simulator.add_testbench(watch)
    for testbench in testbenches:
        simulator.add_testbench(testbench, background=True)
    simulator.run()
    return seen


def beat(bits: int) -> str:
    """Name a beat of an 8-byte bus by its bytes, the first one first."""
    count = bits >> 64 & 15
    text = (bits & (1 << 64) - 1).to_bytes(8, "little")[:count]
    return text.hex()


def number(bits: int) -> str:
    """Name a scalar or a length."""
    return str(bits)


def characters(bits: int) -> str:
    """Name a transfer of items: its characters, and whether it is the last."""
    text = (bits & (1 << 64) - 1).to_bytes(8, "little").rstrip(b"\0").decode()
    return f"{text}, last" if bits >> 64 else text


def status(bits: int) -> str:
    """Name a status."""
    return str(Status(bits).name)


def lanes(
    seen: list[dict[str, tuple[int, int, int]]], name: str, label: Callable[[int], str]
) -> Lanes:
    """Draw a stream as WaveDrom's lanes: its payload while valid, `valid` and `ready`."""
    wave: str = ""
    data: list[str] = []
    before: int | None = None
    taken = False
    for cycle in seen:
        valid, ready, bits = cycle[name]
        now = bits if valid else None
        if wave and now == before and not (taken and valid):
            wave += "."
        else:
            wave += "x" if now is None else "="
            data += [] if now is None else [label(now)]
        before, taken = now, bool(valid and ready)
    payload = {"name": name, "wave": wave, "data": data}
    handshakes = [
        {"name": port, "wave": bit_wave([cycle[name][index] for cycle in seen])}
        for index, port in enumerate(("valid", "ready"))
    ]
    return [payload, *handshakes]


def bit_wave(bits: list[int]) -> str:
    """Draw one bit."""
    pairs = zip([None, *bits], bits, strict=False)
    return "".join("." if now == before else str(now) for before, now in pairs)


def deserializer() -> dict[str, Any]:
    """Run a deserializer; its consumer takes `stamp.sec` two cycles late."""
    dut = Deserializer(HEADER)
    message = dut.message
    ports = {
        "packets": dut.packets,
        "stamp.sec": message.stamp.sec,
        "stamp.nanosec": message.stamp.nanosec,
        "frame_id.length": message.frame_id.length,
        "frame_id.items": message.frame_id.items,
        "status": dut.status,
    }

    async def feed(ctx: SimulatorContext) -> None:
        await ctx.tick()
        await send_packets(ctx, dut.packets, [PACKET])

    async def take(ctx: SimulatorContext) -> None:
        for name in ("stamp.nanosec", "frame_id.length", "frame_id.items", "status"):
            ctx.set(ports[name].ready, 1)
        await ctx.tick().until(message.stamp.sec.valid)
        await ctx.tick()
        ctx.set(message.stamp.sec.ready, 1)

    seen = record(dut, ports, 12, feed, take)
    return drawing("Deserializer of std_msgs/msg/Header, 8-byte bus", seen)


def serializer() -> dict[str, Any]:
    """Run a serializer; its producer offers everything at once."""
    dut = Serializer(HEADER)
    message = dut.message
    ports = {
        "stamp.sec": message.stamp.sec,
        "stamp.nanosec": message.stamp.nanosec,
        "frame_id.length": message.frame_id.length,
        "frame_id.items": message.frame_id.items,
        "packets": dut.packets,
        "status": dut.status,
    }

    async def feed(ctx: SimulatorContext) -> None:
        await ctx.tick()
        await MessagePort(message, HEADER).send(ctx, VALUE, stalls=Stalls.none)

    async def take(ctx: SimulatorContext) -> None:
        ctx.set(dut.packets.ready, 1)
        ctx.set(dut.status.ready, 1)
        await ctx.tick()

    seen = record(dut, ports, 10, feed, take)
    return drawing("Serializer of std_msgs/msg/Header, 8-byte bus", seen)


def drawing(title: str, seen: list[dict[str, tuple[int, int, int]]]) -> dict[str, Any]:
    """Draw a run."""
    labels = {"packets": beat, "frame_id.items": characters, "status": status}
    clock = {"name": "clk", "wave": "p" + "." * (len(seen) - 1)}
    streams = [lanes(seen, name, labels.get(name, number)) for name in seen[0]]
    spaced = [lane for group in streams for lane in ({}, *group)]
    return {
        "signal": [clock, *spaced],
        "head": {"text": title, "tick": 0},
        "config": {"hscale": 4},
    }


FIGURES = {"deserializer": deserializer, "serializer": serializer}


def source_of(figure: str) -> str:
    """Run a figure's simulation; return WaveDrom's source."""
    drawn = FIGURES[figure]()
    rows = ",\n".join(f"    {json.dumps(row)}" for row in drawn.pop("signal"))
    rest = "".join(f",\n  {json.dumps(key)}: {json.dumps(drawn[key])}" for key in drawn)
    return f'{{\n  "signal": [\n{rows}\n  ]{rest}\n}}\n'


def trimmed(svg: str) -> str:
    """Leave out the shapes that a picture does not use, and put white behind the others."""
    used = set(re.findall(r'xlink:href="#([^"]*)"', svg))

    def shape(match: re.Match[str]) -> str:
        return match[0] if match[1] in used else ""

    head, end, rest = svg.partition("</defs>")
    head = re.sub(r'<g id="([^"]*)">.*?</g>', shape, head)
    white = '<rect width="100%" height="100%" fill="white" />'
    return f"{head}{end}{white}{rest}\n"


def main() -> None:
    """Write the sources, and the pictures if they can be drawn."""
    for figure in FIGURES:
        source = source_of(figure)
        (HERE / f"{figure}.json5").write_text(source, encoding="utf-8")
        try:
            import wavedrom
        except ImportError:
            print(f"{figure}.svg is left as it is: the package wavedrom is not installed")
            continue
        picture = trimmed(wavedrom.render(source).tostring())
        (HERE / f"{figure}.svg").write_text(picture, encoding="utf-8")


if __name__ == "__main__":
    main()
