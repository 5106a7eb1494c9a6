"""The MAC of Ethernet: preamble, frame check sequence, sizes, gap (IEEE 802.3, clauses 3 and 4)."""

from __future__ import annotations

from amaranth.hdl import Cat, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.crc.catalog import CRC32_ETHERNET
from amaranth.lib.wiring import In, Out

from firm_hdl.ethernet.streams import FrameSignature, SendSignature, SymbolSignature

__all__ = ["MacReceiver", "MacTransmitter"]

_PREAMBLE, _START = 0x55, 0xD5
_CHECK_BYTES = 4
_LEAST, _MOST = 64, 1518
"""Sizes of a frame, frame check sequence included (3.2.7, 4A.4.2)."""

_GAP = 12


class MacReceiver(wiring.Component):
    """Take frames out of the symbols of a PHY, and judge them.

    Preamble and frame check sequence are removed. A preamble may have any length; a frame without
    start delimiter is dropped. A frame is good if its check sequence is right, it has 64 to 1518
    bytes, and the PHY saw no error in it.

    A symbol per cycle. A byte leaves 6 cycles after it came, as the last 4 may be the check
    sequence. Outputs are registers.

    Members
    -------
    symbols : In(SymbolSignature())
        `ready` is constantly 1.
    frames : Out(FrameSignature())
    damaged, runt, giant : Out(1)
        A frame ended that is not good, for this reason. A frame has one reason.
    """

    def __init__(self) -> None:
        super().__init__(
            {
                "symbols": In(SymbolSignature()),
                "frames": Out(FrameSignature()),
                "damaged": Out(1),
                "runt": Out(1),
                "giant": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.check = check = CRC32_ETHERNET(8).create()
        symbol = self.symbols.payload
        inside, ignored, wrong = Signal(), Signal(), Signal()
        held = Signal(8 * _CHECK_BYTES)
        count = Signal(range(_MOST + 2))
        byte, ends = Signal(), Signal()
        good, small, large = Signal(), Signal(init=1), Signal()
        m.d.comb += [
            self.symbols.ready.eq(1),
            byte.eq(self.symbols.valid & symbol.enable),
            ends.eq(self.symbols.valid & ~symbol.enable),
            check.data.eq(symbol.data),
            check.start.eq(~inside),
            check.valid.eq(inside & byte),
            good.eq(inside & check.match_detected & ~wrong & ~small & ~large),
        ]
        out = self.frames
        m.d.sync += [
            out.valid.eq(inside & (ends | (byte & (count >= _CHECK_BYTES) & ~large))),
            out.payload.data.eq(held[-8:]),
            out.payload.end.eq(ends),
            out.payload.good.eq(good),
            self.giant.eq(ends & large),
            self.runt.eq(ends & inside & small),
            self.damaged.eq(ends & ~good & ~large & ~(inside & small)),
        ]
        with m.If(byte & symbol.error):
            m.d.sync += wrong.eq(1)
        with m.If(ends):
            m.d.sync += [inside.eq(0), ignored.eq(0), wrong.eq(0)]
            m.d.sync += [count.eq(0), small.eq(1), large.eq(0)]
        with m.Elif(byte & inside):
            m.d.sync += held.eq(Cat(symbol.data, held))
            with m.If(~large):
                m.d.sync += [
                    count.eq(count + 1),
                    small.eq(small & (count != _LEAST - 1)),
                    large.eq(count == _MOST),
                ]
        with m.Elif(byte & ~ignored):
            m.d.sync += [
                inside.eq(symbol.data == _START),
                ignored.eq((symbol.data != _START) & (symbol.data != _PREAMBLE)),
            ]
        return m


class MacTransmitter(wiring.Component):
    """Send frames: preamble, padding to 64 bytes, frame check sequence, gap of 12 bytes.

    The first symbol of the preamble leaves 2 cycles after a frame's first byte is valid. A symbol
    per cycle while `symbols.ready` is 1; the payload of `symbols` is registered.

    Members
    -------
    frames : In(SendSignature())
        `ready` is 1 while the bytes of a frame go out.
    symbols : Out(SymbolSignature())
        No symbols come while there is nothing to send.
    """

    def __init__(self) -> None:
        super().__init__(
            {
                "frames": In(SendSignature()),
                "symbols": Out(SymbolSignature()),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.check = check = CRC32_ETHERNET(8).create()
        out, came = self.symbols, self.frames
        goes, takes = Signal(), Signal()
        steps = Signal(4)
        # Counts up to what needs no padding, and stays there.
        count = Signal(range(_LEAST - _CHECK_BYTES))
        enough = Signal()
        byte = Signal(8)
        check_bytes = Signal(32)
        m.d.comb += [
            goes.eq(~out.valid | out.ready),
            # Padding is 0.
            check.data.eq(Mux(takes, came.payload.data, 0)),
            enough.eq(count == _LEAST - _CHECK_BYTES - 1),
            came.ready.eq(goes & takes),
        ]
        with m.If(goes):
            m.d.sync += [
                steps.eq(steps + 1),
                out.valid.eq(1),
                out.payload.data.eq(byte),
                out.payload.enable.eq(1),
            ]
            with m.FSM():
                with m.State("IDLE"):
                    m.d.comb += check.start.eq(1)
                    # It is the last byte of the gap.
                    m.d.sync += [out.valid.eq(came.valid), out.payload.enable.eq(0)]
                    m.d.sync += [steps.eq(0), count.eq(0)]
                    with m.If(came.valid):
                        m.next = "PREAMBLE"
                with m.State("PREAMBLE"):
                    m.d.comb += byte.eq(Mux(steps == 7, _START, _PREAMBLE))
                    with m.If(steps == 7):
                        m.d.sync += takes.eq(1)
                        m.next = "DATA"
                with m.State("DATA"):
                    m.d.comb += [byte.eq(came.payload.data), check.valid.eq(1)]
                    m.d.sync += count.eq(Mux(enough, count, count + 1))
                    with m.If(came.payload.last):
                        m.d.sync += [steps.eq(0), takes.eq(0)]
                        m.next = "CHECK"
                        with m.If(~enough):
                            m.next = "PAD"
                with m.State("PAD"):
                    m.d.comb += check.valid.eq(1)
                    m.d.sync += [count.eq(count + 1), steps.eq(0)]
                    with m.If(enough):
                        m.next = "CHECK"
                with m.State("CHECK"):
                    m.d.comb += byte.eq(Mux(steps == 0, check.crc[:8], check_bytes[:8]))
                    m.d.sync += check_bytes.eq(Mux(steps == 0, check.crc, check_bytes) >> 8)
                    with m.If(steps == _CHECK_BYTES - 1):
                        m.d.sync += steps.eq(0)
                        m.next = "GAP"
                with m.State("GAP"):
                    m.d.sync += out.payload.enable.eq(0)
                    with m.If(steps == _GAP - 2):
                        m.next = "IDLE"
        return m
