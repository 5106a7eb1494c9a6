"""Claims about the parts that store packets, and keep or drop each of them."""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Cat, Mux, Signal, Value

from firm_hdl.gateware.packets.counters import add_counters
from firm_hdl.gateware.packets.fifo import PacketFifo
from firm_hdl.gateware.packets.memory import Outcome, WhenFull
from firm_hdl.gateware.packets.reader import PacketReader
from firm_hdl.gateware.packets.writer import PacketWriter
from lab.formal.bugs import Bug
from lab.formal.catalog import Claim, Study
from lab.formal.scene import Scene
from lab.formal.streams import (
    fires,
    packet_rules,
    packet_source,
    progress,
    rules,
    sink,
    starts_of,
)
from lab.formal.tracking import BeatTracker

__all__ = ["studies"]


def _fifo(bus_bytes: int, beats: int, packets: int, when_full: WhenFull) -> Study:
    def build(scene: Scene) -> None:
        block = PacketFifo(bus_bytes, bus_bytes * beats, packets, when_full=when_full)
        scene.m.submodules.block = block
        packets_out = block.packets_out
        packet_source(scene, block.packets_in, "i", any_count=True)
        scene.m.d.comb += block.abort.eq(scene.free(1, "abort"))
        ready = sink(scene, packets_out, "o")
        rules(scene, packets_out, "o", block.size)
        packet_rules(scene, packets_out, "o")
        _outcomes(scene, block, beats)
        tracker = _track(scene, block, beats)
        progress(scene, "output moves", (tracker.inside > 0) & ready & ~packets_out.valid, 2)
        waits = block.packets_in.valid & ~block.packets_in.ready
        if when_full == "wait":
            # Nothing has to leave before, so there is room, or the packet is too large.
            progress(scene, "input moves", waits & (tracker.inside == 0), 5)

    return Study(
        f"fifo-{when_full}-{bus_bytes}",
        f'`PacketFifo({bus_bytes}, {bus_bytes * beats}, {packets}, when_full="{when_full}")`',
        build,
        _fifo_claims(when_full),
    )


def _late(scene: Scene, block: PacketFifo, name: str) -> tuple[Value, Any, Value]:
    """Return the transfers of 2 cycles ago: whether there was one, the beat, and `abort`."""
    m, beat = scene.m, block.packets_in.payload
    moved, aborts = fires(block.packets_in), block.abort
    late: Any = beat
    for cycle in (1, 2):
        now = Signal(beat.shape(), name=f"{name}_beat_{cycle}")
        m.d.sync += now.eq(late)
        late = now
        moved, aborts = (
            scene.was(moved, f"{name}_moved_{cycle}"),
            scene.was(aborts, f"{name}_aborts_{cycle}"),
        )
    return moved, late, aborts


def _outcomes(scene: Scene, block: PacketFifo, beats: int) -> None:
    """Claim that each packet has one outcome, and which."""
    m = scene.m
    moved, beat, aborts = _late(scene, block, "decided")
    before = Signal(range(beats + 1), name="beats_before")
    with m.If(moved):
        m.d.sync += before.eq(Mux(beat.last, 0, Mux(before == beats, beats, before + 1)))
    outcome, ended, large = block.outcome, block.ended, before == beats
    scene.claim("one outcome", ended == (moved & beat.last))
    right = (outcome == Outcome.ABORTED) == aborts
    right &= (outcome != Outcome.KEPT) | ~large
    right &= (outcome != Outcome.LARGE) | large
    if block.when_full == "wait":
        right &= outcome != Outcome.FULL
    scene.claim("outcome", ~ended | right)
    names = {"passed": Outcome.KEPT, "aborted": Outcome.ABORTED}
    names |= {"full": Outcome.FULL, "large": Outcome.LARGE}
    expected = Signal.like(block.counters)
    events = {name: ended & (outcome == each) for name, each in names.items()}
    add_counters(m, expected, events)
    scene.claim("counters", Value.cast(expected) == Value.cast(block.counters))


