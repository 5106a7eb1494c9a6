"""The link over a stream of bytes: a UART, or any other."""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware import PacketWidth
from firm_hdl.gateware.packets.counters import add_counters, counters_layout
from firm_hdl.node.description import Link
from firm_hdl.node.gateware.cobs import ByteFrameReader, ByteFrameWriter
from firm_hdl.node.gateware.header import HeaderInsert
from firm_hdl.node.gateware.streams import link_members, passes
from firm_hdl.node.gateware.uart import UartReceiver, UartTransmitter
from firm_hdl.node.links.receive import FrameReceiver

__all__ = ["ByteLink", "UartLink"]


class ByteLink(wiring.Component):
    """Frames in COBS with a CRC, on a stream of bytes without packets.

    Bytes may be lost, added and changed: the frames that they touch are dropped and counted, and
    the next one is found.

    Parameters
    ----------
    bus_bytes : int
        Bytes per beat of the messages: 1, 2, 4, 8 or 16.
    link : Link
        Its memory.

    Members
    -------
    received : Out(LinkSignature(bus_bytes))
    sent : In(LinkSignature(bus_bytes))
    counters : Out(link_counters_layout())
    bytes_in, bytes_out : In and Out(stream.Signature(8))
        Of `bytes_in`, a byte is taken in all cycles but about 40 per frame.
    """

    def __init__(self, bus_bytes: int, link: Link):
        self.bus_bytes, self.link = bus_bytes, link
        super().__init__(
            {
                **link_members(bus_bytes),
                "bytes_in": In(stream.Signature(8)),
                "bytes_out": Out(stream.Signature(8)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.reader = reader = ByteFrameReader()
        m.submodules.receiver = receiver = FrameReceiver(1, self.bus_bytes, self.link)
        m.submodules.insert = insert = HeaderInsert(self.bus_bytes)
        m.submodules.width = width = PacketWidth(self.bus_bytes, 1)
        m.submodules.writer = writer = ByteFrameWriter()
        short = Signal(counters_layout("malformed"))
        add_counters(m, short, {"malformed": reader.short})
        malformed = Signal(33)
        m.d.comb += [
            *passes(self.bytes_in, reader.i),
            *passes(reader.frames, receiver.frames),
            receiver.bad.eq(reader.bad),
            *passes(receiver.received, self.received),
            self.counters.eq(receiver.counters),
            malformed.eq(receiver.counters.malformed + short.malformed),
            self.counters.malformed.eq(Mux(malformed[32], 0xFFFF_FFFF, malformed[:32])),
            *passes(self.sent, insert.i),
            *passes(insert.frames, width.packets_in),
            *passes(width.packets_out, writer.frames),
            *passes(writer.o, self.bytes_out),
        ]
        return m


class UartLink(wiring.Component):
    """A :class:`ByteLink` with a UART of its own: 8 data bits, no parity, 1 stop bit.

    Parameters
    ----------
    bus_bytes, link
        As for :class:`ByteLink`.
    clock_hz : float
        Frequency of `sync`; a bit takes the nearest number of cycles, at least 4.

    Members
    -------
    received, sent, counters
        As those of a :class:`ByteLink`.
    rx : In(1)
    tx : Out(1)
    """

    def __init__(self, bus_bytes: int, link: Link, clock_hz: float):
        self.bus_bytes, self.link = bus_bytes, link
        self.cycles = clock_hz / link.baud
        super().__init__(
            {
                **link_members(bus_bytes),
                **self.medium(),
            }
        )

    @staticmethod
    def medium() -> dict[str, Any]:
        """Return the members that face the medium."""
        return {"rx": In(1, init=1), "tx": Out(1, init=1)}

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.bytes = inner = ByteLink(self.bus_bytes, self.link)
        m.submodules.receiver = receiver = UartReceiver(self.cycles)
        m.submodules.transmitter = transmitter = UartTransmitter(round(self.cycles))
        m.d.comb += [
            *passes(inner.received, self.received),
            *passes(self.sent, inner.sent),
            self.counters.eq(inner.counters),
            receiver.rx.eq(self.rx),
            *passes(receiver.o, inner.bytes_in),
            *passes(inner.bytes_out, transmitter.i),
            self.tx.eq(transmitter.tx),
        ]
        return m
