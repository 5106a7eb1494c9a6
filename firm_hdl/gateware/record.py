"""The record view: a message, or its fields of fixed size, as one structure.

A reader joins leaves into one stream whose payload has the message's own fields; they become valid
together. A writer splits such a stream. Scalars cost no storage, because the converters hold each
leaf until it is taken. An array of several transfers is collected in registers.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, ClassVar

from amaranth.hdl import Cat, Module, Signal, Value
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.component import Component
from firm_hdl.gateware.interfaces import MessageInterface, Stream
from firm_hdl.gateware.limits import MAX_CELL_BITS
from firm_hdl.gateware.members import MemberTree, member_tree
from firm_hdl.gateware.record_layout import Record, Transfer
from firm_hdl.gateware.signatures import MessageSignature, signature_of
from firm_hdl.model import Message
from firm_hdl.plan import Plan, build_plan
from firm_hdl.wire import Wire, lay_out

__all__ = ["RecordReader", "RecordWriter"]


class _Adapter(Component):
    message: MessageInterface
    record: Stream[Any]
    rest: MessageInterface

    _reads: ClassVar[bool]
    """Whether the record is an output."""

    def __init__(
        self,
        message: Message,
        *,
        wire: Wire | None = None,
        bus_bytes: int = 8,
        fields: Iterable[str] | None = None,
        plan: Plan | None = None,
    ):
        self.plan = plan or build_plan(lay_out(message, wire), bus_bytes=bus_bytes)
        self.tree = member_tree(leaf.path for leaf in self.plan.leaves)
        self._record = Record(message, self.plan, fields)
        inner, outer = (In, Out) if self._reads else (Out, In)
        signature = {
            "message": inner(MessageSignature(message, plan=self.plan)),
            "record": outer(stream.Signature(self._record.layout)),
        }
        rest = self._rest(self.tree)
        if rest is not None:
            signature["rest"] = outer(signature_of(self.plan.leaves, rest))
        super().__init__(signature)

    def _rest(self, node: MemberTree) -> MemberTree | None:
        """Return the tree without the leaves of the record."""
        if node.leaf is not None:
            return None if self.plan.leaves[node.leaf].path in self._record.transfers else node
        children = {name: self._rest(child) for name, child in node.children.items()}
        left = {name: child for name, child in children.items() if child is not None}
        return MemberTree(node.member, None, left) if left else None

    def _streams(self) -> Iterator[tuple[list[Transfer], stream.Interface]]:
        for index, path in self.tree.leaves():
            transfers = self._record.transfers.get(self.plan.leaves[index].path)
            if transfers is not None:
                yield transfers, _member(self.message, path)

    def _pass_on(self, m: Module) -> None:
        rest = self._rest(self.tree)
        if rest is None:
            return
        for _, path in rest.leaves():
            ends = (_member(self.message, path), _member(self.rest, path))
            source, sink = ends if self._reads else ends[::-1]
            wiring.connect(m, wiring.flipped(source), wiring.flipped(sink))


def _member(interface: object, path: tuple[str, ...]) -> stream.Interface:
    for name in path:
        interface = getattr(interface, name)
    return interface


def _values(interface: stream.Interface) -> Value:
    """Return the values of a transfer: a scalar, or the lanes with lane 0 in the lowest bits."""
    payload = interface.payload
    return Value.cast(payload.data if isinstance(payload, data.View) else payload)


class RecordReader(_Adapter):
    """Join the leaves of a message that have a fixed size into one stream of records.

    A record is offered when all of its leaves are valid; latency 0. `record.valid` depends
    combinationally on the leaves' `valid`, and their `ready` on `record.ready`. Arrays of more than
    one transfer are collected in registers. Such an array of the next message waits until the
    record is taken.

    Parameters
    ----------
    message, wire, fields
        As for :func:`record_layout`.
    bus_bytes : int
        As for the converter.
    plan : Plan or None
        The plan of the converter, if it is made already. Then `wire`, `bus_bytes` have no effect.

    Members
    -------
    message : In(MessageSignature(message, bus_bytes))
    record : Out(stream.Signature(record_layout(message)))
    rest : Out(Signature)
        The leaves that are not in the record, connected through; absent if the record has all.
    """

    _reads = True

    def elaborate(self, platform: object) -> Module:
        m = Module()
        self._pass_on(m)
        taken = Signal()
        present: list[Value] = []
        parts: dict[int, Value] = {}
        for transfers, leaf in self._streams():
            if len(transfers) == 1:
                kept = _values(leaf)
                m.d.comb += leaf.ready.eq(taken)
                present.append(leaf.valid)
            else:
                kept, full = self._collect(m, len(transfers), leaf, taken)
                present.append(full)
            for number, places in enumerate(transfers):
                bits = self._record.bits_of(places)
                first = number * len(_values(leaf))
                parts[bits.start] = kept[first : first + bits.stop - bits.start]
        m.d.comb += [
            # One assignment, because elaborating n assignments to slices takes quadratic time.
            Value.cast(self.record.payload).eq(Cat(parts[bit] for bit in sorted(parts))),
            self.record.valid.eq(Cat(present).all()),
            taken.eq(self.record.valid & self.record.ready),
        ]
        return m

    def _collect(
        self, m: Module, count: int, leaf: stream.Interface, taken: Value
    ) -> tuple[Value, Value]:
        """Shift transfers through registers; return the registers, and whether all have arrived."""
        incoming = _values(leaf)
        width = len(incoming)
        index = Signal(range(count + 1))
        full = index == count
        m.d.comb += leaf.ready.eq(~full)
        with m.If(taken):
            m.d.sync += index.eq(0)
        with m.Elif(leaf.valid & ~full):
            m.d.sync += index.eq(index + 1)
        # With unused lanes of the last transfer, one register could be too wide for Amaranth.
        most = MAX_CELL_BITS // width
        parts: list[Signal] = []
        while count:
            # The last register comes first, because transfers enter there.
            parts.insert(0, kept := Signal(min(count, most) * width, name=f"kept_{len(parts)}"))
            with m.If(leaf.valid & ~full):
                m.d.sync += kept.eq(Cat(kept[width:], incoming))
            incoming, count = kept[:width], count - min(count, most)
        return (parts[0] if len(parts) == 1 else Cat(parts)), full


class RecordWriter(_Adapter):
    """Split a stream of records into leaves of a message: the inverse of :class:`RecordReader`.

    All leaves are offered at the same time. The record is taken in the cycle in which the last of
    them is taken. Latency 0; `record.ready` depends combinationally on the leaves' `ready`.

    Parameters
    ----------
    message, wire, bus_bytes, fields, plan
        As for :class:`RecordReader`.

    Members
    -------
    record : In(stream.Signature(record_layout(message)))
    rest : In(Signature)
        The leaves that are not in the record, connected through; absent if the record has all.
    message : Out(MessageSignature(message, bus_bytes))
    """

    _reads = False

    def elaborate(self, platform: object) -> Module:
        m = Module()
        self._pass_on(m)
        done: list[Value] = []
        taken = Signal()
        for transfers, leaf in self._streams():
            index = Signal(range(len(transfers) + 1))
            over = index == len(transfers)
            final = index == len(transfers) - 1
            m.d.comb += leaf.valid.eq(self.record.valid & ~over)
            sent = leaf.valid & leaf.ready
            with m.If(taken):
                m.d.sync += index.eq(0)
            with m.Elif(sent):
                m.d.sync += index.eq(index + 1)
            done.append(over | (final & sent))
            self._offer(m, transfers, leaf, index)
        m.d.comb += [
            taken.eq(self.record.valid & Cat(done).all()),
            self.record.ready.eq(taken),
        ]
        return m

    def _offer(
        self, m: Module, transfers: list[Transfer], leaf: stream.Interface, index: Signal
    ) -> None:
        vector = Value.cast(self.record.payload)
        with m.Switch(index):
            for number, places in enumerate(transfers):
                with m.Case(number):
                    m.d.comb += _values(leaf).eq(vector[self._record.bits_of(places)])
        if isinstance(leaf.payload, data.View):
            ends = [number for number, last in enumerate(_array_ends(transfers)) if last]
            m.d.comb += leaf.payload.last.eq(Cat(index == number for number in ends).any())


def _array_ends(transfers: list[Transfer]) -> Iterator[bool]:
    """Yield, per transfer, whether it is the last one of its array."""
    for now, following in zip(transfers, [*transfers[1:], None], strict=True):
        yield following is None or following[0][:-1] != now[0][:-1]
