"""Claims about the tail drop: what leaves, what is dropped, and the number of packets dropped.

The surroundings keep an account of their own, from the ports: which beats of the packet that
arrives have left. So each claim is about the block's ports in a cycle, and about this account.
"""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Mux, Signal, Value

from firm_hdl.gateware.packets.tail_drop import TailDrop
from lab.formal.bugs import Bug
from lab.formal.catalog import Claim, Study
from lab.formal.scene import Scene
from lab.formal.streams import fires, packet_source, sink

__all__ = ["studies"]

LATENCY = 1
"""Cycles from a beat on `packets_in` to the cycle that sends or drops the beat."""


class _Account:
    """Which beats of the packet that arrives have left.

    Attributes
    ----------
    moved : Value
        A beat is due: it arrived `LATENCY` cycles ago, and leaves in this cycle, or never.
    beat : View
        The beat.
    leaves, cuts : Signal
        The beat leaves; the end of a cut packet does.
    loses : Signal
        The beat does not leave.
    starts, begun, lost : Signal
        Of the packet, before this beat: none was due; one has left; one has not.
    open : Signal
        The packet that leaves has not ended.
    owed : Signal
        It has to end without the rest, because a beat of it was lost.
    """

    def __init__(self, scene: Scene, came: Any, out: Any):
        m = scene.m
        self.moved, self.beat = fires(came), came.payload
        for cycle in range(LATENCY):
            late = Signal(came.payload.shape(), name=f"beat_{cycle}")
            m.d.sync += late.eq(self.beat)
            self.moved, self.beat = scene.was(self.moved, f"moved_{cycle}"), late
        last, aborted = self.beat.last, out.payload.aborted
        self.leaves, self.cuts = Signal(name="leaves"), Signal(name="cuts")
        self.starts, self.loses = Signal(name="starts", init=1), Signal(name="loses")
        self.begun, self.lost = Signal(name="begun"), Signal(name="lost")
        self.open, self.owed = Signal(name="open"), Signal(name="owed")
        m.d.comb += [
            self.leaves.eq(fires(out) & ~aborted),
            self.cuts.eq(fires(out) & aborted),
            self.loses.eq(self.moved & ~self.leaves),
        ]
        with m.If(self.moved):
            m.d.sync += [
                self.starts.eq(last),
                self.begun.eq(~last & (self.begun | self.leaves)),
                self.lost.eq(~last & (self.lost | self.loses)),
            ]
        with m.If(fires(out)):
            m.d.sync += self.open.eq(~out.payload.beat.last)
        with m.If(self.loses & self.begun & ~self.lost):
            m.d.sync += self.owed.eq(1)
        with m.Elif(self.cuts):
            m.d.sync += self.owed.eq(0)


def _tail_drop(scene: Scene) -> None:
    """Send any packets of one byte per beat through a tail drop."""
    m = scene.m
    m.submodules.block = block = TailDrop(1)
    came, out = block.packets_in, block.packets_out
    packet_source(scene, came, "i")
    ready = sink(scene, out, "o")
    account = _Account(scene, came, out)
    moved, beat, sent = account.moved, account.beat, out.payload
    leaves, cuts, lost = account.leaves, account.cuts, account.lost
    same = sent.beat.as_value() == beat.as_value()
    scene.claim("order", ~leaves | (moved & same & ~lost))
    scene.claim("whole packets", ~leaves | (account.starts != account.open))
    scene.claim("whole packets", ~cuts | (account.open & sent.beat.last))
    scene.claim("cut packets end", (out.valid & sent.aborted) == account.owed)
    scene.claim("room", came.ready)
    scene.claim("room", ~(moved & ready & ~account.owed & ~lost) | leaves)
    drops = moved & beat.last & (lost | account.loses)
    scene.claim("drops", block.drops == drops)
    _check_dropped(scene, block, account, drops & ~account.begun)


def _check_dropped(scene: Scene, block: TailDrop, account: _Account, whole: Value) -> None:
    """Claim that packets that were dropped whole are counted, up to the largest number."""
    m, sent = scene.m, block.packets_out.payload
    expected = Signal.like(block.dropped, name="expected")
    first = account.leaves & account.starts
    m.d.comb += block.report.eq(
        scene.free(1, "report") & expected.any() & ~fires(block.packets_out)
    )
    counted = whole & ~expected.all()
    m.d.sync += expected.eq(Mux(first, 0, expected + counted - block.report))
    scene.claim("dropped", block.dropped == expected)
    scene.claim("dropped", ~first | (sent.dropped == expected))
    scene.claim("dropped", ~first | (sent.any_dropped == expected.any()))


_ELABORATE = TailDrop.elaborate


def studies() -> list[Study]:
    """Return the study of a tail drop."""
    bugs = {
        "order": Bug(_ELABORATE, "drops_rest.eq(~beat.last)", "drops_rest.eq(0)"),
        "whole packets": Bug(_ELABORATE, "beat.last | abort_pending", "beat.last"),
        "cut packets end": Bug(_ELABORATE, "m.If(begun & ~drops_rest)", "m.If(drops_rest)"),
        "room": Bug(_ELABORATE, "m.If(abort_pending & out.ready)", "m.If(0)"),
        "drops": Bug(_ELABORATE, "eq(refused & beat.last)", "eq(refused)"),
        "dropped": Bug(_ELABORATE, "& ~begun & ~self.dropped.all()", "& ~self.dropped.all()"),
    }
    claims = tuple(Claim(name, bug) for name, bug in bugs.items())
    return [Study("tail-drop", "`TailDrop(1)`", _tail_drop, claims)]
