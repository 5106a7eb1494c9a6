"""Claims about the FIFO between two clocks.

In each cycle of a run, the surroundings choose which of the two clocks have an edge: either, both,
or none. So the clocks have any ratio, and any phase. A register that samples the other clock's Gray
code at an edge of both sees the value before; later it sees the new value. In hardware it may see
either at such an edge, and no other value, because only one bit of a Gray code changes. So this is
what it sees in another run, in which the edges are not at the same time.

A run begins with the configuration of the FPGA. Resets are not part of it, because a reset of one
clock domain of this FIFO acts on the other one without an edge.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from amaranth.hdl import DomainRenamer, EnableInserter, Mux, Signal, Value

from firm_hdl.gateware.packets.crossing import PacketCrossing
from lab.formal.bugs import Bug
from lab.formal.catalog import Claim, Study
from lab.formal.scene import Scene
from lab.formal.streams import fires, packet_source, rules, sink
from lab.formal.tracking import BeatTracker

__all__ = ["studies"]

BEATS = 4
MOST_EDGES = 4
"""Edges of a clock until a beat, or room for one, has crossed."""


def _at(port: Any, edge: Value) -> Any:
    """Return a stream that transfers only in cycles with an edge of its clock."""
    return SimpleNamespace(payload=port.payload, valid=port.valid, ready=port.ready & edge)


def _crossing(scene: Scene) -> None:
    """Send any packets of one byte per beat from any clock to any other."""
    scene.is_configured = True
    block = PacketCrossing(1, BEATS)
    writes, reads = scene.free(1, "write_edge"), scene.free(1, "read_edge")
    clocked = EnableInserter({"write": writes, "read": reads})(block)
    scene.m.submodules.block = DomainRenamer({"write": "sync", "read": "sync"})(clocked)
    came, out = _at(block.packets_in, writes), _at(block.packets_out, reads)
    packet_source(scene, came, "i", any_count=True)
    ready = sink(scene, block.packets_out, "o")
    rules(scene, out, "o")
    # The memory, and the register behind it.
    tracker = BeatTracker(scene, "beat", BEATS + 1)
    tracker.enter(fires(came), Value.cast(came.payload))
    tracker.leave(fires(out), Value.cast(out.payload))
    waits = (tracker.inside != 0) & ready & ~out.valid
    _moves(scene, "output moves", waits, reads)
    _moves(
        scene, "input moves", (tracker.inside == 0) & came.valid & ~block.packets_in.ready, writes
    )


def _moves(scene: Scene, name: str, waits: Value, edge: Value) -> None:
    """Claim that a condition holds for at most a few edges of a clock in a row."""
    waited = Signal(range(MOST_EDGES + 2), name=f"{name.replace(' ', '_')}_waited")
    counted = waited + (edge & (waited <= MOST_EDGES))
    scene.m.d.sync += waited.eq(Mux(waits, counted, 0))
    scene.claim(name, waited <= MOST_EDGES)


_ELABORATE = PacketCrossing.elaborate


def studies() -> list[Study]:
    """Return the study of a crossing."""
    bugs = {
        "valid stays": Bug(
            _ELABORATE, ".eq(fifo.r_rdy)", ".eq(fifo.r_rdy & self.packets_in.valid)"
        ),
        "payload stays": Bug(_ELABORATE, "r_domain=self.read_domain", "r_domain=self.write_domain"),
        "order": Bug(_ELABORATE, "fifo.r_en.eq(self.packets_out.ready)", "fifo.r_en.eq(1)"),
        "nothing extra": Bug(_ELABORATE, "fifo.w_en.eq(self.packets_in.valid)", "fifo.w_en.eq(1)"),
        "output moves": Bug(_ELABORATE, ".eq(fifo.r_rdy)", ".eq(fifo.r_rdy & ~fifo.w_rdy)"),
        "input moves": Bug(_ELABORATE, ".eq(fifo.w_rdy)", ".eq(fifo.w_rdy & fifo.r_rdy)"),
    }
    claims = tuple(Claim(name, bug) for name, bug in bugs.items())
    return [Study("crossing", f"`PacketCrossing(1, {BEATS})`, any two clocks", _crossing, claims)]
