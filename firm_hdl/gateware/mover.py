"""The mover: bytes from the packet buffer to the leaves, by the orders of the sequencer."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.memories import LutMemory
from firm_hdl.gateware.parse import order_layout
from firm_hdl.gateware.positions import Ring, any_of, beat_layout, named, rotate
from firm_hdl.gateware.signatures import StatusSignature, leaf_shape
from firm_hdl.names.attributes import REMARK
from firm_hdl.program import (
    DeserializerProgram,
    DeserializerState,
    Part,
    Transfer,
    leaf_names,
    unique,
)

__all__ = ["Mover"]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Writer:
    """A transfer that a state may write."""

    state: DeserializerState
    transfer: Transfer
    chosen: Signal  # The next order has the transfer.
    active: Signal  # The order that is executed has the transfer, and it is not written yet.
    blocked: Signal  # The transfer is active, and its register is not free.
    go: Signal  # The transfer is written in this cycle.


class Mover(wiring.Component):
    """Read two words of the packet buffer per order, and write leaves from their lanes.

    One cycle reads the words and rotates their first bytes to lane 0; the next cycle writes the
    leaves. So a leaf is valid 2 cycles after its order. Leaves of a state become valid in wire
    order, each as soon as its register is free. A leaf whose register is full delays only later
    leaves::

        cycle           | 0        | 1             | 2
        orders          | a        | b             | c
        words           |          | of a          | of b
        leaves of a     |          | are written   | valid

    Parameters
    ----------
    program : DeserializerProgram
    leaves : mapping of int to stream.Interface
        By leaf: streams of `leaf_shape(leaf)`, which the mover drives. Members of its own would
        only copy those of the converter.

    Members
    -------
    beat : In(beat_layout(plan))
        The beat that is written to the packet buffer in this cycle.
    orders : In(stream.Signature(order_layout(plan)))
    status : Out(StatusSignature())
    """

    def __init__(self, program: DeserializerProgram, leaves: Mapping[int, stream.Interface]):
        self.program, self.plan, self.leaves = program, program.plan, leaves
        super().__init__(
            {
                "beat": In(beat_layout(program.plan)),
                "orders": In(stream.Signature(order_layout(program.plan))),
                "status": Out(StatusSignature()),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        order, status = self.orders.payload, self.status
        take = Signal()
        m.d.comb += self.orders.ready.eq(take)
        for port in (*self.leaves.values(), status):
            with m.If(port.ready):
                m.d.sync += port.valid.eq(0)
        words = self._read(m, take)
        # Whether the register of a stream has a transfer that is not taken in this cycle.
        names = leaf_names(self.plan)
        full = {leaf: Signal(name=f"full_{names[leaf]}") for leaf in self.leaves}
        status_full = Signal()
        m.d.comb += [full[k].eq(port.valid & ~port.ready) for k, port in self.leaves.items()]
        m.d.comb += status_full.eq(status.valid & ~status.ready)
        writers = self._writers(m, take, full)

        # The status of a packet is sent with its last order.
        ends = Signal()
        ends_now = Signal()
        status_now = Signal.like(order.status)
        m.d.comb += ends.eq(self.orders.valid & order.ends)
        with m.If(take):
            m.d.sync += [ends_now.eq(ends), status_now.eq(order.status)]
            with m.If(ends_now):
                m.d.sync += [status.valid.eq(1), status.payload.eq(status_now)]

        # Take the next order when all of this one is written. Most leaves cannot transfer in two
        # cycles in a row. If their consumers are always ready, their registers are free whenever a
        # state needs them. That one of them is not is registered (`slow`), and costs a cycle. Only
        # leaves that may transfer in every cycle look at `ready` combinationally.
        repeated = self.program.repeated_leaves
        waits = [
            self._wants(m, take, leaf, [each for each in writers if each.transfer.leaf == leaf])
            & full[leaf]
            for leaf in sorted(repeated)
        ]
        others = [each for each in writers if each.transfer.leaf not in repeated]
        # Reasons for `slow`, as an order is taken and later.
        first = [each.chosen & full[each.transfer.leaf] for each in others]
        later = [each.blocked & ~self.leaves[each.transfer.leaf].ready for each in others]
        if self.program.ends_at_once:
            # A packet may end in every cycle.
            waits.append(ends_now & status_full)
        else:
            first.append(ends & status_full)
            later.append(ends_now & status_full)
        slow = Signal(
            attrs={REMARK: "a leaf of the order that is executed, or the status, is full"}
        )
        if first:
            is_full = named(m, "next_order_is_slow", any_of(first))
            stays_full = named(m, "order_stays_slow", any_of(later))
            m.d.sync += slow.eq(Mux(take, is_full, stays_full))
        m.d.comb += take.eq(~slow & ~named(m, "waits", any_of(waits)))

        for writer in writers:
            with m.If(writer.go):
                m.d.sync += self.leaves[writer.transfer.leaf].valid.eq(1)
                words.write(m, writer)
        return m

    def _read(self, m: Module, take: Value) -> _Words:
        """Read the words of the order that is taken, and keep its other fields."""
        program, order = self.program, self.orders.payload
        bus, ring = self.plan.bus_bytes, Ring(self.plan)
        # First byte, slot of the next beat, possible lanes, and good bytes of each word.
        ports = {}
        if program.items.used:
            ports["items"] = order.items_at, order.items_next, program.items, order.items_bytes
        if program.map.used:
            ports["map"] = order.map_at, order.map_next, program.map, order.map_bytes
        lanes: dict[str, list[Value]] = {name: [] for name in ports}
        for k in range(bus):
            memory = LutMemory(m, f"lane_{k}", 8, ring.depth)
            write = memory.write
            m.d.comb += [
                write.addr.eq(self.beat.at),
                write.data.eq(self.beat.data[8 * k : 8 * k + 8]),
                write.en.eq(self.beat.valid),
            ]
            for name, (at, following, word, _) in ports.items():
                read = memory.reader(name)
                # Lanes before the first byte's are read from the next beat.
                address: Value = at[ring.lane_bits :]
                if any(start > k for start in word.lanes):
                    address = Mux(ring.lane(at) > k, following, address)
                m.d.comb += read.addr.eq(address)
                lanes[name].append(read.data)
        words = _Words(m, self, take)
        for name, (at, _, word, size) in ports.items():
            bits = rotate(m, Cat(lanes[name]), ring.lane(at), word.lanes, f"{name}_rotated")
            words.keep(m, take, name, bits, size)
        words.carry(m, take)
        return words

    def _writers(self, m: Module, take: Value, full: Mapping[int, Value]) -> list[_Writer]:
        """Serve the transfers of each state in wire order, each as soon as its register is free.

        A consumer may take a leaf only after an earlier leaf, or after a leaf of the next message.
        So a state must not wait until all its leaves are free; it remembers which are written.
        """
        order, found = self.orders.payload, list[_Writer]()
        names = self._transfer_names()
        has_step = Signal()
        m.d.comb += has_step.eq(self.orders.valid & ~order.blank)
        for state in self.program.states:
            if not state.transfers:
                continue
            earlier: list[Value] = []
            in_step = Signal(name=f"chosen_step_{state.name}")
            m.d.comb += in_step.eq(has_step & (order.step == state.number))
            for transfer in state.transfers:
                name = names[len(found)]
                active, blocked, go = (
                    Signal(name=f"{what}_{name}") for what in ("active", "blocked", "go")
                )
                chosen = in_step
                if transfer.run is not None and transfer.run.counted:
                    chosen = Signal(name=f"chosen_{name}")
                    m.d.comb += chosen.eq(in_step & order.items)
                port = self.leaves[transfer.leaf]
                is_repeated = transfer.leaf in self.program.repeated_leaves
                m.d.sync += active.eq(Mux(take, chosen, active & ~go))
                m.d.comb += [
                    blocked.eq(active & (full[transfer.leaf] if is_repeated else port.valid)),
                    go.eq(active & ~blocked & ~any_of(earlier)),
                ]
                earlier.append(blocked)
                found.append(
                    _Writer(
                        state=state,
                        transfer=transfer,
                        chosen=chosen,
                        active=active,
                        blocked=blocked,
                        go=go,
                    )
                )
        return found

    def _transfer_names(self) -> tuple[str, ...]:
        """Return a name for each transfer: its leaf, and the state if several have it."""
        leaves = leaf_names(self.plan)
        named = [
            (leaves[each.leaf] + "_rest" * each.is_rest, state.name)
            for state in self.program.states
            for each in state.transfers
        ]
        count = Counter(name for name, _ in named)
        return unique(
            name if count[name] == 1 or name == state else f"{name}_in_{state}"
            for name, state in named
        )

    def _wants(self, m: Module, take: Value, leaf: int, writers: list[_Writer]) -> Signal:
        """Return a register: the order that is executed still has to write the leaf."""
        wants = Signal(name=f"wants_{leaf_names(self.plan)[leaf]}")
        chosen = any_of([each.chosen for each in writers])
        go = any_of([each.go for each in writers])
        m.d.sync += wants.eq(Mux(take, chosen, wants & ~go))
        return wants


class _Words:
    """The order that is executed: its two words, and what leaves get of them.

    A word has one bit for each byte that is good. A value is 0 unless its last byte is good: then
    those before it are good, too.
    """

    def __init__(self, m: Module, mover: Mover, take: Value):
        self.plan, self.program, self.orders = mover.plan, mover.program, mover.orders
        self.word: dict[str, Signal] = {}
        self.good: dict[str, Signal] = {}
        # The same, for the bytes of a length that counts.
        self.good_of_length: dict[str, Signal] = {}
        order = mover.orders.payload
        self.length_good = Signal()
        self.last = Signal()
        has_final = any(
            each.part is not None and each.part.level is not None
            for state in self.program.states
            for each in state.transfers
        )
        self.final: Value = Signal.like(order.final) if has_final else Const(0, len(order.final))
        with m.If(take):
            m.d.sync += [self.length_good.eq(order.length_good), self.last.eq(order.last)]
            if has_final:
                m.d.sync += self.final.eq(order.final)
        self.carried = Signal(8 * self.program.carried_bytes, reset_less=True)
        # No reset value: so the flip-flops' synchronous reset is free to write the 0 of an error.
        names = leaf_names(self.plan)
        self.payloads = {
            leaf: Signal(
                leaf_shape(self.plan.leaves[leaf]), name=f"payload_{names[leaf]}", reset_less=True
            )
            for leaf in mover.leaves
        }
        for leaf, port in mover.leaves.items():
            m.d.comb += Value.cast(port.payload).eq(Value.cast(self.payloads[leaf]))

    def keep(self, m: Module, take: Value, name: str, bits: Value, size: Value) -> None:
        """Store a word, of which so many bytes are good."""
        bus = self.plan.bus_bytes
        self.word[name] = Signal(8 * bus, name=f"{name}_word", reset_less=True)
        self.good[name] = Signal(
            bus,
            name=f"{name}_good",
            reset_less=True,
            attrs={REMARK: "bit k: byte k of the word is good; else its value is written as 0"},
        )
        if any(leaf.kind == "length" for leaf in self.plan.leaves):
            self.good_of_length[name] = named(
                m,
                f"{name}_good_of_length",
                self.good[name] & self.length_good.replicate(bus),
                "length_good is 0 for a length over its limit",
            )
        with m.If(take):
            m.d.sync += [
                self.word[name].eq(bits),
                self.good[name].eq(Cat(size > k for k in range(bus))),
            ]

    def _byte(
        self, state: DeserializerState, at: int, *, of_length: bool = False
    ) -> tuple[Value, Value]:
        """Return a byte of a state's map, and whether the byte is good."""
        bus = self.plan.bus_bytes
        name = "items" if state.two_word_map and bus > at else "map"
        at %= bus
        good = (self.good_of_length if of_length else self.good)[name]
        return self.word[name][8 * at : 8 * at + 8], good[at]

    def carry(self, m: Module, take: Value) -> None:
        """Store the bytes of a transfer that continues in a later state."""
        order = self.orders.payload
        for state in self.program.states:
            part = state.cut
            if part is None:
                continue
            here = Signal(name=f"begins_{state.name}")
            with m.If(take):
                chosen = ~order.blank & (order.step == state.number)
                m.d.sync += here.eq(self.orders.valid & chosen)
            size = self.plan.leaves[part.leaf].item_bytes
            for k in range(part.bytes):
                value, _ = self._byte(state, part.at + k)
                # An item that ends in this state is zeroed here: items before an error keep theirs.
                end = (part.first + k) // size * size + size
                if end <= part.first + part.bytes:
                    _, good = self._byte(state, part.at + end - part.first - 1)
                    value = Mux(good, value, 0)
                at = 8 * (part.first + k)
                with m.If(take & here):
                    m.d.sync += self.carried[at : at + 8].eq(value)

    def _whole(
        self,
        state: DeserializerState,
        part: Part,
        begin: int,
        end: int,
        *,
        of_length: bool = False,
    ) -> tuple[Value, Value]:
        """Return bytes of a transfer that is complete with a state, and whether they are good."""
        carried = max(begin, min(end, part.first))
        here = [
            self._byte(state, part.at + k - part.first, of_length=of_length)
            for k in range(carried, end)
        ]
        value = Cat(self.carried[8 * begin : 8 * carried], *(byte for byte, _ in here))
        return value, here[-1][1] if here else Const(1)

    def write(self, m: Module, writer: _Writer) -> None:
        """Write a transfer to the register of its leaf; the caller's `m.If` says when."""
        transfer, part, run = writer.transfer, writer.transfer.part, writer.transfer.run
        leaf, payload = self.plan.leaves[transfer.leaf], self.payloads[transfer.leaf]
        size = leaf.item_bytes
        if run is not None:
            # A word or the rest of a run.
            name = "items" if run.counted else "map"
            m.d.sync += payload.last.eq(self.last & (not run.has_tail))
            for lane in range(leaf.lanes):
                value = self.word[name][8 * lane * size : 8 * (lane + 1) * size]
                good = self.good[name][(lane + 1) * size - 1]
                _put(m, payload.data[lane], value, good, leaf.type)
            return
        assert part is not None
        if leaf.kind == "items":
            # A transfer of static size.
            last: Value = Const(part.last)
            if part.level is not None:
                last = self.final[part.level]
            m.d.sync += payload.last.eq(last)
            for lane in range(leaf.lanes):
                value, good = Const(0), Const(1)
                if (lane + 1) * size <= part.size:
                    value, good = self._whole(writer.state, part, lane * size, (lane + 1) * size)
                _put(m, payload.data[lane], value, good, leaf.type)
        elif leaf.kind == "trigger":
            m.d.sync += payload.eq(1)
        else:
            of_length = leaf.kind == "length"
            value, good = self._whole(writer.state, part, 0, part.size, of_length=of_length)
            if of_length:
                value = value - transfer.counts_nul
            _put(m, payload, value, good, leaf.type)


def _put(m: Module, target: Value, value: Value, good: Value, type_: str) -> None:
    """Write a value, or 0 if it is not good."""
    if type_ == "bool":
        value = value.any()
    with m.If(good):
        m.d.sync += Value.cast(target).eq(value)
    with m.Else():
        m.d.sync += Value.cast(target).eq(0)
