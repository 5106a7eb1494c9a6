"""Claims about the parts that pass packets on at once: slice, width, arbiter, router."""

from __future__ import annotations

from amaranth.hdl import Array, Mux, Signal, Value

from firm_hdl.gateware.packets.arbiter import PacketArbiter
from firm_hdl.gateware.packets.counters import add_counters
from firm_hdl.gateware.packets.router import PacketRouter
from firm_hdl.gateware.packets.slice import StreamSlice
from firm_hdl.gateware.packets.width import PacketWidth
from firm_hdl.gateware.signatures import packet_layout
from lab.formal.bugs import Bug
from lab.formal.catalog import Claim, Study
from lab.formal.scene import Scene
from lab.formal.solve import Method
from lab.formal.streams import (
    fires,
    packet_rules,
    packet_source,
    progress,
    rules,
    sink,
    starts_of,
)
from lab.formal.tracking import Tracker

__all__ = ["studies"]

_SLICE = StreamSlice.elaborate
_FALLS = Bug(_SLICE, "moves.eq(~self.o.valid | self.o.ready)", "moves.eq(1)")
_CHANGES = Bug(
    _SLICE,
    "with m.If(ready):",
    "m.d.sync += out.eq(Mux(ready, incoming, second))\n    with m.If(ready):",
)
_STALE = Bug(_SLICE, "m.d.sync += second.eq(incoming)", "m.d.sync += second.eq(second)")
_TWICE = Bug(_SLICE, "self.o.valid.eq(self.i.valid | ~ready)", "self.o.valid.eq(1)")
_LOST = Bug(_SLICE, "self.i.valid | ~ready", "self.i.valid & ready")
_STUCK = Bug(_SLICE, "            ready.eq(1),\n", "")


def _slice(scene: Scene) -> None:
    """Follow packets of a 2-byte bus through a slice."""
    scene.m.submodules.block = block = StreamSlice(packet_layout(2))
    packet_source(scene, block.i, "i")
    ready = sink(scene, block.o, "o")
    rules(scene, block.o, "o")
    packet_rules(scene, block.o, "o")
    tracker = Tracker(scene, "unit", 6)
    tracker.enter(fires(block.i), block.i.payload)
    tracker.leave(fires(block.o), block.o.payload)
    progress(scene, "input moves", block.i.valid & ready & ~block.i.ready, 1)
    progress(scene, "output moves", (tracker.inside > 0) & ~block.o.valid, 0)