def _track(scene: Scene, block: PacketFifo, beats: int) -> BeatTracker:
    """Claim that what is kept leaves, and nothing else; and the sizes of packets."""
    m, full = scene.m, len(block.packets_in.payload.data)
    moved, beat, _ = _late(scene, block, "tracked")
    # The memory, the two words behind it, and a beat that was freed but still counted.
    tracker = BeatTracker(scene, "beat", beats + 4)
    # A packet that is too large is not kept, so how large it is need not be counted.
    so_far = Signal(range(beats + 2), name="beats_so_far")
    with m.If(moved):
        m.d.sync += so_far.eq(Mux(beat.last, 0, so_far + (so_far <= beats)))
    came = Cat(beat.data.as_value(), Mux(beat.last, beat.count, full), beat.last)
    out = block.packets_out.payload
    keeps = block.outcome == Outcome.KEPT
    tracker.enter(moved & ((so_far <= beats) | beat.last), came, decides=beat.last, keeps=keeps)
    tracker.leave(fires(block.packets_out), Cat(out.data.as_value(), out.count, out.last))
    size = tracker.place * full + out.count
    scene.claim("size", ~(tracker.hits & out.last) | (block.size == size))
    starts = starts_of(m, block.packets_out, "out")
    size_before = Signal.like(block.size, name="size_before")
    with m.If(fires(block.packets_out)):
        m.d.sync += size_before.eq(block.size)
    scene.claim("size", ~block.packets_out.valid | starts | (block.size == size_before))
    return tracker


_WRITE, _READ = PacketWriter._write, PacketReader.elaborate
_RECEIVE = PacketWriter._receive


def _fifo_claims(when_full: WhenFull) -> tuple[Claim, ...]:
    if when_full == "wait":
        outcome = Bug(_RECEIVE, "self.aborts.eq(self.abort)", "self.aborts.eq(0)")
        moves = Bug(_RECEIVE, "fails.eq(lost | self.fills)", "fails.eq(lost)")
    else:
        outcome = Bug(_WRITE, "large.eq(self.fits)", "large.eq(1)")
        moves = None  # `ready` is the constant 1.
    # The order is proved for any number of cycles with the policy that holds the link.
    order = 0 if when_full == "wait" else 12
    return (
        Claim(
            "valid stays", Bug(_READ, "leaves.eq(~packets.valid | packets.ready)", "leaves.eq(1)")
        ),
        Claim("payload stays", Bug(_READ, "with m.If(self.begins):", "with m.If(starts):")),
        Claim(
            "count",
            Bug(
                _RECEIVE,
                "Mux(last, packets.payload.count, shape.bus_bytes)",
                "packets.payload.count",
            ),
            "BMC",
            12,
        ),
        Claim(
            "one outcome", Bug(_WRITE, "ends.eq(self.has_beat & beat.last)", "ends.eq(beat.last)")
        ),
        Claim("outcome", outcome),
        Claim(
            "counters", Bug(PacketFifo.elaborate, '"full": Outcome.FULL', '"full": Outcome.KEPT')
        ),
        Claim(
            "order",
            Bug(_WRITE, "Mux(self.rewinds, self.kept, at + 1)", "at + 1"),
            "BMC" if order else "PDR",
            order,
        ),
        Claim(
            "nothing extra", Bug(_WRITE, "with m.If(self.keeps):", "with m.If(ends):"), "BMC", 12
        ),
        Claim(
            "size",
            Bug(PacketFifo._store_sizes, "read.addr + 1", "read.addr"),
            "BMC",
            12,
        ),
        Claim(
            "output moves",
            Bug(_READ, "more.eq(self.at != self.kept)", "more.eq(self.at + 1 != self.kept)"),
            "BMC",
            14,
        ),
        *([Claim("input moves", moves, "BMC", 14)] if moves else []),
    )


def studies() -> list[Study]:
    """Return the studies of these parts."""
    return [
        _fifo(1, 2, 1, "wait"),
        _fifo(1, 2, 1, "drop"),
    ]
