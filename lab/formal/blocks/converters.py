"""Claims about whole converters of types of fixed size: deserializers and serializers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from amaranth.hdl import Array, Cat, Const, Mux, Signal, Value

from firm_hdl.frontend import load_message
from firm_hdl.gateware.deserializer import Deserializer
from firm_hdl.gateware.mover import Mover, _put
from firm_hdl.gateware.parse.buffer import Buffer
from firm_hdl.gateware.parse.sequencer import Sequencer
from firm_hdl.gateware.parse.walk import Walk
from firm_hdl.gateware.signatures import Status, leaf_streams
from firm_hdl.plan.yaml import counted
from lab.formal.bugs import Bug
from lab.formal.catalog import Claim, Study
from lab.formal.scene import Scene
from lab.formal.streams import (
    fires,
    packet_source,
    progress,
    rules,
    sink,
    starts_of,
)

__all__ = ["BITS", "BOOL", "DATA_DEPTH", "JOY", "FixedType", "studies"]

DATA_DEPTH = 12
"""Cycles of claims that compare data, which take longest."""

BITS = 7
"""Bits of counts of packets and bytes; more than any of the converters holds."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FixedType:
    """A message type of fixed size, as its specification has it.

    Attributes
    ----------
    name, distro : str
    fields : tuple of (int, int)
        Offset in the packet, and size, of each leaf.
    size : int
        Size of a packet, without what may follow.
    header : bytes
        Encapsulation header.
    trailing : int
        Bytes that may follow.
    """

    name: str
    distro: str
    fields: tuple[tuple[int, int], ...]
    size: int
    header: bytes = b""
    trailing: int = 0


_CDR = b"\0\1\0\0"
BOOL = FixedType(name="std_msgs/Bool", distro="noetic", fields=((0, 1),), size=1)
JOY = FixedType(
    name="sensor_msgs/JoyFeedback", distro="noetic", fields=((0, 1), (1, 1), (2, 4)), size=6
)
JOY_CDR = FixedType(
    name="sensor_msgs/msg/JoyFeedback",
    distro="lyrical",
    fields=((4, 1), (5, 1), (8, 4)),
    size=12,
    header=_CDR,
    trailing=3,
)
TIME_CDR = FixedType(
    name="builtin_interfaces/msg/Time",
    distro="lyrical",
    fields=((4, 4), (8, 4)),
    size=12,
    header=_CDR,
    trailing=3,
)


def status_of(kind: FixedType, size: Value, wrong_header: Value) -> Value:
    """Return the status that a packet has by its size and its header."""
    long = Mux(size > kind.size + kind.trailing, Status.TRAILING, Status.OK)
    code = Mux(size < kind.size, Status.TRUNCATED, long)
    return Mux(wrong_header, Status.ENCAPSULATION, code)


class PacketNotes:
    """What the surroundings note of one packet, which they choose, while it enters.

    Attributes
    ----------
    chooses : Signal
        The first beat of the packet enters.
    size, ended, wrong_header, byte : Signal
        Bytes that entered, whether this is all, whether the header is wrong, and the byte at
        `place`. Registers.
    """

    def __init__(self, scene: Scene, port: Any, place: Value, *, header: bool):
        m, beat = scene.m, port.payload
        lanes = len(beat.data)
        self.chooses, self.size = Signal(name="chooses"), Signal(BITS, name="packet_size")
        self.ended, self.byte = Signal(name="packet_ended"), Signal(8, name="packet_byte")
        self.wrong_header = Signal(name="packet_wrong_header")
        self.chosen, self.starts = Signal(name="packet_chosen"), starts_of(m, port, "in")
        m.d.comb += self.chooses.eq(
            scene.free(1, "mark") & fires(port) & self.starts & ~self.chosen
        )
        with m.If(self.chooses):
            m.d.sync += self.chosen.eq(1)
        with m.If(fires(port) & (self.chooses | (self.chosen & ~self.ended))):
            m.d.sync += self.ended.eq(beat.last)
            # Larger packets are all alike.
            with m.If(self.size < (1 << BITS) - 2 * lanes):
                m.d.sync += self.size.eq(self.size + beat.count)
            for lane in range(lanes):
                at, valid = self.size + Const(lane, BITS), beat.count > Const(lane, BITS)
                with m.If(valid & (at == place)):
                    m.d.sync += self.byte.eq(beat.data[lane])
                if header:
                    wrong = ((at == 0) & (beat.data[lane] != 0)) | (
                        (at == 1) & (beat.data[lane] != 1)
                    )
                    with m.If(valid & wrong):
                        m.d.sync += self.wrong_header.eq(1)


_DATA = ("one each", "statuses", "values", "wire order")
_DESERIALIZER_BUGS = {
    "valid stays": Bug(Mover.elaborate, "with m.If(port.ready):", "with m.If(1):"),
    "payload stays": Bug(Mover.elaborate, "m.If(writer.go)", "m.If(writer.active)"),
    "one each": Bug(Mover.elaborate, "ends_now.eq(ends)", "ends_now.eq(1)"),
    "statuses": Bug(Sequencer.elaborate, "Status.TRUNCATED", "Status.LENGTH"),
    "values": Bug(_put, "m.If(good)", "m.If(~good)"),
    "wire order": Bug(Mover.elaborate, "ends_now.eq(ends)", "ends_now.eq(self.orders.valid)"),
    "status in time": Bug(Walk.find, "cut.eq(arrival.ended & ~self.present)", "cut.eq(0)"),
    "input moves": Bug(Buffer._receive, "room.eq(~used[-1]", "room.eq(used[-1]"),
}


