"""Noise between transfers: what a stream has beside a low `valid` has no meaning."""

from __future__ import annotations

from amaranth.hdl import Module, Mux, Value
from amaranth.lib.wiring import Out

__all__ = ["with_noise"]


def with_noise(kind, *args, **options):
    """Return a part whose incoming payloads are inverted while they are not valid.

    A bench leaves the last payload on a stream. So a part that looks at it too late sees a payload
    that was right a moment ago. With all bits inverted, it sees one that never was.
    """
    outside, inside = kind(*args, **options), kind(*args, **options)

    def elaborate(platform):
        m = Module()
        m.submodules.inside = inside
        for path, member, outer in outside.signature.flatten(outside):
            value, inner = Value.cast(outer), Value.cast(at(inside, path))
            if member.flow is Out:
                m.d.comb += value.eq(inner)
            elif path[-1] == "payload":
                valid = at(outside, (*path[:-1], "valid"))
                m.d.comb += inner.eq(Mux(valid, value, ~value))
            else:
                m.d.comb += inner.eq(value)
        return m

    outside.elaborate = elaborate
    return outside


def at(part, path):
    """Return a member of a part."""
    for name in path:
        part = part[name] if isinstance(name, int) else getattr(part, name)
    return part
