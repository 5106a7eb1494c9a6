"""The digest of a name in announcements, a byte per cycle."""

from __future__ import annotations

import zlib

from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.crc.catalog import CRC32_ISO_HDLC
from amaranth.lib.wiring import In, Out

__all__ = ["NameDigest", "digest_of"]


def digest_of(name: str) -> int:
    """Return the CRC-32 of a name without its terminator."""
    return zlib.crc32(name.encode())


class NameDigest(wiring.Component):
    """CRC-32 of a string up to its terminator.

    Members
    -------
    begins : In(1)
        Begin a new name.
    byte : In(8)
    adds : In(1)
        Add `byte`; not together with `begins`. Nothing is added from the first byte 0 on.
    digest : Out(32)
        Of all bytes of earlier cycles.
    """

    def __init__(self) -> None:
        super().__init__({"begins": In(1), "byte": In(8), "adds": In(1), "digest": Out(32)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.crc = crc = CRC32_ISO_HDLC(data_width=8).create()
        ended = Signal()
        m.d.comb += [
            crc.start.eq(self.begins),
            crc.data.eq(self.byte),
            crc.valid.eq(self.adds & ~ended & (self.byte != 0)),
            self.digest.eq(crc.crc),
        ]
        with m.If(self.begins):
            m.d.sync += ended.eq(0)
        with m.Elif(self.adds & (self.byte == 0)):
            m.d.sync += ended.eq(1)
        return m
