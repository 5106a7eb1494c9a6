"""Surroundings of a block on streams, and the rules of streams as claims.

A source may offer anything that the rules of streams and packets in ``docs/reference/streams.md``
allow, whenever it likes. It breaks no rule by construction, so nothing has to be assumed of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from amaranth.hdl import Cat, Module, Mux, Signal, Value
from amaranth.lib import stream

from lab.formal.scene import Scene

__all__ = [
    "fires",
    "packet_rules",
    "packet_source",
    "progress",
    "rules",
    "sink",
    "source",
    "starts_of",
]


def fires(port: Any) -> Value:
    """Return whether a stream transfers."""
    return port.valid & port.ready


def source(scene: Scene, port: stream.Interface, name: str) -> None:
    """Offer any transfers to an input. What was offered stays until it is taken."""
    _offer(scene, port, name, scene.free(len(Value.cast(port.payload)), f"{name}_payload"))


def packet_source(
    scene: Scene,
    port: stream.Interface,
    name: str,
    *,
    any_count: bool = False,
    beside: Sequence[Signal] = (),
) -> None:
    """Offer any packets to an input.

    Parameters
    ----------
    any_count : bool
        `count` may be anything in a beat that is not the last one of its packet.
    beside : sequence of Signal
        Inputs that are as stable as the payload.
    """
    m = scene.m
    payload = Signal(port.payload.shape(), name=f"{name}_payload")
    bus_bytes = len(payload.data)
    choice = scene.free(payload.shape(), f"{name}_choice")
    starts = starts_of(m, port, name)
    count = choice.count
    # Any number of bytes, but none only if the packet is this beat alone.
    counted = Mux(count > bus_bytes, bus_bytes, Mux((count == 0) & ~starts, 1, count))
    full = choice.count if any_count else bus_bytes
    m.d.comb += [
        payload.eq(choice),
        payload.count.eq(Mux(choice.last, counted, full)),
    ]
    choices = [scene.free(len(signal), f"{name}_{signal.name}_choice") for signal in beside]
    _offer(scene, port, name, Cat(Value.cast(payload), *choices), beside)


def starts_of(m: Module, port: Any, name: str) -> Signal:
    """Return whether the next transfer of a packet stream is the first one of its packet."""
    starts = Signal(init=1, name=f"{name}_starts")
    with m.If(fires(port)):
        m.d.sync += starts.eq(port.payload.last)
    return starts


def _offer(
    scene: Scene, port: stream.Interface, name: str, offered: Value, beside: Sequence[Signal] = ()
) -> None:
    m = scene.m
    offers = scene.free(1, f"{name}_valid")
    held, kept = Signal(name=f"{name}_held"), Signal(len(offered), name=f"{name}_kept")
    now = Signal(len(offered), name=f"{name}_now")
    m.d.comb += [
        port.valid.eq(held | offers),
        now.eq(Mux(held, kept, offered)),
        Cat(Value.cast(port.payload), *beside).eq(now),
    ]
    m.d.sync += [held.eq(port.valid & ~port.ready), kept.eq(now)]


def sink(scene: Scene, port: stream.Interface, name: str) -> Signal:
    """Take transfers of an output in any cycles; return the choice."""
    ready = scene.free(1, f"{name}_ready")
    scene.m.d.comb += port.ready.eq(ready)
    return ready


def rules(scene: Scene, port: stream.Interface, name: str, *beside: Value) -> None:
    """Claim the rules of streams of an output.

    Parameters
    ----------
    beside : Value
        Outputs that are as stable as the payload.
    """
    payload = Cat(Value.cast(port.payload), *beside)
    waits = scene.was(port.valid & ~port.ready, f"{name}_waits")
    before = scene.was(payload, f"{name}_payload")
    scene.claim("valid stays", ~waits | port.valid)
    scene.claim("payload stays", ~waits | (payload == before))


def packet_rules(scene: Scene, port: stream.Interface, name: str) -> None:
    """Claim the rules of packets of an output: `count` is full, or in the last beat at least 1."""
    beat, starts = port.payload, starts_of(scene.m, port, name)
    full = len(beat.data)
    good = Mux(beat.last, (beat.count <= full) & ((beat.count > 0) | starts), beat.count == full)
    scene.claim("count", ~port.valid | good)


def progress(scene: Scene, name: str, waits: Value, cycles: int) -> Signal:
    """Claim that a condition is never true for more than a number of cycles in a row.

    Return for how many it has been.
    """
    waited = Signal(range(cycles + 2), name=f"{name.replace(' ', '_')}_waited")
    scene.m.d.sync += waited.eq(Mux(waits, waited + (waited <= cycles), 0))
    scene.claim(name, waited <= cycles)
    return waited
