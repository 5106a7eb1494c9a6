"""The packer: turn words into packets of full beats."""

from __future__ import annotations

from dataclasses import dataclass

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.collect import words_layout
from firm_hdl.gateware.memories import LutMemory
from firm_hdl.gateware.positions import Ring, known_lane_bits, rotate
from firm_hdl.gateware.signatures import PacketSignature
from firm_hdl.program import SerializerProgram

__all__ = ["Packer"]


class Packer(wiring.Component):
    """Write words to a ring of beats, and send the beats that are complete.

    A pipeline of three cycles. The first one computes the positions of both words and rotates the
    words to their lanes. The second one writes the words to the ring, which has separate memories
    for each of the two words. The third one sends a beat. Throughput two words in and one beat out
    per cycle; latency 3 cycles.

    Parameters
    ----------
    program : SerializerProgram

    Members
    -------
    words : In(stream.Signature(words_layout(plan)))
        `ready` is a register.
    packets : Out(PacketSignature(bus_bytes))
    error : Out(1)
        The packet is marked with an error. Set only with the last beat of the packet.
    """

    def __init__(self, program: SerializerProgram):
        self.program, self.plan = program, program.plan
        plan = self.plan
        super().__init__(
            {
                "words": In(stream.Signature(words_layout(plan))),
                "packets": Out(PacketSignature(plan.bus_bytes)),
                "error": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        return _PackerLogic(self).m


@dataclass(frozen=True, slots=True)
class _Placed:
    """A rotated word: all lanes, the position of the first byte, and the number of bytes."""

    data: Signal
    start: Value
    size: Signal


class _PackerLogic:
    """The packer's logic, built by one method for each part of it."""

    def __init__(self, packer: Packer):
        self.c, self.plan, self.program = packer, packer.plan, packer.program
        self.ring = ring = Ring(packer.plan)
        self.m = m = Module()
        # Beats before `complete` can be sent; `first` is the next one.
        self.complete, self.first = (
            Signal(ring.beat_bits, name=name) for name in ("complete", "first")
        )
        self.reads, self.writes = Signal(name="reads"), Signal(name="writes")
        self.takes = Signal(name="takes")
        m.d.comb += self.takes.eq(packer.words.valid & packer.words.ready)
        m.d.sync += self.writes.eq(self.takes)
        self._place()
        self._reserve_room()
        self._send(self._beat())

    # First cycle.

    def _place(self) -> None:
        """Compute the positions of the words, and rotate them."""
        m, ring, plan = self.m, self.ring, self.plan
        words, bus = self.c.words.payload, plan.bus_bytes
        self.at = ring.position("at")
        self.end = ring.position("end")
        base, map_at, map_end = (ring.position(name) for name in ("base", "map_at", "map_end"))
        phase: Value | int = plan.header_bytes
        if bus < 8:
            phase = Signal(3, name="phase", init=plan.header_bytes % 8)
        m.d.comb += [
            base.eq(self._rounded(self.at, words.to_map, words.map_mask, phase, Const(0))),
            self.end.eq(self._rounded(base, words.to_end, words.end_mask, phase, words.last)),
            map_at.eq(Cat(ring.lane(base), ring.beat(base) + words.lead)),
            map_end.eq(map_at + words.map_bytes),
        ]
        items_at = Mux(words.lead, base, self.at)
        self.placed = {
            "items": self._rotated("items", items_at, words.items_bytes, self.program.items.lanes),
            "map": self._rotated("map", map_at, words.map_bytes, self.program.map.lanes),
        }
        # The first beat that these words do not complete; whether the packet ends.
        self.complete_next = Signal(ring.beat_bits, name="complete_next")
        self.ends_packet = Signal(name="ends_packet")
        self.last_bytes = Signal(range(bus + 1), name="last_bytes")
        self.failed, self.waits = Signal(name="failed"), Signal(name="waits")
        # The packet may end without another byte: then a beat that is just full is held back. A
        # step of an empty packet has no beat to hold.
        holds_last = self.program.may_end_without_bytes
        sent = Mux(words.last | words.empty, self.end, self.end - 1) if holds_last else self.end
        done = ring.beat(sent)
        full = Cat(ring.lane(map_end), Const(0, 1)) - 1
        with m.If(self.takes):
            m.d.sync += [
                self.at.eq(self.end),
                self.complete_next.eq(done),
                self.ends_packet.eq(words.last),
                self.failed.eq(words.error),
                self.waits.eq(words.waits),
                self.last_bytes.eq(Mux(words.empty, 0, full[: ring.lane_bits] + 1)),
            ]
            if not isinstance(phase, int):
                with m.If(words.last):
                    m.d.sync += phase.eq(self.end + plan.header_bytes)

    def _rounded(
        self, value: Value, distance: Value, mask: Value, phase: Value | int, last: Value
    ) -> Value:
        """Return a position after a distance, with low bits cleared by a mask.

        Alignment counts from `phase`. The end of a packet (`last`) is rounded up to a whole beat.
        """
        m, size = self.m, len(value)
        total = Signal(size)
        m.d.comb += total.eq(value + distance)
        if isinstance(phase, int):
            return ((total & ~Cat(mask, Const(0, size))) | (mask & Mux(last, 0, phase)))[:size]
        pad = Signal(3)
        m.d.comb += pad.eq((phase - total) & mask)
        return Mux(last, total & ~Cat(mask, Const(0, size - len(mask))), total + pad)[:size]

    def _rotated(self, name: str, start: Value, size: Value, lanes: tuple[int, ...]) -> _Placed:
        """Rotate a word so that its first byte is in the lane of its position."""
        m, ring, bus = self.m, self.ring, self.plan.bus_bytes
        word = rotate(
            m,
            getattr(self.c.words.payload, name),
            ring.lane(start),
            lanes,
            f"{name}_rotated",
            back=True,
        )
        register = ring.position(f"{name}_start")
        first, known = known_lane_bits(lanes, bus)
        placed = _Placed(
            Signal(8 * bus, name=f"{name}_placed", reset_less=True),
            Cat(Const(first, known), register[known:]),
            Signal(range(bus + 1), name=f"{name}_size"),
        )
        with m.If(self.takes):
            m.d.sync += [placed.data.eq(word), register.eq(start), placed.size.eq(size)]
        return placed

    def _reserve_room(self) -> None:
        """Make `words.ready` high only if the ring has room for the largest step."""
        m, ring = self.m, self.ring
        # The last beat in which a step may start.
        bound = Signal(ring.beat_bits, name="bound", init=ring.depth - self.program.most_beats)
        newest, room = (Signal(ring.beat_bits, name=name) for name in ("newest", "room"))
        ready = Signal(name="ready", init=1)
        m.d.comb += [
            newest.eq(ring.beat(self.at) + Mux(self.takes, self.c.words.payload.max_beats, 0)),
            room.eq(bound - newest),
            self.c.words.ready.eq(ready),
        ]
        m.d.sync += ready.eq(~room[-1])
        with m.If(self.reads):
            m.d.sync += bound.eq(bound + 1)

    # Second cycle.

    def _beat(self) -> Value:
        """Write words to the ring, and return the bytes of the next beat to send."""
        plan, program = self.plan, self.program
        units = {"items": program.items.unit, "map": program.map.unit}
        # Without padding, a byte that is not of items is of a map, or after the packet's end.
        padded = bool(plan.header_bytes) or program.aligns
        words = {
            name: [self._lanes(name, k, unit, has_flags=padded or name == "items") for k in starts]
            for name, unit in units.items()
            for starts in [range(0, plan.bus_bytes, unit)]
        }
        # Groups of lanes, as many as the smaller unit, with the memories of both words.
        size = min(units.values())
        found = []
        for k in range(0, plan.bus_bytes, size):
            (a, a_has), (b, b_has) = (
                (word[k // unit][0][8 * (k % unit) :][: 8 * size], word[k // unit][1])
                for unit, word in zip(units.values(), words.values(), strict=True)
            )
            found.append(Mux(a_has, a, 0) | Mux(b_has, b, 0) if padded else Mux(a_has, a, b))
        return Cat(found)

    def _lanes(self, name: str, k: int, unit: int, *, has_flags: bool) -> tuple[Value, Value]:
        """Write lanes of a word, from lane k on.

        Returns
        -------
        These lanes of the next beat to send, and whether this word wrote them.
        """
        m, ring, placed = self.m, self.ring, self.placed[name]
        memory = LutMemory(m, f"{name}_{k}", 8 * unit, ring.depth)
        write, read = memory.write, memory.reader()
        index = Signal(max(1, ring.lane_bits), name=f"{name}_index_{k}")
        used = Signal(name=f"{name}_used_{k}")
        slot = Signal(ring.beat_bits - 1, name=f"{name}_slot_{k}")
        lane = ring.lane(placed.start)
        m.d.comb += [
            index.eq(k - lane if ring.lane_bits else 0),
            used.eq(self.writes & (index < placed.size)),
            # Lanes before the first byte are of the next beat.
            slot.eq(ring.slot(placed.start) + (lane > k if k < self.plan.bus_bytes - unit else 0)),
            write.addr.eq(slot),
            write.data.eq(placed.data[8 * k : 8 * (k + unit)]),
            write.en.eq(used),
            read.addr.eq(self.first),
        ]
        if not has_flags:
            return read.data, Const(1, 1)
        # By slot: whether this word wrote these lanes of the beat. A shift of `used` would simulate
        # faster, but takes 2 % more cells.
        has = Signal(ring.depth, name=f"{name}_has_{k}")
        for beat in range(ring.depth):
            with m.If(self.reads & (self.first[:-1] == beat)):
                m.d.sync += has[beat].eq(0)
            with m.Elif(used & (slot == beat)):
                m.d.sync += has[beat].eq(1)
        written = Signal(name=f"{name}_written_{k}")
        m.d.comb += written.eq((has >> self.first[:-1])[0])
        return read.data, written

    # Third cycle.

    def _send(self, beat: Value) -> None:
        m, ring, packets = self.m, self.ring, self.c.packets
        slot = (self.complete_next - 1)[: ring.beat_bits - 1]
        layout = data.StructLayout({"count": range(self.plan.bus_bytes + 1), "error": 1})
        ends = LutMemory(m, "ends", layout, ring.depth)
        write, read = ends.write, ends.reader()
        m.d.comb += [
            write.addr.eq(slot),
            write.data.count.eq(self.last_bytes),
            write.data.error.eq(self.failed),
            write.en.eq(self.writes & self.ends_packet),
            read.addr.eq(self.first),
            self.reads.eq((self.complete != self.first) & (~packets.valid | packets.ready)),
        ]
        # By slot: whether the beat is the last one of its packet.
        last, is_last = Signal(ring.depth, name="last"), Signal(name="is_last")
        m.d.comb += is_last.eq((last >> self.first[:-1])[0])
        # Beats of constants only are held until the first leaf is taken.
        with m.If(self.writes & ~self.waits):
            m.d.sync += self.complete.eq(self.complete_next)
            with m.If(self.ends_packet):
                m.d.sync += last.bit_select(slot, 1).eq(1)
        payload = Signal(packets.payload.shape(), name="payload", reset_less=True)
        error = Signal(name="error_now", reset_less=True)
        m.d.comb += [Value.cast(packets.payload).eq(Value.cast(payload)), self.c.error.eq(error)]
        with m.If(packets.ready):
            m.d.sync += packets.valid.eq(0)
        with m.If(self.reads):
            m.d.sync += [
                packets.valid.eq(1),
                self.first.eq(self.first + 1),
                Value.cast(payload.data).eq(beat),
                payload.last.eq(is_last),
                payload.count.eq(Mux(is_last, read.data.count, self.plan.bus_bytes)),
                error.eq(is_last & read.data.error),
                last.bit_select(self.first[:-1], 1).eq(0),
            ]
