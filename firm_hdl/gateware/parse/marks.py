"""Marks of beats for the sequencer: bytes that are not NUL, headers that are wrong."""

from __future__ import annotations

from amaranth.hdl import Cat, Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.memories import LutMemory
from firm_hdl.gateware.positions import Ring, any_of, beat_layout
from firm_hdl.plan import Fixed, Plan

__all__ = ["Marks"]


class Marks(wiring.Component):
    """One bit for each byte of the packet buffer, and one for each header.

    Marks are written together with their beat, and read combinationally.

    Parameters
    ----------
    plan : Plan

    Attributes
    ----------
    steps : list of int
        Steps with bytes of the encapsulation header that are checked.

    Members
    -------
    beat : In(beat_layout(plan))
    nul_at : In(position)
    nonzero : Out(1)
        The byte at `nul_at` is not NUL.
    header_at : In(beat)
    mismatch : Out(max(1, len(steps)))
        Bit k: the beat at `header_at` differs from the checked bytes of `steps[k]`. Bytes after the
        packet's end are not compared.
    """

    def __init__(self, plan: Plan):
        self.plan, self.ring = plan, Ring(plan)
        self.checks = {
            index: [(item.at + k, byte) for k, byte in enumerate(item.data)]
            for index, step in enumerate(plan.steps)
            for item in step.slices
            if isinstance(item, Fixed) and item.check
        }
        self.steps = list(self.checks)
        super().__init__(
            {
                "beat": In(beat_layout(plan)),
                "nul_at": In(self.ring.bits),
                "nonzero": Out(1),
                "header_at": In(self.ring.beat_bits),
                "mismatch": Out(max(1, len(self.steps))),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        beat, ring = self.beat, self.ring
        lanes = [beat.data[8 * k : 8 * k + 8] for k in range(self.plan.bus_bytes)]
        if any(run.terminated for run in self.plan.runs):
            memory = LutMemory(m, "nonzero", len(lanes), ring.depth)
            write, read = memory.write, memory.reader()
            m.d.comb += [
                write.addr.eq(beat.at),
                write.data.eq(Cat(lane.any() for lane in lanes)),
                write.en.eq(beat.valid),
                read.addr.eq(ring.slot(self.nul_at)),
                self.nonzero.eq((read.data >> ring.lane(self.nul_at))[0]),
            ]
        if self.steps:
            memory = LutMemory(m, "headers", len(self.steps), ring.depth)
            write, read = memory.write, memory.reader()
            # The checked bytes of a step are in its first beat: a header is cut at bus words.
            wrong = [
                any_of([(lanes[k] != byte) & (~beat.last | (beat.count > k)) for k, byte in checks])
                for checks in self.checks.values()
            ]
            m.d.comb += [
                write.addr.eq(beat.at),
                write.data.eq(Cat(wrong)),
                write.en.eq(beat.valid),
                read.addr.eq(self.header_at),
                self.mismatch.eq(read.data),
            ]
        return m
