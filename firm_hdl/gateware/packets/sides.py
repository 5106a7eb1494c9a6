"""What travels beside the beats of packets, such as a tag or the size of the packet."""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Cat, Module, Value
from amaranth.lib import data
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.limits import check_bits
from firm_hdl.gateware.signatures import packet_layout

__all__ = ["beat_in", "beat_layout", "beat_out", "put_in", "put_out", "side_members"]


def beat_layout(bus_bytes: int, side_bits: int) -> data.StructLayout:
    """Return a beat with `side` after its own fields; without bits, that of a packet stream."""
    layout = packet_layout(bus_bytes)
    return data.StructLayout({**layout.members, "side": side_bits}) if side_bits else layout


def side_members(side_bits: int) -> dict[str, Any]:
    """Return the members `side_in` and `side_out`; without bits, there are none.

    Raises `TypeError` or `ValueError` if it is no number of bits.
    """
    check_bits("Number of side bits", side_bits)
    return {"side_in": In(side_bits), "side_out": Out(side_bits)} if side_bits else {}


def beat_in(part: Any) -> Value:
    """Return what comes to a part: the payload of `packets_in`, and `side_in` if there is one."""
    return Cat(Value.cast(part.packets_in.payload), *_members(part, "side_in"))


def beat_out(part: Any) -> Value:
    """Return what leaves a part: the payload of `packets_out`, and `side_out` if there is one."""
    return Cat(Value.cast(part.packets_out.payload), *_members(part, "side_out"))


def put_in(m: Module, part: Any, beats: Any) -> None:
    """Connect what comes to a part with a stream of beats inside."""
    m.d.comb += [
        Value.cast(beats.payload).eq(beat_in(part)),
        part.packets_in.ready.eq(beats.ready),
        beats.valid.eq(part.packets_in.valid),
    ]


def put_out(m: Module, beats: Any, part: Any) -> None:
    """Connect a stream of beats inside a part with what leaves the part."""
    m.d.comb += [
        beat_out(part).eq(Value.cast(beats.payload)),
        beats.ready.eq(part.packets_out.ready),
        part.packets_out.valid.eq(beats.valid),
    ]


def _members(part: Any, name: str) -> list[Any]:
    return [getattr(part, name)] if name in part.signature.members else []
