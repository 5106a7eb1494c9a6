"""The mover: bytes from the packet buffer to the leaves, by the orders of the sequencer."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, count

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.memories import LutMemory
from firm_hdl.gateware.parse import order_layout
from firm_hdl.gateware.positions import Ring, any_of, beat_layout, rotate
from firm_hdl.gateware.signatures import StatusSignature, leaf_shape
from firm_hdl.plan import LoopEnd, Part, Run
from firm_hdl.program import DeserializerProgram, DeserializerState, Transfer

__all__ = ["Mover"]


class Mover(wiring.Component):
    """Read two words of the packet buffer per order, and write leaves from their lanes.

    One cycle reads the words and rotates their first bytes to lane 0; the next cycle writes the
    leaves. So a leaf is valid 2 cycles after its order. Leaves of a step become valid in wire
    order, each as soon as its register is free. A leaf whose register is full delays only later
    leaves.

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
    status : Out(StatusSignature)
    """

    def __init__(self, program: DeserializerProgram, leaves: Mapping[int, stream.Interface]):
        self.program, self.plan, self.leaves = program, program.plan, leaves
        plan = self.plan
        super().__init__(
            {
                "beat": In(beat_layout(plan)),
                "orders": In(stream.Signature(order_layout(plan))),
                "status": Out(StatusSignature),
            }
        )

    def elaborate(self, platform: object) -> Module:
        return _MoverLogic(self).m


@dataclass(frozen=True, slots=True, kw_only=True)
class _Writer:
    """A transfer that a step may write.

    Attributes
    ----------
    state : DeserializerState
    slot : int
        Number of the transfer in its state, in wire order.
    transfer : Transfer
    active : Signal
        The current order is of this step, and the transfer is not written yet.
    blocked : Signal
        The transfer is active, and its register is not free.
    go : Signal
        The transfer is written in this cycle.
    """

    state: DeserializerState
    slot: int
    transfer: Transfer
    active: Signal
    blocked: Signal
    go: Signal


class _MoverLogic:
    """The mover's logic, built by one method for each part of it."""

    def __init__(self, mover: Mover):
        self.c, self.plan, self.ring = mover, mover.plan, Ring(mover.plan)
        self.program = mover.program
        self.m = m = Module()
        plan = self.plan
        self.order = mover.orders.payload
        self.take = Signal(name="take")
        m.d.comb += mover.orders.ready.eq(self.take)
        self.streams = [mover.leaves[k] for k in range(len(plan.leaves))]
        # No reset value: so the flip-flops' synchronous reset is free to write the 0 of an error.
        self.payloads = [
            Signal(leaf_shape(leaf), name=f"payload_{k}", reset_less=True)
            for k, leaf in enumerate(plan.leaves)
        ]
        for port, payload in zip(self.streams, self.payloads, strict=True):
            m.d.comb += Value.cast(port.payload).eq(Value.cast(payload))
        for port in (*self.streams, mover.status):
            with m.If(port.ready):
                m.d.sync += port.valid.eq(0)
        # The words "items" and "map", and one bit for each good byte of them.
        self.word: dict[str, Signal] = {}
        self.good: dict[str, Signal] = {}
        self._read()
        self.length_good, self.last = self._kept("length_good"), self._kept("last")
        self.final, self.ends = self._kept("final"), Signal(name="ends_now")
        self.writers = list(self._writers())
        self._serve()
        self._carry()
        for writer in chain.from_iterable(self.writers):
            with m.If(writer.go):
                m.d.sync += self.streams[writer.transfer.leaf].valid.eq(1)
                self._write(writer)

    def _kept(self, name: str) -> Signal:
        """Return a register with a field of the order that is executed."""
        kept = Signal.like(getattr(self.order, name), name=f"{name}_now")
        with self.m.If(self.take):
            self.m.d.sync += kept.eq(getattr(self.order, name))
        return kept

    # Words.

    def _read(self) -> None:
        """Read the words of the order."""
        m, program, order, bus = self.m, self.program, self.order, self.plan.bus_bytes
        ports = {}
        if program.items.used:
            ports["items"] = (order.items_at, program.items.lanes, order.items_bytes)
        if program.map.used:
            ports["map"] = (order.map_at, program.map.lanes, order.map_bytes)
        lanes = self._memories({name: (at, starts) for name, (at, starts, _) in ports.items()})
        for name, (at, starts, size) in ports.items():
            lane = self.ring.lane(at)
            word = rotate(m, Cat(lanes[name]), lane, starts, f"{name}_rotated")
            self.word[name] = Signal(8 * bus, name=f"{name}_word", reset_less=True)
            self.good[name] = Signal(bus, name=f"{name}_good", reset_less=True)
            with m.If(self.take):
                m.d.sync += [
                    self.word[name].eq(word),
                    self.good[name].eq(Cat(size > k for k in range(bus))),
                ]

    def _memories(self, ports: dict[str, tuple[Value, tuple[int, ...]]]) -> dict[str, list[Value]]:
        """Make a memory for each lane, which each word reads at its own address."""
        m, ring, beat = self.m, self.ring, self.c.beat
        found: dict[str, list[Value]] = {name: [] for name in ports}
        order = self.order
        following = {"items": order.items_next, "map": order.map_next}
        for k in range(self.plan.bus_bytes):
            memory = LutMemory(m, f"lane_{k}", 8, ring.depth)
            write = memory.write
            m.d.comb += [
                write.addr.eq(beat.at),
                write.data.eq(beat.data[8 * k : 8 * k + 8]),
                write.en.eq(beat.valid),
            ]
            for name, (at, starts) in ports.items():
                read = memory.reader(name)
                # Lanes before the first byte's are read from the next beat.
                address: Value = at[ring.lane_bits :]
                if any(start > k for start in starts):
                    address = Mux(ring.lane(at) > k, following[name], address)
                m.d.comb += read.addr.eq(address)
                found[name].append(read.data)
        return found

    # Service.

    def _writers(self) -> Iterator[list[_Writer]]:
        """Yield the transfers of each step, in wire order."""
        number = count()
        for state in self.program.states:
            writers = []
            for slot, transfer in enumerate(state.transfers):
                k = next(number)
                active, blocked, go = (
                    Signal(name=f"{what}_{k}") for what in ("active", "blocked", "go")
                )
                writers.append(
                    _Writer(
                        state=state,
                        slot=slot,
                        transfer=transfer,
                        active=active,
                        blocked=blocked,
                        go=go,
                    )
                )
            yield writers

    def _serve(self) -> None:
        """Write the transfers of a step in wire order, each as soon as its register is free.

        A consumer may take a leaf only after an earlier leaf, or after a leaf of the next message.
        So a step must not wait until all its leaves are free; it remembers which are written.

        Most leaves cannot transfer in two cycles in a row. If their consumers are always ready,
        their registers are free whenever a step needs them. That one of them is not is registered
        (`slow`), and costs a cycle. Only leaves that may transfer in every cycle look at `ready`
        combinationally.
        """
        m, c = self.m, self.c
        repeated = self.program.repeated_leaves
        # Reasons to wait: combinational ones, and those of `slow` as an order is taken and later.
        now, first, later = list[Value](), list[Value](), list[Value]()
        wanted: dict[int, list[tuple[Value, Value]]] = {}
        for writers in self.writers:
            for writer in writers:
                leaf = writer.transfer.leaf
                port = self.streams[leaf]
                chosen = self._schedule(writer, writers)
                if leaf in repeated:
                    m.d.comb += writer.blocked.eq(writer.active & _is_full(port))
                    wanted.setdefault(leaf, []).append((chosen, writer.go))
                else:
                    m.d.comb += writer.blocked.eq(writer.active & port.valid)
                    first.append(chosen & _is_full(port))
                    later.append(writer.blocked & ~port.ready)
        now += [
            self._wants(leaf, cases) & _is_full(self.streams[leaf])
            for leaf, cases in wanted.items()
        ]
        ends = c.orders.valid & self.order.ends
        if self.program.ends_at_once:
            # A packet may end in every cycle.
            now.append(self.ends & _is_full(c.status))
        else:
            first.append(ends & _is_full(c.status))
            later.append(self.ends & _is_full(c.status))
        slow = Signal(name="slow")
        if first:
            m.d.sync += slow.eq(Mux(self.take, any_of(first), any_of(later)))
        m.d.comb += self.take.eq(~slow & ~any_of(now))
        self._report(ends)

    def _schedule(self, writer: _Writer, writers: Sequence[_Writer]) -> Value:
        """Write a transfer after the earlier ones of its step; return if the next order has it.

        Parameters
        ----------
        writers : sequence of _Writer
            All of the step, in wire order.
        """
        m, order = self.m, self.order
        chosen = self.c.orders.valid & ~order.blank & (order.step == writer.state.number)
        if writer.transfer.run is not None and writer.transfer.run.counted:
            chosen = chosen & order.items
        earlier = [each.blocked for each in writers[: writer.slot]]
        m.d.sync += writer.active.eq(Mux(self.take, chosen, writer.active & ~writer.go))
        m.d.comb += writer.go.eq(writer.active & ~writer.blocked & ~any_of(earlier))
        return chosen

    def _wants(self, leaf: int, cases: Sequence[tuple[Value, Value]]) -> Signal:
        """Return a register: the order still has to write the leaf.

        Parameters
        ----------
        cases : sequence of (Value, Value)
            Of each writer of the leaf: the next order has the transfer; the transfer is written.
        """
        wants = Signal(name=f"want_{leaf}")
        chosen, go = (any_of([case[k] for case in cases]) for k in range(2))
        self.m.d.sync += wants.eq(Mux(self.take, chosen, wants & ~go))
        return wants

    def _report(self, ends: Value) -> None:
        """Send the status of a packet with the last order of the packet."""
        m, port = self.m, self.c.status
        status = self._kept("status")
        with m.If(self.take):
            m.d.sync += self.ends.eq(ends)
            with m.If(self.ends):
                m.d.sync += [port.valid.eq(1), port.payload.eq(status)]

    # Values.

    def _byte(self, state: DeserializerState, at: int) -> tuple[Value, Value]:
        """Return a byte of a state's map, and whether the byte is good."""
        bus = self.plan.bus_bytes
        name = "items" if state.two_word_map and bus > at else "map"
        at %= bus
        return self.word[name][8 * at : 8 * at + 8], self.good[name][at]

    def _carry(self) -> None:
        """Store the bytes of a transfer that continues in the next step."""
        m, plan = self.m, self.plan
        size = 8 * self.program.carried_bytes
        self.carried = Signal(size, name="carried", reset_less=True)
        for state in self.program.states:
            part = state.cut
            if part is None:
                continue
            here = Signal(name=f"cut_{state.number}")
            with m.If(self.take):
                chosen = ~self.order.blank & (self.order.step == state.number)
                m.d.sync += here.eq(self.c.orders.valid & chosen)
            size = plan.leaves[part.leaf].item_bytes
            for k in range(part.bytes):
                value, _ = self._byte(state, part.at + k)
                # An item that ends in this step is zeroed here: items before an error keep theirs.
                end = (part.first + k) // size * size + size
                if end <= part.first + part.bytes:
                    _, good = self._byte(state, part.at + end - part.first - 1)
                    value = Mux(good, value, 0)
                at = 8 * (part.first + k)
                with m.If(self.take & here):
                    m.d.sync += self.carried[at : at + 8].eq(value)

    def _whole(self, writer: _Writer, part: Part, begin: int, end: int) -> tuple[Value, Value]:
        """Return bytes of a transfer of the map, and whether they are good."""
        carried = max(begin, min(end, part.first))
        here = [self._byte(writer.state, part.at + k - part.first) for k in range(carried, end)]
        value = Cat(self.carried[8 * begin : 8 * carried], *(byte for byte, _ in here))
        # The last byte is good only if those before it are.
        return value, here[-1][1] if here else Const(1)

    def _write(self, writer: _Writer) -> None:
        m, plan = self.m, self.plan
        transfer = writer.transfer
        leaf, payload = plan.leaves[transfer.leaf], self.payloads[transfer.leaf]
        if transfer.run is not None:
            self._write_word(transfer, transfer.run)
            return
        part = transfer.part
        assert part is not None
        if leaf.kind == "items":
            self._write_items(writer, part)
        elif leaf.kind == "trigger":
            m.d.sync += payload.eq(1)
        else:
            value, good = self._whole(writer, part, 0, part.size)
            if leaf.kind == "length":
                value = value - transfer.counts_nul
                good = good & self.length_good
            self._put(payload, value, good, leaf.type)

    def _write_word(self, transfer: Transfer, run: Run) -> None:
        """Write a word or the rest of a run."""
        leaf, payload = self.plan.leaves[transfer.leaf], self.payloads[transfer.leaf]
        name, size = "items" if run.counted else "map", leaf.item_bytes
        self.m.d.sync += payload.last.eq(self.last & run.last)
        for lane in range(leaf.lanes):
            value = self.word[name][8 * lane * size : 8 * (lane + 1) * size]
            self._put(payload.data[lane], value, self.good[name][(lane + 1) * size - 1], leaf.type)

    def _write_items(self, writer: _Writer, part: Part) -> None:
        """Write a transfer of static size."""
        index = writer.transfer.leaf
        leaf, payload = self.plan.leaves[index], self.payloads[index]
        size = leaf.item_bytes
        last: Value = Const(part.end is not None)
        if isinstance(part.end, LoopEnd):
            last = self.final[part.end.level]
        self.m.d.sync += payload.last.eq(last)
        for lane in range(leaf.lanes):
            value, good = Const(0), Const(1)
            if (lane + 1) * size <= part.size:
                value, good = self._whole(writer, part, lane * size, (lane + 1) * size)
            self._put(payload.data[lane], value, good, leaf.type)

    def _put(self, target: Value, value: Value, good: Value, type_: str) -> None:
        """Write a value, or 0 if it is not good."""
        if type_ == "bool":
            value = value.any()
        with self.m.If(good):
            self.m.d.sync += Value.cast(target).eq(value)
        with self.m.Else():
            self.m.d.sync += Value.cast(target).eq(0)


def _is_full(port: stream.Interface) -> Value:
    """Return whether the register of a stream has a transfer that is not taken in this cycle."""
    full: Value = port.valid & ~port.ready
    return full
