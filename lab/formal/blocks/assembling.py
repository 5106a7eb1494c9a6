"""Claims about samples that come in fragments: where their bytes are written."""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Signal, Value

from firm_hdl.node.rtps.assembler import Assembler
from firm_hdl.node.rtps.history import Part
from lab.formal.bugs import Bug
from lab.formal.catalog import Claim, Study
from lab.formal.scene import Scene

__all__ = ["studies"]

PART = Part(base=8, bytes=8)


def _assembler(scene: Scene) -> None:
    """Offer any DATA_FRAG of two writers, with any bytes behind it, as a `MessageReader` does."""
    m, block = scene.m, Assembler((PART,), 2)
    inner = scene.inside(block)["Assembler"]
    ask, came = block.lookup, block.fragments
    # A sample is taken, or passed on; and what is known of the reader is as old as its state.
    taking, was_idle = Signal(name="taking"), Signal(name="was_idle")
    idle = ~taking & ~block.busy
    for name in ("row", "number", "first", "fragments", "fragment_bytes", "sample_bytes"):
        port = getattr(ask, name)
        m.d.comb += port.eq(scene.free(len(port), name))
    sizes = (ask.first, ask.fragments, ask.fragment_bytes, ask.sample_bytes)
    is_valid = Value.cast(1)
    for size in sizes:
        is_valid = is_valid & (size != 0)
    ends = taking & (~came.wants | scene.free(1, "ends"))
    accepts = scene.free(1, "accepts") & idle & was_idle & ask.fits & is_valid
    m.d.comb += [
        ask.accepts.eq(accepts & (ask.has_room | ask.holds)),
        ask.forgets.eq(scene.free(1, "forgets") & idle & ~ask.accepts),
        ask.tick.eq(scene.free(1, "tick")),
        came.byte.eq(scene.free(8, "byte")),
        came.takes.eq(taking & came.wants & ~ends & scene.free(1, "takes")),
        came.plays.eq(ends & came.is_whole & scene.free(1, "plays")),
        came.stores.eq(ends & ~came.is_whole),
        block.payload.ready.eq(scene.free(1, "ready")),
    ]
    m.d.sync += [
        taking.eq(ask.accepts | (taking & ~ends)),
        was_idle.eq(idle & ~ask.accepts & ~ask.forgets),
    ]
    memory, now, at = inner.memory, inner.now, inner.at
    first, end = PART.base, PART.base + PART.bytes
    scene.claim("inside", ~memory.writes | ((inner.place >= first) & (inner.place < end)))
    scene.claim("inside", ~memory.writes | (at < now.sample_bytes))
    # What is passed on is of the sample's size.
    out = block.payload
    scene.claim("inside", ~out.valid | (out.payload.last == (at == now.sample_bytes)))

    # From this, the claim follows in a cycle.
    def holds(of: Any) -> Value:
        sizes = (of.sample_bytes != 0) & (of.sample_bytes <= PART.bytes)
        return sizes & (of.place <= of.sample_bytes) & (of.next != 0) & (of.next <= of.place + 1)

    stored = ask.held.shape()(Value.cast(inner.read.data))
    is_known = (inner.is_valid == inner.valid) & (Value.cast(ask.held) == Value.cast(stored))
    is_next, is_whole = inner.is_next, came.is_whole
    for always in (
        ~inner.valid | (holds(stored) & (stored.place != stored.sample_bytes)),
        ~was_idle | (is_known & (inner.limit == PART.bytes)),
        ~was_idle | idle,
        ~(taking | block.busy) | (inner.reader == 0),
        ~(taking & block.busy),
        ~taking | (holds(now) & (inner.fragment <= now.next)),
        ~taking | (at >= now.place) & (at <= now.sample_bytes),
        ~taking | is_next | (at == now.place),
        ~taking | is_whole | (at < now.sample_bytes),
        ~block.busy | (holds(now) & is_whole & (at <= now.sample_bytes)),
        ~inner.is_in("PLAY") | (at != 0),
        inner.is_in(),
    ):
        scene.claim("inside", always)


_ASSEMBLER = Assembler.elaborate


def studies() -> list[Study]:
    """Return the studies of the assembler."""
    overruns = Bug(_ASSEMBLER, "(is_next & (at + 1 == now.sample_bytes))", "0")
    return [
        Study(
            "assembler",
            f"`Assembler`, memory of {PART.bytes} bytes behind {PART.base} others",
            _assembler,
            (Claim("inside", overruns, "induction", found_within=30),),
        )
    ]
