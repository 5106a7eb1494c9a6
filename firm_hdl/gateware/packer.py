"""The packer: turn words into packets of full beats."""

from __future__ import annotations

from dataclasses import dataclass

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.memories import LutMemory
from firm_hdl.gateware.positions import Ring, constant_low_lane_bits, named, rotate
from firm_hdl.gateware.signatures import PacketSignature
from firm_hdl.gateware.words import words_layout
from firm_hdl.program import SerializerProgram, WordLanes

__all__ = ["Packer"]


@dataclass(frozen=True, slots=True)
class _Placed:
    """A rotated word: all lanes, the position of the first byte, and the number of bytes."""

    data: Signal
    start: Value
    size: Signal


class Packer(wiring.Component):
    """Write words to a ring of beats, and send the beats that are complete.

    Throughput two words in and one beat out per cycle; latency 3 cycles::

        cycle          | 0                  | 1            | 2          | 3
        words          | valid, ready       |              |            |
        they are       | placed and rotated | written      |            |
        beat           |                    | complete     | read       | packets.valid

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
        self.program, self.plan, self.ring = program, program.plan, Ring(program.plan)
        super().__init__(
            {
                "words": In(stream.Signature(words_layout(program.plan))),
                "packets": Out(PacketSignature(program.plan.bus_bytes)),
                "error": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        plan, program, ring, bus = self.plan, self.program, self.ring, self.plan.bus_bytes
        words, packets = self.words.payload, self.packets
        # Words are taken in this cycle; they are written in this cycle; a beat is read.
        takes = Signal()
        writes = Signal()
        reads = Signal()
        m.d.comb += takes.eq(self.words.valid & self.words.ready)
        m.d.sync += writes.eq(takes)

        # First cycle: the positions of both words, from the start of the state on (`at`).
        at, base, map_at, map_end, end = (
            ring.position(name) for name in ("at", "base", "map_at", "map_end", "end")
        )
        phase: Value | int = plan.header_bytes
        if bus < 8:
            phase = Signal(3, name="phase", init=plan.header_bytes % 8)
        map_beat = named(m, "map_beat", (ring.beat(base) + words.two_word_map)[: ring.beat_bits])
        m.d.comb += [
            base.eq(self._rounded(m, at, words.to_map, words.map_mask, phase, Const(0))),
            end.eq(self._rounded(m, base, words.to_end, words.end_mask, phase, words.last)),
            map_at.eq(Cat(ring.lane(base), map_beat)),
            map_end.eq(map_at + words.map_bytes),
        ]
        items_at = named(m, "items_at", Mux(words.two_word_map, base, at))
        placed = {
            "items": self._rotated(m, "items", takes, items_at, words.items_bytes, program.items),
            "map": self._rotated(m, "map", takes, map_at, words.map_bytes, program.map),
        }
        # The first beat that these words do not complete. The packet may end without another byte:
        # then a beat that is just full is held back. A state of an empty packet has none to hold.
        complete_next = Signal(ring.beat_bits)
        ends_packet = Signal()
        failed = Signal()
        waits = Signal()
        last_bytes = Signal(range(bus + 1))
        sent = Mux(words.last | words.empty, end, end - 1)
        done = ring.beat(sent if program.may_end_without_bytes else end)
        # Bytes in the last beat: the lane after the last byte, in which 0 stands for a full beat.
        full = Cat(ring.lane(map_end), Const(0, 1)) - 1
        with m.If(takes):
            m.d.sync += [
                at.eq(end),
                complete_next.eq(done),
                ends_packet.eq(words.last),
                failed.eq(words.error),
                waits.eq(words.waits),
                last_bytes.eq(Mux(words.empty, 0, full[: ring.lane_bits] + 1)),
            ]
            if isinstance(phase, Signal):
                with m.If(words.last):
                    m.d.sync += phase.eq(end + plan.header_bytes)

        # `words.ready` is high only if the ring has room for the largest state after these words.
        # `bound`: the last beat in which a state may start.
        bound = Signal(ring.beat_bits, init=ring.depth - program.most_beats)
        newest = Signal(ring.beat_bits)
        room = Signal(ring.beat_bits)
        ready = Signal(init=1)
        m.d.comb += [
            newest.eq(ring.beat(at) + Mux(takes, words.max_beats, 0)),
            room.eq(bound - newest),
            self.words.ready.eq(ready),
        ]
        m.d.sync += ready.eq(~room[-1])
        with m.If(reads):
            m.d.sync += bound.eq(bound + 1)

        # Second cycle: write the words. Beats before `complete` can be sent; beats of constants
        # only are held until the first leaf is taken.
        complete = Signal(ring.beat_bits)
        first = Signal(ring.beat_bits)
        slot = (complete_next - 1)[: ring.beat_bits - 1]
        layout = data.StructLayout({"count": range(bus + 1), "error": 1})
        ends = LutMemory(m, "ends", layout, ring.depth)
        write, read = ends.write, ends.reader()
        # By slot: whether the beat is the last one of its packet.
        last = Signal(ring.depth)
        is_last = Signal()
        m.d.comb += [
            write.addr.eq(slot),
            write.data.count.eq(last_bytes),
            write.data.error.eq(failed),
            write.en.eq(writes & ends_packet),
        ]
        with m.If(named(m, "commits", writes & ~waits)):
            m.d.sync += complete.eq(complete_next)
            with m.If(ends_packet):
                m.d.sync += last.bit_select(slot, 1).eq(1)

        # Third cycle: read the next beat, and send it.
        beat = self._beat(m, placed, writes, reads, first)
        payload = Signal(packets.payload.shape(), name="payload", reset_less=True)
        error = Signal(reset_less=True)
        m.d.comb += [
            read.addr.eq(first),
            reads.eq((complete != first) & (~packets.valid | packets.ready)),
            is_last.eq((last >> first[:-1])[0]),
            Value.cast(packets.payload).eq(Value.cast(payload)),
            self.error.eq(error),
        ]
        with m.If(packets.ready):
            m.d.sync += packets.valid.eq(0)
        with m.If(reads):
            m.d.sync += [
                packets.valid.eq(1),
                first.eq(first + 1),
                Value.cast(payload.data).eq(beat),
                payload.last.eq(is_last),
                payload.count.eq(Mux(is_last, read.data.count, bus)),
                error.eq(is_last & read.data.error),
                last.bit_select(first[:-1], 1).eq(0),
            ]
        return m

    def _rounded(
        self,
        m: Module,
        value: Value,
        distance: Value,
        mask: Value,
        phase: Value | int,
        last: Value,
    ) -> Value:
        """Return a position after a distance, with low bits cleared by a mask.

        Alignment counts from `phase`. The end of a packet (`last`) is rounded up to a whole beat.
        """
        size = len(value)
        total = Signal(size)
        m.d.comb += total.eq(value + distance)
        if isinstance(phase, int):
            return ((total & ~Cat(mask, Const(0, size))) | (mask & Mux(last, 0, phase)))[:size]
        pad = Signal(3)
        m.d.comb += pad.eq((phase - total) & mask)
        return Mux(last, total & ~Cat(mask, Const(0, size - len(mask))), total + pad)[:size]

    def _rotated(
        self, m: Module, name: str, takes: Value, start: Value, size: Value, where: WordLanes
    ) -> _Placed:
        """Rotate a word so that its first byte is in the lane of its position."""
        ring, bus, word = self.ring, self.plan.bus_bytes, getattr(self.words.payload, name)
        rotated = rotate(m, word, ring.lane(start), where.lanes, f"{name}_rotated", back=True)
        register = ring.position(f"{name}_start")
        first, constant = constant_low_lane_bits(where.lanes, bus)
        placed = _Placed(
            Signal(8 * bus, name=f"{name}_placed", reset_less=True),
            Cat(Const(first, constant), register[constant:]),
            Signal(range(bus + 1), name=f"{name}_size"),
        )
        with m.If(takes):
            m.d.sync += [placed.data.eq(rotated), register.eq(start), placed.size.eq(size)]
        return placed

    def _beat(
        self, m: Module, placed: dict[str, _Placed], writes: Value, reads: Value, first: Value
    ) -> Value:
        """Write words to the ring, and return the bytes of the beat `first`.

        The ring has separate memories for the two words. Bytes that neither word wrote are padding.
        """
        program, bus = self.program, self.plan.bus_bytes
        units = {"items": program.items.unit, "map": program.map.unit}
        frees = [
            named(m, f"frees_slot_{slot}", reads & (first[:-1] == slot))
            for slot in range(self.ring.depth)
        ]
        # Without padding, a byte that is not of items is of a map, or after the packet's end.
        padded = bool(self.plan.header_bytes) or program.aligns
        # By word and lane: the bytes of the beat, and whether the word wrote them.
        lanes: dict[str, list[tuple[Value, Value]]] = {"items": [], "map": []}
        for name, unit in units.items():
            for k in range(0, bus, unit):
                where = (name, k, unit, placed[name], writes)
                used, slot, bytes_ = self._write_lanes(m, *where, first)
                written: Value = Const(1, 1)
                if padded or name == "items":
                    written = self._written(m, f"{name}_{k}", used, slot, frees, first)
                lanes[name].append((bytes_, written))
        # Groups of lanes, as many as the smaller unit, with the memories of both words.
        size = min(units.values())
        found = []
        for k in range(0, bus, size):
            (a, a_has), (b, b_has) = (
                (lanes[name][k // unit][0][8 * (k % unit) :][: 8 * size], lanes[name][k // unit][1])
                for name, unit in units.items()
            )
            found.append(Mux(a_has, a, 0) | Mux(b_has, b, 0) if padded else Mux(a_has, a, b))
        return Cat(found)

    def _write_lanes(
        self,
        m: Module,
        name: str,
        k: int,
        unit: int,
        placed: _Placed,
        writes: Value,
        first: Value,
    ) -> tuple[Value, Value, Value]:
        """Write lanes of a word, from lane k on.

        Returns
        -------
        Whether the word has these lanes, the slot of the beat to which they are written, and the
        same lanes of the beat `first`.
        """
        ring, bus = self.ring, self.plan.bus_bytes
        memory = LutMemory(m, f"{name}_{k}", 8 * unit, ring.depth)
        write, read = memory.write, memory.reader()
        index = Signal(max(1, ring.lane_bits), name=f"{name}_index_{k}")
        used = Signal(name=f"{name}_used_{k}")
        slot = Signal(ring.beat_bits - 1, name=f"{name}_slot_{k}")
        lane = ring.lane(placed.start)
        m.d.comb += [
            index.eq(k - lane if ring.lane_bits else 0),
            used.eq(writes & (index < placed.size)),
            # Lanes before the first byte are of the next beat.
            slot.eq(ring.slot(placed.start) + (lane > k if k < bus - unit else 0)),
            write.addr.eq(slot),
            write.data.eq(placed.data[8 * k : 8 * (k + unit)]),
            write.en.eq(used),
            read.addr.eq(first),
        ]
        return used, slot, read.data

    def _written(
        self, m: Module, name: str, used: Value, slot: Value, frees: list[Signal], first: Value
    ) -> Value:
        """Return whether lanes of the beat `first` were written."""
        # By slot. A shift of `used` would simulate faster, but takes 2 % more cells.
        has = Signal(self.ring.depth, name=f"{name}_has")
        for beat, freed in enumerate(frees):
            with m.If(freed):
                m.d.sync += has[beat].eq(0)
            with m.Elif(used & (slot == beat)):
                m.d.sync += has[beat].eq(1)
        written = Signal(name=f"{name}_written")
        m.d.comb += written.eq((has >> first[:-1])[0])
        return written
