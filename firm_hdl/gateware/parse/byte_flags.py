"""Flags for the sequencer: bytes that are not NUL, and beats that are no correct header."""

from __future__ import annotations

from amaranth.hdl import Cat, Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.memories import LutMemory
from firm_hdl.gateware.positions import Ring, any_of, beat_layout
from firm_hdl.program import DeserializerProgram

__all__ = ["ByteFlags"]


class ByteFlags(wiring.Component):
    """Flags of the packet buffer: one for each byte, and those of headers for each beat.

    Whether a beat is that of a header is not known as it arrives. So every beat is compared with
    the checked bytes of each header state, and the sequencer reads the flag of the right beat.

    Flags are written together with their beat, and read combinationally.

    Parameters
    ----------
    program : DeserializerProgram

    Members
    -------
    beat : In(beat_layout(plan))
    nul_at : In(position)
    nonzero : Out(1)
        The byte at `nul_at` is not NUL.
    header_at : In(beat)
    mismatch : Out(max(1, len(states)))
        Bit k: the beat at `header_at` differs from the checked bytes of `states[k]`. Bytes after
        the packet's end are not compared.
    """

    def __init__(self, program: DeserializerProgram):
        self.program, self.ring = program, Ring(program.plan)
        # States with bytes of the encapsulation header that are checked.
        self.states = [each.number for each in program.states if each.checks]
        super().__init__(
            {
                "beat": In(beat_layout(program.plan)),
                "nul_at": In(self.ring.bits),
                "nonzero": Out(1),
                "header_at": In(self.ring.beat_bits),
                "mismatch": Out(max(1, len(self.states))),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        beat, ring = self.beat, self.ring
        lanes = [beat.data[8 * k : 8 * k + 8] for k in range(self.program.plan.bus_bytes)]
        if self.program.has_strings:
            memory = LutMemory(m, "nonzero_table", len(lanes), ring.depth)
            write, read = memory.write, memory.reader()
            m.d.comb += [
                write.addr.eq(beat.at),
                write.data.eq(Cat(lane.any() for lane in lanes)),
                write.en.eq(beat.valid),
                read.addr.eq(ring.slot(self.nul_at)),
                self.nonzero.eq((read.data >> ring.lane(self.nul_at))[0]),
            ]
        if self.states:
            memory = LutMemory(m, "headers_table", len(self.states), ring.depth)
            write, read = memory.write, memory.reader()
            # The checked bytes of a state are in its first beat: a header is cut at bus words.
            wrong = [
                any_of(
                    [
                        (lanes[lane] != byte) & (~beat.last | (beat.count > lane))
                        for lane, byte in self.program.states[number].checks
                    ]
                )
                for number in self.states
            ]
            m.d.comb += [
                write.addr.eq(beat.at),
                write.data.eq(Cat(wrong)),
                write.en.eq(beat.valid),
                read.addr.eq(self.header_at),
                self.mismatch.eq(read.data),
            ]
        return m