def _deserializer(kind: FixedType, bus_bytes: int, depth: int) -> Study:
    def build(scene: Scene) -> None:
        block = Deserializer(load_message(kind.name, distro=kind.distro), bus_bytes=bus_bytes)
        scene.m.submodules.block = block
        packet_source(scene, block.packets, "i")
        ports = [*leaf_streams(block.message, block.tree).values(), block.status]
        ready = Value.cast(1)
        for number, port in enumerate(ports):
            ready = ready & sink(scene, port, f"o{number}")
            rules(scene, port, f"o{number}")
        _check_transfers(scene, kind, block, ports, ready)

    name = f"deserializer-{kind.name.split('/')[-1].lower()}-{kind.distro}-{bus_bytes}"
    return Study(
        name,
        f"`Deserializer` of {kind.name} ({kind.distro}), {counted(bus_bytes, 'byte')}",
        build,
        tuple(
            Claim(claim, bug, "BMC", DATA_DEPTH if claim in _DATA else depth)
            for claim, bug in _DESERIALIZER_BUGS.items()
            if claim != "wire order" or len(kind.fields) > 1
        ),
    )


def _check_transfers(
    scene: Scene, kind: FixedType, block: Deserializer, ports: Sequence[Any], ready: Value
) -> None:
    """Compare the transfers of any leaf, and those of the status, with one packet."""
    m, count = scene.m, len(ports)
    # A stream, and a byte of its payload; the last stream is the status.
    which = scene.rigid(range(count), "which")
    part = scene.rigid(range(max(2, *(size for _, size in kind.fields))), "part")
    sizes = Array([size for _, size in kind.fields] + [1])
    offsets = Array([at for at, _ in kind.fields] + [0])
    scene.assume((which < count) & (part < sizes[which]))
    place, is_status = offsets[which] + part, which == count - 1
    notes = PacketNotes(scene, block.packets, place, header=bool(kind.header))
    moved = Array(fires(port) for port in ports)[which]
    valid = Array(port.valid for port in ports)[which]
    begins = fires(block.packets) & notes.starts
    # Packets that have begun and whose transfer is to come; those before the packet.
    inside = Signal(BITS, name="inside")
    before, waits = Signal(BITS, name="before"), Signal(name="waits")
    m.d.sync += inside.eq(inside + begins - moved)
    with m.If(notes.chooses):
        m.d.sync += [before.eq(inside - moved), waits.eq(1)]
    with m.Elif(moved & waits):
        m.d.sync += [before.eq(before - 1), waits.eq(before != 0)]
    hits = valid & waits & (before == 0)
    scene.claim("one each", ~valid | (inside != 0))
    scene.claim("statuses", ~(hits & is_status) | notes.ended)
    code = Value.cast(ports[-1].payload)
    right = Value.cast(status_of(kind, notes.size, notes.wrong_header))
    scene.claim("statuses", ~(hits & is_status) | (code == right))
    # What came whole before an error has its value; after an error, there are zeros.
    most = 8 * max(size for _, size in kind.fields)
    values = [_extended(port.payload, most) for port in ports[:-1]] + [Const(0, most)]
    given = Array(values)[which].word_select(part, 8)
    came = (notes.size >= offsets[which] + sizes[which]) & ~notes.wrong_header
    byte = notes.byte.bool() if kind is BOOL else notes.byte
    scene.claim("values", ~(hits & ~is_status) | (given == Mux(came, byte, 0)))
    scene.claim("values", ~(hits & ~is_status) | came | notes.ended | notes.wrong_header)
    if len(kind.fields) > 1:
        _check_order(scene, ports, which, inside, valid, begins)
    _check_liveness(scene, block, ready)


def _extended(payload: Any, bits: int) -> Value:
    """Return a payload with zeros above it."""
    value = Value.cast(payload)
    return Cat(value, Const(0, bits - len(value)))


def _check_order(
    scene: Scene, ports: Sequence[Any], which: Value, inside: Value, valid: Value, begins: Value
) -> None:
    """Claim that a leaf, or the status, becomes valid no earlier than the leaf before it."""
    m, later = scene.m, which + 1
    moved = Array([*(fires(port) for port in ports), Value.cast(0)])[later]
    offered = Array([*(port.valid for port in ports), Value.cast(0)])[later]
    after = Signal(BITS, name="inside_after")
    m.d.sync += after.eq(after + begins - moved)
    exists = later < len(ports)
    scene.claim("wire order", ~exists | (inside - valid <= after - offered))


def _check_liveness(scene: Scene, block: Deserializer, ready: Value) -> None:
    """Claim that with all leaves taken, a packet that has ended gets its status."""
    m, ended = scene.m, Signal(BITS, name="ended")
    ends = fires(block.packets) & block.packets.payload.last
    m.d.sync += ended.eq(ended + ends - fires(block.status))
    scene.claim("one each", ~block.status.valid | (ended != 0))
    progress(scene, "status in time", ready & (ended != 0) & ~block.status.valid, 12)
    progress(scene, "input moves", ready & block.packets.valid & ~block.packets.ready, 12)


def studies() -> list[Study]:
    """Return the studies of converters."""
    return [
        _deserializer(BOOL, 1, 15),
        _deserializer(JOY, 1, 18),
        _deserializer(JOY_CDR, 4, 18),
        _deserializer(TIME_CDR, 8, 16),
    ]
