"""Claims about a parser and a gate, compared with what the specification says of small types.

The surroundings judge each packet themselves, from its bytes as they enter. So a gate is not
compared with the parser that it has inside.
"""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Cat, Mux, Signal, Value

from firm_hdl.frontend import load_message
from firm_hdl.gateware.packets.gate import PacketGate, _Verdicts
from firm_hdl.gateware.packets.reader import PacketReader
from firm_hdl.gateware.packets.status import GateStatus
from firm_hdl.gateware.packets.writer import PacketWriter
from firm_hdl.gateware.parse.buffer import Buffer
from firm_hdl.gateware.parse.checker import Checker
from firm_hdl.gateware.parse.walk import Walk
from firm_hdl.gateware.parser import PacketSizes, Parser, VerdictQueue
from firm_hdl.gateware.signatures import Status
from lab.formal.blocks.converters import DATA_DEPTH
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
)
from lab.formal.tracking import BeatTracker

__all__ = ["studies"]

_DATA = ("count", "one status", "statuses", "sizes", "order", "nothing extra")

BITS = 6
MOST_MESSAGE = 7
"""`max_message_bytes` of strings: their longest has 3 bytes."""

GATE_DEPTH = DATA_DEPTH + 2
"""Cycles of claims about a gate that compare data: a packet is inside longer than in a parser."""


def _judged(scene: Scene, packets: Any, name: str) -> tuple[Value, Value]:
    """Return the size of the packet whose last beat is offered, and its status.

    `std_msgs/Bool` and `std_msgs/String` of ROS 1 on a bus of a byte.
    """
    m, beat = scene.m, packets.payload
    before, length = Signal(BITS, name="bytes_before"), Signal(32, name="claimed")
    size, claimed = Signal(BITS, name="bytes_so_far"), Signal(32, name="claimed_now")
    m.d.comb += [size.eq(before + beat.count), claimed.eq(length)]
    with m.If(before < 4):
        m.d.comb += claimed.eq(length | (beat.data[0] << (before[:2] * 8)))
    with m.If(fires(packets)):
        # Larger packets are all alike.
        full = before == (1 << BITS) - 2
        m.d.sync += [
            before.eq(Mux(beat.last, 0, Mux(full, before, size))),
            length.eq(Mux(beat.last, 0, claimed)),
        ]
    if name == "std_msgs/Bool":
        code = Mux(size < 1, Status.TRUNCATED, Mux(size > 1, Status.TRAILING, Status.OK))
        return size, Value.cast(code)
    total = claimed[:BITS] + 4
    code = Mux(size > total, Status.TRAILING, Mux(size < total, Status.TRUNCATED, Status.OK))
    code = Mux(claimed > MOST_MESSAGE - 4, Status.LENGTH, code)
    return size, Value.cast(Mux(size < 4, Status.TRUNCATED, code))


class _Statuses:
    """The status of one packet, which the surroundings choose as it ends."""

    def __init__(self, scene: Scene, ends: Value, port: Any, noted: Value):
        m = scene.m
        self.due, self.noted = Signal(BITS, name="due"), Signal(len(noted), name="noted")
        before, waits, chosen = Signal(BITS, name="due_before"), Signal(), Signal()
        chooses = Signal(name="status_chooses")
        m.d.comb += chooses.eq(ends & ~chosen & scene.free(1, "status_mark"))
        m.d.sync += self.due.eq(self.due + ends - fires(port))
        with m.If(chooses):
            m.d.sync += [
                chosen.eq(1),
                waits.eq(1),
                self.noted.eq(noted),
                before.eq(self.due - fires(port)),
            ]
        with m.Elif(fires(port) & waits):
            m.d.sync += [before.eq(before - 1), waits.eq(before != 0)]
        self.hits = port.valid & waits & (before == 0)
        scene.claim("one status", ~port.valid | (self.due != 0))


