"""Claims about a gate that drops what it cannot take.

Which packets overrun the gate follows from its timing, and no claim says so. Each packet has a
status, which says whether it leaves. The claims are that a packet can have this status, and that
the packets with the status `OK` leave, whole and in order, and no others.

A gate has room for hundreds of beats. Runs that fill so much room are too long for a proof. So the
gate of the proof has room for a few beats, and is otherwise the same.
"""

from __future__ import annotations

from typing import Any
from unittest.mock import patch

from amaranth.hdl import Array, Cat, Module, Mux, Signal, Value

from firm_hdl.frontend import load_message
from firm_hdl.gateware.packets import gate
from firm_hdl.gateware.packets.gate import PacketGate, _Verdicts
from firm_hdl.gateware.packets.reader import PacketReader
from firm_hdl.gateware.packets.status import GateStatus
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

__all__ = ["studies"]

BACKLOG_BEATS, WAITING_BEATS, STATUSES = 5, 2, 1
"""Beats that wait for the parser, and for its verdict; and statuses that wait."""

MESSAGE_BYTES = 2
"""Size of a `std_msgs/UInt16` of ROS 1, in bytes, and in beats of a bus of one byte."""

BITS = 6
"""Bits of counters; no run is so long that they overflow."""

MOST_PACKETS = 4
"""Packets that leave of which the surroundings keep a bit."""

DEPTH = 28
DEPTHS = {"order": 24, "statuses": 26, "status in time": 32}
"""Cycles of proofs; of those that take longer, or need more cycles."""


