"""Claims about whole serializers of types of fixed size."""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Array, Cat, Const, Mux, Signal, Value

from firm_hdl.frontend import load_message
from firm_hdl.gateware.collector import Collector
from firm_hdl.gateware.packer import Packer
from firm_hdl.gateware.serializer import Serializer
from firm_hdl.gateware.signatures import Status, leaf_streams
from firm_hdl.plan.yaml import counted
from lab.formal.blocks.converters import (
    BITS,
    BOOL,
    DATA_DEPTH,
    JOY,
    JOY_CDR,
    FixedType,
)
from lab.formal.bugs import Bug
from lab.formal.catalog import Claim, Study
from lab.formal.scene import Scene
from lab.formal.streams import fires, progress, rules, sink, source

__all__ = ["studies"]


def _serializer(kind: FixedType, bus_bytes: int, depth: int) -> Study:
    def build(scene: Scene) -> None:
        block = Serializer(load_message(kind.name, distro=kind.distro), bus_bytes=bus_bytes)
        scene.m.submodules.block = block
        leaves = list(leaf_streams(block.message, block.tree).values())
        for number, port in enumerate(leaves):
            source(scene, port, f"leaf{number}")
        ready = sink(scene, block.packets, "packets") & sink(scene, block.status, "status")
        rules(scene, block.packets, "packets", block.packet_error)
        rules(scene, block.status, "status")
        at = _check_layout(scene, kind, block.packets)
        _check_values(scene, kind, leaves, block.packets, at)
        _check_statuses(scene, leaves, block)
        offered = Value.cast(1)
        for port in leaves:
            offered = offered & port.valid
        progress(scene, "packets move", offered & ready & ~block.packets.valid, 12)

    name = f"serializer-{kind.name.split('/')[-1].lower()}-{kind.distro}-{bus_bytes}"
    return Study(
        name,
        f"`Serializer` of {kind.name} ({kind.distro}), {counted(bus_bytes, 'byte')}",
        build,
        tuple(
            Claim(claim, bug, "BMC", DATA_DEPTH if claim == "values" else depth)
            for claim, bug in _BUGS.items()
            if claim != "wire order" or len(kind.fields) > 1
        ),
    )


_BUGS = {
    "valid stays": Bug(Packer.elaborate, "with m.If(packets.ready):", "with m.If(1):"),
    "payload stays": Bug(Packer.elaborate, "(~packets.valid | packets.ready)", "1"),
    "layout": Bug(Packer.elaborate, "payload.last.eq(is_last)", "payload.last.eq(~is_last)"),
    "values": Bug(Packer.elaborate, "Value.cast(payload.data).eq(beat)", "payload.data.eq(~beat)"),
    "statuses": Bug(Collector.elaborate, "status.valid.eq(1)", "status.valid.eq(status.valid)"),
    "wire order": Bug(Collector.elaborate, "free & ~earlier", "free"),
    "packets move": Bug(Packer.elaborate, "complete.eq(complete_next)", "complete.eq(0)"),
}


def _check_layout(scene: Scene, kind: FixedType, packets: Any) -> Signal:
    """Claim where packets end, and their header and padding; return the place of the beat."""
    m, beat = scene.m, packets.payload
    at = Signal(BITS, name="place_of_beat")
    with m.If(fires(packets)):
        m.d.sync += at.eq(Mux(beat.last, 0, at + beat.count))
    ends = at + beat.count == kind.size
    scene.claim("layout", ~packets.valid | (beat.last == ends))
    full = beat.last | (beat.count == len(beat.data))
    scene.claim("layout", ~packets.valid | (full & (at + beat.count <= kind.size)))
    taken = {place for start, size in kind.fields for place in range(start, start + size)}
    for place in sorted(set(range(kind.size)) - taken):
        fixed = kind.header[place] if place < len(kind.header) else 0
        for lane in range(len(beat.data)):
            here = (
                packets.valid & (at + Const(lane, BITS) == place) & (beat.count > Const(lane, BITS))
            )
            scene.claim("layout", ~here | (beat.data[lane] == fixed))
    return at


def _check_values(
    scene: Scene, kind: FixedType, leaves: list[Any], packets: Any, at: Signal
) -> None:
    """Follow one byte of any leaf of any message."""
    m, beat, count = scene.m, packets.payload, len(leaves)
    which = scene.rigid(range(count), "which")
    most = max(size for _, size in kind.fields)
    part = scene.rigid(range(max(2, most)), "part")
    sizes, offsets = Array(size for _, size in kind.fields), Array(a for a, _ in kind.fields)
    scene.assume((which < count) & (part < sizes[which]))
    place = offsets[which] + part
    moved = Array(fires(port) for port in leaves)[which]
    values = [Cat(Value.cast(port.payload), Const(0, 8 * most))[: 8 * most] for port in leaves]
    ends = fires(packets) & beat.last
    chooses, chosen = Signal(name="chooses"), Signal(name="chosen")
    # Messages whose leaf was taken and whose packet has not ended; those before the message.
    inside, before = Signal(BITS, name="inside"), Signal(BITS, name="before")
    byte, waits = Signal(8, name="byte"), Signal(name="waits")
    m.d.comb += chooses.eq(scene.free(1, "mark") & moved & ~chosen)
    m.d.sync += inside.eq(inside + moved - ends)
    with m.If(chooses):
        m.d.sync += [
            chosen.eq(1),
            waits.eq(1),
            before.eq(inside - ends),
            byte.eq(Array(values)[which].word_select(part, 8)),
        ]
    with m.Elif(ends & waits):
        m.d.sync += [before.eq(before - 1), waits.eq(before != 0)]
    for lane in range(len(beat.data)):
        hits = (
            packets.valid
            & waits
            & (before == 0)
            & (at + Const(lane, BITS) == place)
            & (beat.count > Const(lane, BITS))
        )
        scene.claim("values", ~hits | (beat.data[lane] == byte))
    scene.claim("values", ~(packets.valid & beat.last) | (inside != 0))
    if count == 1:
        return
    # A later leaf of a message is taken no earlier than the one before it.
    ahead = Signal(BITS, name="taken_ahead")
    later = Array([*(fires(port) for port in leaves[1:]), Value.cast(0)])[which]
    m.d.sync += ahead.eq(ahead + moved - later)
    exists = which < count - 1
    scene.claim("wire order", ~(exists & later) | (ahead + moved != 0))


def _check_statuses(scene: Scene, leaves: list[Any], block: Serializer) -> None:
    """Claim that each message has one status, and that it is `OK`."""
    m, due = scene.m, Signal(BITS, name="statuses_due")
    m.d.sync += due.eq(due + fires(leaves[-1]) - fires(block.status))
    scene.claim(
        "statuses", ~block.status.valid | ((due != 0) & (block.status.payload == Status.OK))
    )
    scene.claim("statuses", ~(block.packets.valid & block.packet_error))
    # One is offered, one message has been taken, and the next one is not yet.
    scene.claim("statuses", due <= 3)


def studies() -> list[Study]:
    """Return the studies of serializers."""
    return [
        _serializer(BOOL, 1, 15),
        _serializer(JOY, 2, 14),
        _serializer(JOY_CDR, 4, 16),
    ]