def _width(in_bytes: int, out_bytes: int) -> Study:
    def build(scene: Scene) -> None:
        scene.m.submodules.block = block = PacketWidth(in_bytes, out_bytes)
        packets_in, packets_out = block.packets_in, block.packets_out
        packet_source(scene, packets_in, "i")
        ready = sink(scene, packets_out, "o")
        rules(scene, packets_out, "o")
        packet_rules(scene, packets_out, "o")
        widest = max(in_bytes, out_bytes)
        # Two beats in a slice, each with an end, and up to as many bytes before it.
        tracker = Tracker(scene, "unit", 5 * (widest + 1))
        tracker.enter(fires(packets_in), packets_in.payload)
        tracker.leave(fires(packets_out), packets_out.payload)
        ratio = max(in_bytes // out_bytes, 1)
        progress(scene, "input moves", packets_in.valid & ready & ~packets_in.ready, 2 * ratio)
        whole = tracker.inside >= widest
        progress(scene, "output moves", whole & ready & ~packets_out.valid, 2)

    elaborate = PacketWidth._split if in_bytes > out_bytes else PacketWidth._join
    if in_bytes > out_bytes:
        order = Bug(elaborate, "word_select(number, 8", "word_select(number ^ 1, 8")
        count = Bug(elaborate, "beat.count - Cat(Const(0, low), number)", "beat.count")
        extra = Bug(elaborate, "beat.count == 0, 0, (beat", "beat.count == 0, 1, (beat")
        stuck = Bug(elaborate, "wide.o.ready.eq(out.i.ready & is_final)", "wide.o.ready.eq(0)")
    else:
        order = Bug(elaborate, "Mux(is_here, incoming, kept)", "Mux(is_here, incoming, incoming)")
        count = Bug(elaborate, "Mux(beat.last, beat.count, self.in_bytes)", "beat.count - 1")
        extra = Bug(elaborate, "packets.valid & completes", "completes")
        stuck = Bug(elaborate, "packets.ready.eq(out.i.ready)", "packets.ready.eq(0)")
    if in_bytes == out_bytes:
        order = _STALE
    # Only the sums of the narrowest bus are found by PDR.
    how: tuple[Method, int] = (
        ("PDR", 0) if (in_bytes, out_bytes) == (1, 4) else ("BMC", 11 if in_bytes < 8 else 8)
    )
    return Study(
        f"width-{in_bytes}-{out_bytes}",
        f"`PacketWidth({in_bytes}, {out_bytes})`",
        build,
        (
            Claim("valid stays", _FALLS),
            Claim("payload stays", _CHANGES),
            Claim("count", count),
            Claim("order", order, *how),
            Claim("nothing extra", extra, *how),
            Claim("input moves", stuck),
            Claim("output moves", _LOST, *how),
        ),
    )


_ARBITER = PacketArbiter.elaborate
_TURNS = PacketArbiter._take_turns
_HOPS = Bug(_TURNS, "Mux(valid, fires & last, ~inside)", "Mux(valid, fires, ~inside)")


def _arbiter(scene: Scene) -> None:
    """Follow the packets of any one of three inputs through an arbiter."""
    m, count = scene.m, 3
    m.submodules.block = block = PacketArbiter(1, count)
    out = block.packets_out
    for number, port in enumerate(block.packets_in):
        packet_source(scene, port, f"i{number}")
    ready = sink(scene, out, "o")
    rules(scene, out, "o", block.source)
    packet_rules(scene, out, "o")
    chosen, other = scene.rigid(range(count), "chosen"), scene.rigid(range(count), "other")
    scene.assume((chosen < count) & (other < count) & (other != chosen))
    moves = Array(fires(port) for port in block.packets_in)
    beat = Signal(packet_layout(1))
    m.d.comb += Value.cast(beat).eq(Array(Value.cast(p.payload) for p in block.packets_in)[chosen])
    tracker = Tracker(scene, "unit", 6)
    tracker.enter(moves[chosen], beat)
    tracker.leave(fires(out) & (block.source == chosen), out.payload)
    # Whole packets: the source changes only where a packet begins.
    source = Signal.like(block.source, name="source_before")
    with m.If(fires(out)):
        m.d.sync += source.eq(block.source)
    starts = starts_of(m, out, "out")
    scene.claim("whole packets", ~out.valid | starts | (block.source == source))
    _fairness(scene, block, moves, chosen, other)
    waits = Value.cast(1)
    for port in block.packets_in:
        waits = waits & port.valid & ~port.ready
    progress(scene, "input moves", waits & ready, 1)
    progress(scene, "output moves", (tracker.inside > 0) & ~out.valid, 1)


def _fairness(
    scene: Scene, block: PacketArbiter, moves: Array, chosen: Value, other: Value
) -> None:
    """Claim that an input waits for at most one packet of each other input."""
    m = scene.m
    waits = Array(port.valid & ~port.ready for port in block.packets_in)[chosen]
    lasts = Array(port.payload.last for port in block.packets_in)
    passed = Signal(2, name="other_passed")
    with m.If(~waits):
        m.d.sync += passed.eq(0)
    with m.Elif(moves[other] & lasts[other] & (passed != 3)):
        m.d.sync += passed.eq(passed + 1)
    scene.claim("turns", passed <= 1)


_ROUTER = PacketRouter.elaborate


def _router(scene: Scene) -> None:
    """Follow the packets of any one of two topics through a router."""
    m, topics = scene.m, 2
    m.submodules.block = block = PacketRouter(1, topics, topic_bits=2)
    came = block.packets_in
    packet_source(scene, came, "i", beside=[block.topic])
    ready = Value.cast(1)
    for number, port in enumerate(block.packets_out):
        ready = ready & sink(scene, port, f"o{number}")
        rules(scene, port, f"o{number}")
        packet_rules(scene, port, f"o{number}")
    chosen = scene.rigid(range(topics), "chosen")
    starts, topic, begun = starts_of(m, came, "in"), Signal(2), Signal(2, name="topic_begun")
    m.d.comb += topic.eq(Mux(starts, block.topic, begun))
    with m.If(fires(came)):
        m.d.sync += begun.eq(topic)
    beat = Signal(packet_layout(1))
    outs = block.packets_out
    m.d.comb += Value.cast(beat).eq(Array(Value.cast(p.payload) for p in outs)[chosen])
    tracker = Tracker(scene, "unit", 6)
    tracker.enter(fires(came) & (topic == chosen), came.payload)
    tracker.leave(Array(fires(port) for port in outs)[chosen], beat)
    progress(scene, "input moves", came.valid & ready & ~came.ready, 1)
    both = Value.cast(0)
    for port in outs:
        both = both | port.valid
    progress(scene, "output moves", (tracker.inside > 0) & ~both, 0)
    expected = Signal.like(block.counters)
    ends = fires(came) & came.payload.last
    known = topic < topics
    add_counters(m, expected, {"routed": ends & known, "unknown": ends & ~known})
    scene.claim("counters", Value.cast(expected) == Value.cast(block.counters))


def _slice_study() -> Study:
    """Return the study of a slice."""
    return Study(
        "slice",
        "`StreamSlice`, packets of 2-byte beats",
        _slice,
        (
            Claim("valid stays", _FALLS),
            Claim("payload stays", _CHANGES),
            Claim(
                "count",
                Bug(_SLICE, "out.eq(Mux(ready, incoming, second))", "out.eq(incoming & ~second)"),
            ),
            Claim("order", _STALE),
            Claim("nothing extra", _TWICE),
            Claim("input moves", _STUCK),
            Claim("output moves", _LOST),
        ),
    )


def _arbiter_study() -> Study:
    """Return the study of an arbiter."""
    return Study(
        "arbiter",
        "`PacketArbiter(1, 3)`, any input",
        _arbiter,
        (
            Claim("valid stays", _FALLS),
            Claim("payload stays", _CHANGES),
            Claim("count", Bug(_SLICE, "out.eq(Mux(ready, incoming, second))", "out.eq(0)")),
            Claim("order", Bug(_ARBITER, "source.eq(turn.number)", "source.eq(~turn.number)")),
            Claim("nothing extra", Bug(_ARBITER, "has_beat.eq(valid)", "has_beat.eq(1)")),
            Claim("whole packets", _HOPS),
            Claim(
                "turns",
                Bug(
                    PacketArbiter._choose,
                    "other = (number + distance) % count",
                    "other = distance % count",
                ),
            ),
            Claim(
                "input moves",
                Bug(_TURNS, "Mux(opens, following.bits, 0)", "readies & following.bits"),
            ),
            Claim(
                "output moves",
                Bug(_ARBITER, "has_beat.eq(valid)", "has_beat.eq(valid & last)"),
            ),
        ),
    )


def _router_study() -> Study:
    """Return the study of a router."""
    return Study(
        "router",
        "`PacketRouter(1, 2)`, any topic of 4",
        _router,
        (
            Claim("valid stays", _FALLS),
            Claim("payload stays", _CHANGES),
            Claim(
                "count",
                Bug(_ROUTER, "eq(packets.payload),", "eq(~packets.payload.as_value()),"),
            ),
            Claim("order", Bug(_ROUTER, "Mux(inside, begun, named)", "Mux(inside, named, named)")),
            Claim(
                "nothing extra",
                Bug(_ROUTER, "out.o.valid & out.o.payload.to[number]", "out.o.valid"),
            ),
            Claim(
                "input moves",
                Bug(
                    _ROUTER,
                    "takes.append(port.ready & ",
                    "takes.append(port.ready & port.valid[0] & ~",
                ),
            ),
            Claim(
                "output moves",
                Bug(
                    _ROUTER,
                    "port.valid.eq(out.o.valid &",
                    "port.valid.eq(out.o.valid & inside &",
                ),
            ),
            Claim("counters", Bug(_ROUTER, '"routed": ends & to.any()', '"routed": ends')),
        ),
    )


def studies() -> list[Study]:
    """Return the studies of these parts."""
    return [
        _slice_study(),
        *(_width(a, b) for a, b in ((1, 4), (4, 1), (8, 2), (2, 2))),
        _arbiter_study(),
        _router_study(),
    ]