class _SmallGate(PacketGate):
    """A gate with room for few beats and statuses."""

    def elaborate(self, platform: object) -> Module:
        sizes: dict[str, Any] = {"BACKLOG_BEATS": BACKLOG_BEATS, "STATUSES": STATUSES}
        with patch.multiple(gate, **sizes, ring_beats=lambda _: WAITING_BEATS // 2):
            return super().elaborate(platform)


class _Packets:
    """The packets of a stream of bytes.

    Attributes
    ----------
    ends : Value
        A packet ends in this cycle.
    size : Value
        Its bytes up to the present beat; 3 stands for more.
    bit : Signal
        One bit of its first two bytes, which the surroundings choose for ever.
    """

    def __init__(self, scene: Scene, port: Any, which: Signal, name: str):
        m, beat = scene.m, port.payload
        before, kept = Signal(2, name=f"{name}_before"), Signal(name=f"{name}_kept")
        self.size, self.bit = Signal(2, name=f"{name}_size"), Signal(name=f"{name}_bit")
        here = (before == which[3]) & (beat.count != 0)
        m.d.comb += [
            self.size.eq(Mux(before == 3, 3, before + beat.count)),
            self.bit.eq(Mux(here, beat.data[0].bit_select(which[:3], 1), kept)),
        ]
        self.ends = fires(port) & beat.last
        with m.If(fires(port)):
            m.d.sync += [before.eq(Mux(beat.last, 0, self.size)), kept.eq(self.bit)]


class _Status:
    """The status of one packet, which the surroundings choose as it begins.

    Attributes
    ----------
    begun, ended, given : Signal
        Packets that began and ended before this cycle; statuses that were taken.
    hits : Signal
        The packet's status is offered.
    has_ended : Signal
        The packet ended before this cycle.
    noted : Signal
        What was noted as it ended.
    """

    def __init__(self, scene: Scene, came: Any, given: Any, noted: Value):
        m = scene.m
        self.begun, self.ended = Signal(BITS, name="begun"), Signal(BITS, name="ended")
        self.given, self.noted = Signal(BITS, name="given"), Signal(len(noted), name="noted")
        self.hits, self.has_ended = Signal(name="status_hits"), Signal(name="has_ended")
        place, chosen, waits = Signal(BITS, name="number"), Signal(), Signal()
        chooses, inside = Signal(name="chooses"), Signal(name="is_inside")
        begins = fires(came) & starts_of(m, came, "in")
        ends = fires(came) & came.payload.last
        m.d.comb += [
            chooses.eq(begins & ~chosen & scene.free(1, "packet_mark")),
            self.hits.eq(given.valid & waits & (self.given == place)),
        ]
        m.d.sync += [
            self.begun.eq(self.begun + begins),
            self.ended.eq(self.ended + ends),
            self.given.eq(self.given + fires(given)),
            inside.eq((chooses | inside) & ~ends),
        ]
        with m.If(chooses):
            m.d.sync += [chosen.eq(1), waits.eq(1), place.eq(self.begun)]
        with m.If((chooses | inside) & ends):
            m.d.sync += [self.has_ended.eq(1), self.noted.eq(noted)]
        scene.claim("one status", ~given.valid | (self.given < self.begun))


def _gate(scene: Scene) -> None:
    """Send any packets through a gate for messages of two bytes."""
    m = scene.m
    message = load_message("std_msgs/UInt16", distro="noetic")
    m.submodules.block = block = _SmallGate(
        message, bus_bytes=1, memory_bytes=MESSAGE_BYTES, packets=1, when_full="drop"
    )
    came, out, given = block.packets_in, block.packets_out, block.status
    packet_source(scene, came, "i")
    takes, ready = sink(scene, given, "status"), sink(scene, out, "o")
    rules(scene, out, "o", block.size)
    rules(scene, given, "status")
    packet_rules(scene, out, "o")
    which = scene.rigid(4, "which")
    entered, left = _Packets(scene, came, which, "in"), _Packets(scene, out, which, "out")
    code = Mux(
        entered.size < MESSAGE_BYTES,
        GateStatus.TRUNCATED,
        Mux(entered.size > MESSAGE_BYTES, GateStatus.TRAILING, GateStatus.OK),
    )
    status = _Status(scene, came, given, Cat(Value.cast(code)[:4], entered.bit))
    got, noted = Value.cast(given.payload), status.noted[:4]
    full = (noted == GateStatus.OK) & (got == GateStatus.FULL)
    judged = status.has_ended & ((got == noted) | full)
    scene.claim("statuses", ~status.hits | judged | (got == GateStatus.OVERRUN))
    is_ok = fires(given) & (got == GateStatus.OK)
    owed = _check_order(scene, status, is_ok, left)
    scene.claim("nothing extra", ~left.ends | (left.size == MESSAGE_BYTES))
    scene.claim("size", ~out.valid | (block.size == MESSAGE_BYTES))
    _check_counters(scene, block, fires(given) & (got == GateStatus.OVERRUN), status)
    progress(scene, "status in time", takes & (status.ended > status.given) & ~given.valid, 16)
    progress(scene, "output moves", ready & owed & ~out.valid, 4)


def _check_order(scene: Scene, status: _Status, is_ok: Value, left: _Packets) -> Value:
    """Claim that the packet with the n-th status `OK` is the n-th one that leaves.

    Returns whether a packet with such a status has not left.
    """
    m = scene.m
    oks, gone = Signal(BITS, name="oks"), Signal(BITS, name="gone")
    place, is_kept = Signal(BITS, name="place"), Signal(name="is_kept")
    bits = Array(Signal(name=f"bit_{number}") for number in range(MOST_PACKETS))
    m.d.sync += [oks.eq(oks + is_ok), gone.eq(gone + left.ends)]
    with m.If(is_ok & status.hits):
        m.d.sync += [place.eq(oks), is_kept.eq(1)]
    with m.If(left.ends & (gone < MOST_PACKETS)):
        m.d.sync += bits[gone[:2]].eq(left.bit)
    same = bits[place[:2]] == status.noted[4]
    scene.claim("order", ~(is_kept & (place < gone) & (place < MOST_PACKETS)) | same)
    # Its status comes before a packet has left, or waits until it is taken.
    scene.claim("nothing extra", gone <= oks + (status.begun - status.given))
    return oks > gone


def _check_counters(scene: Scene, block: PacketGate, overrun: Value, status: _Status) -> None:
    """Claim that the packets that overran the gate are counted, at most 4 cycles after they end.

    The status of a packet may come before its end.
    """
    reported, quiet = Signal(BITS, name="reported"), Signal(3, name="quiet")
    m, counted = scene.m, block.counters.overrun
    busy = status.begun != status.ended
    m.d.sync += [reported.eq(reported + overrun), quiet.eq(Mux(busy, 0, quiet + (quiet < 4)))]
    scene.claim("counters", (reported <= counted + (quiet < 4)) & (counted <= status.ended))


_READ, _REPORT = PacketReader.elaborate, _Verdicts.report_dropped


def studies() -> list[Study]:
    """Return the study of a gate that drops packets."""
    bugs = {
        "valid stays": Bug(_READ, "leaves.eq(~packets.valid | packets.ready)", "leaves.eq(1)"),
        "payload stays": Bug(_READ, "with m.If(self.begins):", "with m.If(starts):"),
        "count": Bug(
            _READ, "packets.payload.eq(self.word)", "packets.payload.eq(~self.word.as_value())"
        ),
        "one status": Bug(_Verdicts.give_statuses, "is_due.eq(leaves)", "is_due.eq(1)"),
        "statuses": Bug(_Verdicts.give_statuses, "self.reports | self.aborted", "self.reports"),
        "order": Bug(PacketWriter._write, "Mux(self.rewinds, self.kept, at + 1)", "at + 1"),
        "nothing extra": Bug(_Verdicts._store, "(status.payload != Status.OK)", "0"),
        "size": Bug(_Verdicts._store, "(status.payload != Status.OK)", "0"),
        "counters": Bug(_REPORT, "self.overrun.eq(tail_drop.drops)", "self.overrun.eq(0)"),
        "status in time": Bug(_Verdicts.give_statuses, "is_ready.eq(is_due)", "is_ready.eq(0)"),
        "output moves": Bug(_READ, "more.eq(self.at != self.kept)", "more.eq(0)"),
    }
    return [
        Study(
            "gate-drop",
            "`PacketGate` of std_msgs/UInt16, 1 byte, memory of 2 bytes, "
            '`when_full="drop"`, room for 7 beats and 1 status',
            _gate,
            tuple(Claim(name, bug, "BMC", DEPTHS.get(name, DEPTH)) for name, bug in bugs.items()),
        )
    ]