def _parser(name: str, depth: int) -> Study:
    def build(scene: Scene) -> None:
        message = load_message(name, distro="noetic")
        block = Parser(message, bus_bytes=1, max_message_bytes=MOST_MESSAGE)
        scene.m.submodules.block = block
        packet_source(scene, block.packets, "i")
        ready = sink(scene, block.status, "status")
        rules(scene, block.status, "status", Value.cast(block.sizes))
        size, code = _judged(scene, block.packets, name)
        ends = fires(block.packets) & block.packets.payload.last
        status = _Statuses(scene, ends, block.status, Cat(size, code))
        got = Value.cast(block.status.payload)
        scene.claim("statuses", ~status.hits | (got == status.noted[BITS:]))
        scene.claim("sizes", ~status.hits | (block.sizes.packet == status.noted[:BITS]))
        progress(scene, "status in time", (status.due != 0) & ready & ~block.status.valid, 12)
        progress(scene, "input moves", ready & block.packets.valid & ~block.packets.ready, 12)

    bugs = {
        "valid stays": Bug(
            VerdictQueue.elaborate, "takes.eq(~first.ends | self", "takes.eq(1 | self"
        ),
        "payload stays": Bug(Parser.elaborate, "with m.If(verdicts.moves):", "with m.If(1):"),
        "one status": Bug(VerdictQueue.elaborate, "second.ends.eq(0)", "second.ends.eq(1)"),
        "statuses": Bug(Checker.elaborate, "Status.TRUNCATED", "Status.LENGTH"),
        "sizes": Bug(PacketSizes.elaborate, "self.beats.eq(0), over", "self.beats.eq(1), over"),
        "status in time": Bug(Walk.find, "cut.eq(arrival.ended & ~self.present)", "cut.eq(0)"),
        "input moves": Bug(Buffer._receive, "room.eq(~used[-1]", "room.eq(used[-1]"),
    }
    return Study(
        f"parser-{name.split('/')[-1].lower()}",
        f"`Parser` of {name}, 1 byte",
        build,
        tuple(
            Claim(claim, bug, "BMC", DATA_DEPTH if claim in _DATA else depth)
            for claim, bug in bugs.items()
        ),
    )


def _gate(name: str, depth: int, beats: int) -> Study:
    def build(scene: Scene) -> None:
        block = PacketGate(
            load_message(name, distro="noetic"),
            bus_bytes=1,
            memory_bytes=beats,
            packets=2,
            max_message_bytes=MOST_MESSAGE,
        )
        scene.m.submodules.block = block
        came, out = block.packets_in, block.packets_out
        packet_source(scene, came, "i")
        takes, ready = sink(scene, block.status, "status"), sink(scene, out, "o")
        rules(scene, out, "o", block.size)
        rules(scene, block.status, "status")
        packet_rules(scene, out, "o")
        size, code = _judged(scene, came, name)
        final = Mux((code == 0) & (size > beats), Value.cast(GateStatus.LARGE), code)
        ends = fires(came) & came.payload.last
        status = _Statuses(scene, ends, block.status, final)
        scene.claim("statuses", ~status.hits | (Value.cast(block.status.payload) == status.noted))
        tracker = BeatTracker(scene, "beat", 63)
        beat, gone = Value.cast(came.payload), Value.cast(out.payload)
        tracker.enter(fires(came), beat, decides=came.payload.last, keeps=final == 0)
        tracker.leave(fires(out), gone)
        waits = takes & ready
        progress(scene, "status in time", waits & (status.due != 0) & ~block.status.valid, 16)
        progress(scene, "output moves", waits & (tracker.inside > 0) & ~out.valid, 16)
        progress(scene, "input moves", waits & came.valid & ~came.ready, 16)

    read, write = PacketReader.elaborate, PacketWriter._write
    bugs = {
        "valid stays": Bug(read, "leaves.eq(~packets.valid | packets.ready)", "leaves.eq(1)"),
        "payload stays": Bug(read, "with m.If(self.begins):", "with m.If(starts):"),
        "count": Bug(
            read, "packets.payload.eq(self.word)", "packets.payload.eq(~self.word.as_value())"
        ),
        "one status": Bug(_Verdicts.give_statuses, "is_due.eq(leaves)", "is_due.eq(1)"),
        "statuses": Bug(_Verdicts._store, "status.ready.eq(self.ends)", "status.ready.eq(1)"),
        "order": Bug(write, "Mux(self.rewinds, self.kept, at + 1)", "at + 1"),
        "nothing extra": Bug(_Verdicts._store, "(status.payload != Status.OK)", "0"),
        "status in time": Bug(Walk.find, "cut.eq(arrival.ended & ~self.present)", "cut.eq(0)"),
        "output moves": Bug(read, "more.eq(self.at != self.kept)", "more.eq(0)"),
        "input moves": Bug(Buffer._receive, "room.eq(~used[-1]", "room.eq(used[-1]"),
    }
    return Study(
        f"gate-{name.split('/')[-1].lower()}",
        f"`PacketGate` of {name}, 1 byte, memory of {beats} bytes",
        build,
        tuple(
            Claim(claim, bug, "BMC", GATE_DEPTH if claim in _DATA else depth)
            for claim, bug in bugs.items()
        ),
    )


def studies() -> list[Study]:
    """Return the studies of parsers and gates."""
    return [
        _parser("std_msgs/Bool", 16),
        _parser("std_msgs/String", 18),
        _gate("std_msgs/Bool", 20, 2),
    ]
