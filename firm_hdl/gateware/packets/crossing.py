"""Carry a packet stream from one clock domain to another."""

from __future__ import annotations

from amaranth.hdl import Module, Value
from amaranth.lib.fifo import AsyncFIFO
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.component import Component
from firm_hdl.gateware.interfaces import PacketStream
from firm_hdl.gateware.limits import check_integer
from firm_hdl.gateware.packets.sides import beat_in, beat_layout, beat_out, side_members
from firm_hdl.gateware.signatures import PacketSignature

__all__ = ["PacketCrossing"]


class PacketCrossing(Component):
    """Carry packets from one clock domain to another.

    Beats cross in a FIFO in block RAM, whose positions are exchanged as Gray codes. If it is empty,
    a beat is valid after the second edge of the reading clock after its transfer; in hardware this
    may take an edge more. With 16 beats or more, a beat crosses per cycle of the slower clock.
    Packets need not fit into the FIFO. To send a packet only after its last beat was stored,
    put a :class:`PacketFifo` behind the crossing.

    All outputs depend on registers of their own clock domain only. A reset of the writing domain
    empties the FIFO and ends in the reading domain some cycles later. It cuts a packet that is
    being sent, without a last beat, so the reading side has to be reset, too. A reset of the
    reading domain alone discards nothing. A reset of the writing domain has to last for 2 edges of
    the reading clock: after a shorter one, beats from before it may leave.

    Parameters
    ----------
    bus_bytes : int
        Bytes per beat: 1, 2, 4, 8, 16, 32 or 64.
    beats : int
        Beats in the FIFO: a power of two, at least 4.
    write_domain, read_domain : str
        Clock domains of `packets_in` and `packets_out`.
    side_bits : int
        Bits that travel beside each beat, such as a tag. 0: there are none.

    Members
    -------
    packets_in : In(PacketSignature(bus_bytes))
    side_in : In(side_bits)
        Only with `side_bits`. As stable as the payload.
    packets_out : Out(PacketSignature(bus_bytes))
    side_out : Out(side_bits)
        Only with `side_bits`. What came beside the beat; valid with it.
    """

    packets_in: PacketStream
    packets_out: PacketStream
    side_in: Value
    side_out: Value

    def __init__(
        self,
        bus_bytes: int,
        beats: int = 16,
        *,
        write_domain: str = "write",
        read_domain: str = "read",
        side_bits: int = 0,
    ):
        check_integer("Number of beats", beats)
        if beats < 4 or beats & (beats - 1):
            raise ValueError(f"Number of beats must be a power of two from 4 on, not {beats}")
        for name, domain in (("write_domain", write_domain), ("read_domain", read_domain)):
            if not isinstance(domain, str):
                raise TypeError(f"{name}= must be the name of a clock domain, not {domain!r}")
            if domain in ("", "comb"):
                raise ValueError(f"{name}= must be the name of a clock domain, not {domain!r}")
        self.bus_bytes, self.beats = bus_bytes, beats
        self.write_domain, self.read_domain = write_domain, read_domain
        self.side_bits = side_bits
        super().__init__(
            {
                "packets_in": In(PacketSignature(bus_bytes)),
                "packets_out": Out(PacketSignature(bus_bytes)),
                **side_members(side_bits),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.fifo = fifo = AsyncFIFO(
            width=beat_layout(self.bus_bytes, self.side_bits).size,
            depth=self.beats,
            w_domain=self.write_domain,
            r_domain=self.read_domain,
        )
        m.d.comb += [
            fifo.w_data.eq(beat_in(self)),
            fifo.w_en.eq(self.packets_in.valid),
            self.packets_in.ready.eq(fifo.w_rdy),
            beat_out(self).eq(fifo.r_data),
            self.packets_out.valid.eq(fifo.r_rdy),
            fifo.r_en.eq(self.packets_out.ready),
        ]
        return m
