"""Claims about the history of a writer: what gives way to a new message, and where that goes."""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Mux, Signal, Value

from firm_hdl.node.rtps.history import MOST_SAMPLES, Part
from firm_hdl.node.rtps.intake import Intake
from lab.formal.bugs import Bug
from lab.formal.catalog import Claim, Study
from lab.formal.scene import Scene
from lab.formal.streams import fires

__all__ = ["studies"]

MEMORY_BYTES, _TOPIC = 16, 1
"""Bytes of the writer's memory: four words, so that old samples give way soon."""


def _messages(scene: Scene, block: Intake, most: int) -> None:
    """Offer messages of any size up to `most` bytes, which have as many as they say."""
    m, sent = scene.m, block.sent
    begun, held = Signal(name="begun"), Signal(name="held")
    size, kept = scene.free(range(most + 1), "size"), Signal(range(most + 1), name="kept_size")
    rest, left = Signal(range(most + 1), name="rest"), Signal(range(most + 1), name="left")
    length, waits = Signal(range(most + 1), name="length"), Signal(name="waits")
    bus_bytes = block.bus_bytes
    scene.assume(size <= most)
    m.d.comb += [
        length.eq(Mux(begun | held, kept, size)),
        left.eq(Mux(begun, rest, length)),
        waits.eq(held | begun | scene.free(1, "offers")),
        sent.valid.eq(waits),
        sent.payload.topic.eq(_TOPIC),
        sent.payload.length.eq(length),
        sent.payload.beat.last.eq(left <= bus_bytes),
        sent.payload.beat.count.eq(Mux(left <= bus_bytes, left, bus_bytes)),
    ]
    m.d.sync += [held.eq(waits & ~sent.ready), kept.eq(length)]
    with m.If(fires(sent)):
        m.d.sync += [begun.eq(left > bus_bytes), rest.eq(left - bus_bytes)]


def _engine(scene: Scene, block: Intake) -> Signal:
    """Take messages at any time, as an engine does; return whether one is being taken."""
    m, asked = scene.m, block.histories
    taking = Signal(name="taking")
    m.d.comb += [
        asked.takes.eq(taking),
        asked.answers.eq(asked.asks & scene.free(1, "answers")),
    ]
    starts = ~taking & asked.waits & scene.free(1, "starts")
    ends = asked.ends | (asked.answers & (asked.free == 0))
    m.d.sync += taking.eq(starts | (taking & ~ends))
    return taking


def _kept(scene: Scene) -> None:
    """Follow a reliable reader, which is matched and acknowledges samples at any time."""
    m = scene.m
    part = Part(base=0, bytes=MEMORY_BYTES, depth=MOST_SAMPLES + 1)
    block = Intake(4, (_TOPIC,), (part,), MEMORY_BYTES)
    intake = scene.inside(block)["Intake"]
    _messages(scene, block, MEMORY_BYTES + 8)
    taking, asked, state = _engine(scene, block), block.histories, intake.state
    is_ready = ~intake.is_in("INIT")
    # Those that it lacks: from `next` on.
    present, follows = Signal(name="present"), Signal(32, name="next")
    stored = asked.state
    lacked = (stored.last + 1 - follows)[:32]
    acknowledged = scene.free(range(MOST_SAMPLES + 1), "acknowledged")
    with m.If(~taking & is_ready):
        m.d.sync += present.eq(present | scene.free(1, "comes"))
        with m.If(~present):
            m.d.sync += follows.eq(stored.last + 1)
        with m.Elif(acknowledged <= lacked):
            m.d.sync += follows.eq(follows + acknowledged)
    ahead = (follows - asked.oldest)[:32]
    m.d.comb += asked.free.eq(Mux(present & (ahead < MOST_SAMPLES), ahead, MOST_SAMPLES))
    kept = (stored.last - stored.gone)[:32]
    scene.claim("kept", ~present | (lacked <= kept))

    # From this, the claim follows in a cycle.
    def holds(of: Any) -> Value:
        kept = (of.last - of.gone)[:32]
        lacks = Mux(present, lacked, 0)
        return (kept <= MOST_SAMPLES) & (of.free + lacks <= kept)

    works = intake.is_in("ROOM", "ASK", "FORGET", "COPY", "COPIED")
    full = (state.last - state.gone)[:32] == MOST_SAMPLES
    for always in (
        intake.is_in(),
        ~intake.is_in("INIT") | ~present,
        ~intake.is_in("INIT") | (intake.writer == 0) | holds(stored),
        intake.is_in("INIT") | ((intake.writer == 0) & holds(stored)),
        ~works | ((state.last == stored.last) & holds(state)),
        taking | ~(works | intake.is_in("STATE", "DISCARD")),
        ~intake.is_in("FORGET") | (state.free != 0),
        ~intake.is_in("COPY", "COPIED") | ~full,
    ):
        scene.claim("kept", always)


_INTAKE = Intake.elaborate


def studies() -> list[Study]:
    """Return the studies of the history."""
    unasked = Bug(_INTAKE, "Mux(asked.free < kept, asked.free, kept)", "asked.free")
    return [
        Study(
            "history",
            f"`Intake`, memory of {MEMORY_BYTES} bytes, `keep_all`",
            _kept,
            (Claim("kept", unasked, "induction", found_within=60),),
        )
    ]
