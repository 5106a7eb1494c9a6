"""The logic of a deserializer: what each step of its plan does."""

from __future__ import annotations

from typing import TYPE_CHECKING

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import stream

from firm_hdl.gateware.control import Control
from firm_hdl.gateware.signatures import (
    Status,
    leaf_streams,
)
from firm_hdl.gateware.slots import Slots
from firm_hdl.gateware.window import Window
from firm_hdl.plan import (
    BeginArray,
    CountedBegin,
    Fixed,
    Pad,
    Part,
    Plan,
    Step,
    Take,
)

if TYPE_CHECKING:
    from firm_hdl.gateware.deserializer import Deserializer

__all__ = ["DeserializerCircuit"]


class DeserializerCircuit:
    """The deserializer's logic, built by one method for each part of it.

    Parameters
    ----------
    component : Deserializer

    Attributes
    ----------
    module : Module
        The finished logic.
    """

    def __init__(self, component: Deserializer):
        self.plan: Plan = component.plan
        self.status = component.status
        self.streams = leaf_streams(component.message, component.tree)

        self.module = m = Module()
        m.submodules.window = self.window = Window(self.plan)
        self.control = Control(self.plan)
        self.slots = Slots(max(_slots(step) for step in self.plan.steps))
        # First bytes of a transfer that crosses steps, until its last bytes are present.
        carried = max((part.first for step in self.plan.steps for part in step.parts), default=0)
        self.carry = Signal(8 * carried)
        self.error = Signal(Status)
        self.draining = Signal()
        self.enable = Signal()
        self.promised = Signal()
        self.complete = Signal()
        # Set by each step: whether the bytes of its map are present, which of the bytes behind the
        # map are (as far as they matter), and its errors.
        self.map_there = Signal()
        self.behind = Signal(self.plan.slack_bytes + 1)
        self.extra = Signal(range(self.plan.slack_bytes + 2))
        self.mismatch = Signal()
        self.over = Signal()
        # The bytes of the window from the start of the run in this step.
        most = self.plan.bus_bytes + 1
        self.run_bytes = Signal(8 * most)
        self.run_have = Signal(most + self.plan.slack_bytes + 1)

        m.d.comb += self.window.packets.payload.eq(component.packets.payload)
        m.d.comb += self.window.packets.valid.eq(component.packets.valid)
        m.d.comb += component.packets.ready.eq(self.window.packets.ready)
        for interface in (*self.streams.values(), self.status):
            with m.If(interface.ready):
                m.d.sync += interface.valid.eq(0)
        self.bad = self.error != Status.OK
        self._steps()
        self.control.add_run_logic(m)
        self.slots.add_logic(m, self.enable, self.complete)
        self._progress()
        self._drain()

    def free(self, interface: stream.Interface) -> Value:
        return ~interface.valid | interface.ready

    # Steps.

    def _steps(self) -> None:
        m = self.module
        with m.Switch(self.control.step):
            for index, step in enumerate(self.plan.steps):
                with m.Case(index):
                    self._step(step)
                    with m.If(self.complete):
                        self.control.add_counters(m, step)

    def _step(self, step: Step) -> None:
        m = self.module
        needed = max((s.at + s.bytes for s in step.slices if not isinstance(s, Pad)), default=0)
        m.d.comb += [
            self.map_there.eq(self.have(needed)),
            self.behind.eq(self.window.have[step.bytes :]),
        ]
        for item in step.slices:
            if isinstance(item, Fixed) and item.check:
                self._check(item)
        slot = 0
        for part in step.parts:
            if part.completes:
                self._part(part, slot, step)
                slot += 1
            else:
                self._carry(part)
        if isinstance(step.begin, BeginArray):
            m.d.comb += [self.control.count.eq(step.begin.count), self.control.some.eq(1)]
        if step.take is not None:
            self._run(step.take, slot)
        self.control.add_step(m, step)

    def _check(self, item: Fixed) -> None:
        """Compare constant bytes; bytes that are not present are not compared."""
        wrong = [
            self.have(item.at + k + 1) & (self.bytes(item.at + k, 1) != value)
            for k, value in enumerate(item.data)
        ]
        self.module.d.comb += self.mismatch.eq(Cat(wrong).any())

    def bytes(self, at: int, count: int) -> Value:
        """Return bytes of the window as one value, little-endian."""
        return Value.cast(self.window.data)[8 * at : 8 * (at + count)]

    def have(self, count: int) -> Value:
        """Return whether the first `count` bytes of the window are present."""
        return self.window.have[count - 1] if count else Const(1)

    def good(self, count: int) -> Value:
        """Return whether `count` bytes are present and the packet has no error so far."""
        return self.have(count) & ~self.bad & ~self.mismatch

    def whole(self, part: Part, begin: int, end: int) -> Value:
        """Return bytes of a transfer that ends in this step; earlier bytes are in the carry."""
        carried = (
            self.carry[8 * begin : 8 * min(end, part.first)] if begin < part.first else Const(0, 0)
        )
        start = max(begin, part.first)
        return Cat(carried, self.bytes(part.at + start - part.first, max(0, end - start)))

    def _carry(self, part: Part) -> None:
        """Keep bytes of a transfer that continues in the next step."""
        m = self.module
        size = self.plan.leaves[part.leaf].item_bytes
        for k in range(part.bytes):
            value: Value = self.bytes(part.at + k, 1)
            # An item that ends here is judged here: items in front of an error keep their values.
            item_end = (part.first + k) // size * size + size
            if item_end <= part.first + part.bytes:
                value = Mux(self.good(part.at + item_end - part.first), value, 0)
            with m.If(self.complete):
                m.d.sync += self.carry[8 * (part.first + k) : 8 * (part.first + k + 1)].eq(value)

    def _part(self, part: Part, slot: int, step: Step) -> None:
        m = self.module
        leaf = self.plan.leaves[part.leaf]
        interface = self.streams[part.leaf]
        m.d.comb += self.slots.able[slot].eq(self.free(interface))
        good = self.good(part.at + part.bytes)
        value = self.whole(part, 0, part.size)
        if leaf.kind == "length":
            value = self._length(value, good, step)
        go = self.slots.go[slot]
        with m.If(go):
            m.d.sync += interface.valid.eq(1)
            if leaf.kind == "items":
                self._items(part)
            elif leaf.kind == "trigger":
                m.d.sync += interface.payload.eq(1)
            elif leaf.kind == "length":
                m.d.sync += interface.payload.eq(value)
            else:
                result = value.any() if leaf.type == "bool" else value
                m.d.sync += interface.payload.eq(Mux(good, result, 0))

    def _items(self, part: Part) -> None:
        """Write a transfer of static size; a lane is good if all of its bytes are present."""
        m = self.module
        leaf = self.plan.leaves[part.leaf]
        payload = self.streams[part.leaf].payload
        size = leaf.item_bytes
        for lane in range(leaf.lanes):
            end = (lane + 1) * size
            value: Value = Const(0)
            if end <= part.size:
                value = self.whole(part, lane * size, end)
                if leaf.type == "bool":
                    value = value.any()
                if end > part.first:
                    value = Mux(self.good(part.at + end - part.first), value, 0)
            m.d.sync += Value.cast(payload.data[lane]).eq(value)
        last: Value = Const(part.last)
        if part.last_level is not None:
            last = self.control.levels[part.last_level] <= 1
        m.d.sync += payload.last.eq(last)

    def _length(self, wire_length: Value, good: Value, step: Step) -> Value:
        """Judge a length; set the count of the step, and return the payload of the leaf."""
        m = self.module
        begin = step.begin
        assert isinstance(begin, CountedBegin)
        has_nul = self.plan.has_nul(begin)
        over = wire_length > self.plan.most(begin)
        some = Signal()
        m.d.comb += [
            some.eq(good & ~over & wire_length.any()),
            self.over.eq(good & over),
            self.control.count.eq(wire_length),
            self.control.some.eq(some),
        ]
        return Mux(some, wire_length - 1 if has_nul else wire_length, 0)

    def _run(self, take: Take, slot: int) -> None:
        m = self.module
        control = self.control
        info, at = self.plan.runs[take.run], take.at
        leaf, interface = self.plan.leaves[info.items], self.streams[info.items]
        m.d.comb += self.slots.able[slot].eq(
            self.promised & (~control.has_items | self.free(interface))
        )
        size = leaf.item_bytes
        with m.If(self.slots.go[slot] & control.has_items):
            m.d.sync += [
                interface.valid.eq(1),
                interface.payload.last.eq(control.last_items & info.last),
            ]
            for lane in range(leaf.lanes):
                value: Value = self.bytes(at + lane * size, size)
                if leaf.type == "bool":
                    value = value.any()
                used = control.lane_used[lane] & self.good(at + (lane + 1) * size)
                m.d.sync += Value.cast(interface.payload.data[lane]).eq(Mux(used, value, 0))
        have = self.window.have[at : at + len(self.run_have)]
        m.d.comb += self.run_have[: len(have)].eq(have)
        if info.terminated:
            data = Value.cast(self.window.data)[8 * at : 8 * (at + self.plan.bus_bytes + 1)]
            m.d.comb += self.run_bytes[: len(data)].eq(data)

    # Between steps.

    def _progress(self) -> None:
        m, control, window = self.module, self.control, self.window
        failure, enough, behind = self._failure()
        ends = control.ends
        status_able = ~ends | self.free(self.status)
        m.d.comb += [
            # The map does not wait for the items behind it: their number is known later in a cycle.
            self.enable.eq(
                ~self.draining & (self.bad | (window.held & (self.map_there | window.ended)))
            ),
            self.promised.eq(self.bad | enough | window.ended),
            self.complete.eq(self.enable & self.slots.all_served & status_able),
            window.count.eq(control.base + control.run_bytes),
            window.align.eq(control.align),
            window.take.eq(self.complete & ~self.bad & ~ends),
            window.finish.eq(self.complete & ends),
        ]
        finished = Signal(Status)
        m.d.comb += finished.eq(failure)
        with m.If((failure == Status.OK) & behind[-1]):
            m.d.comb += finished.eq(Status.TRAILING)
        with m.If(self.complete):
            m.d.sync += [control.step.eq(control.next_step), self.error.eq(failure)]
            with m.If(ends):
                with m.If(window.ended):
                    self._report(finished)
                with m.Else():
                    m.d.sync += [self.draining.eq(1), self.extra.eq(sum(behind[1:], behind[0]))]

    def _failure(self) -> tuple[Signal, Signal, Signal]:
        """Judge the step.

        Returns
        -------
        failure : Signal(Status)
            The status after this step: the first error of the packet, in wire order.
        enough : Signal
            All bytes that the step takes are present.
        behind : Signal
            Bit k: byte k behind them is present. The last bit is for the first byte that may not
            follow a message.
        """
        m, control = self.module, self.control
        failure, enough, behind = Signal(Status), Signal(), Signal.like(self.behind)
        nul_missing = Signal()
        m.d.comb += [
            failure.eq(self.error),
            enough.eq(self.map_there),
            behind.eq(self.behind),
        ]
        with m.If(control.running):
            there = self.run_have
            m.d.comb += [
                enough.eq(self.map_there & there[self.plan.bus_bytes - 1]),
                behind.eq(there[self.plan.bus_bytes :]),
            ]
            with m.If(control.final), m.Switch(control.run_bytes):
                for k in range(self.plan.bus_bytes + 2):
                    with m.Case(k):
                        run_there = there[k - 1] if k else Const(1)
                        m.d.comb += [
                            enough.eq(self.map_there & run_there),
                            behind.eq(there[k:]),
                        ]
                        if k:
                            wrong = self.run_bytes[8 * (k - 1) : 8 * k].any() & run_there
                            m.d.comb += nul_missing.eq(control.terminated & wrong)
        with m.If(~self.bad):
            with m.If(self.mismatch):
                m.d.comb += failure.eq(Status.ENCAPSULATION)
            with m.Elif(~self.map_there):
                m.d.comb += failure.eq(Status.TRUNCATED)
            with m.Elif(self.over):
                m.d.comb += failure.eq(Status.LENGTH)
            with m.Elif(~enough):
                m.d.comb += failure.eq(Status.TRUNCATED)
            with m.Elif(nul_missing):
                m.d.comb += failure.eq(Status.STRING)
        return failure, enough, behind

    def _report(self, status: Value) -> None:
        self.module.d.sync += [
            self.status.payload.eq(status),
            self.status.valid.eq(1),
            self.error.eq(Status.OK),
        ]

    def _drain(self) -> None:
        """Drop the rest of a packet, beat by beat, and report its status at the last beat."""
        m, window = self.module, self.window
        slack = self.plan.slack_bytes
        extra = self.extra
        total = Signal(range(slack + 2 + self.plan.bus_bytes))
        m.d.comb += total.eq(extra + window.first_bytes)
        status = Signal(Status)
        m.d.comb += status.eq(self.error)
        with m.If((self.error == Status.OK) & (total > slack)):
            m.d.comb += status.eq(Status.TRAILING)
        with m.If(self.draining & window.held):
            with m.If(~window.first_last):
                m.d.comb += window.drop.eq(1)
                m.d.sync += extra.eq(Mux(total > slack, slack + 1, total))
            with m.Elif(self.free(self.status)):
                m.d.comb += window.drop.eq(1)
                m.d.sync += self.draining.eq(0)
                self._report(status)


def _slots(step: Step) -> int:
    """Return how many leaves a step writes."""
    return sum(part.completes for part in step.parts) + (step.take is not None)
