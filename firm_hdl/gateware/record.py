"""The record view: a message, or the part of it whose size is fixed, as one structure.

A reader joins leaves into one stream whose payload has the message's own fields, all valid
together; a writer splits such a stream. Scalars cost no storage, because the converters hold each
leaf until it is taken. An array that comes in several transfers is collected in registers.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import TypeAlias

from amaranth.hdl import Cat, Module, Shape, Signal, Value
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.members import MemberTree, member_tree
from firm_hdl.gateware.signatures import leaf_shape, plan_signature, signature_of
from firm_hdl.model import Array, Field, FieldType, Message, Primitive, Sequence, Text
from firm_hdl.plan import Leaf, Plan, build_plan
from firm_hdl.wire import Wire, lay_out
from firm_hdl.wire.layout import OCTET

__all__ = ["RecordReader", "RecordWriter", "record_layout"]

MAX_CELL_BITS = 65_535
"""Amaranth 0.5 elaborates no wider cell."""

MAX_RECORD_BITS = MAX_CELL_BITS

Path: TypeAlias = "tuple[str, ...]"
Place: TypeAlias = "tuple[str | int, ...]"
Shapes: TypeAlias = "Shape | data.StructLayout | data.ArrayLayout"


@dataclass(slots=True)
class _Record:
    """What of a message is in the record: its layout, and where each transfer of a leaf goes."""

    layout: data.StructLayout
    transfers: dict[Path, list[list[Place]]] = field(default_factory=dict)


def record_layout(
    message: Message, *, wire: Wire | None = None, fields: Iterable[str] | None = None
) -> data.StructLayout:
    """Return the payload of a record view.

    Parameters
    ----------
    message : Message
    wire : "ros1", "cdr" or None
        `None`: the wire of the message's dialect.
    fields : iterable of str, or None
        Dotted names of what to include (``"header.stamp"``); `None`: everything of fixed size that
        is not inside a sequence.

    Raises
    ------
    ValueError
        If a name is not that of a field of fixed size, nothing is left, or the record has more than
        65,535 bits.
    """
    return _record(message, build_plan(lay_out(message, wire)), fields).layout


def _fixed(kind: FieldType) -> bool:
    match kind:
        case Primitive():
            return True
        case Message():
            return kind.is_fixed_size
        case Array():
            return _fixed(kind.element)
        case Text() | Sequence():
            return False


def _bits(kind: FieldType) -> int:
    match kind:
        case Primitive():
            return 1 if kind.kind == "bool" else 8 * kind.bytes
        case Message():
            return sum(_bits(item.type) for item in kind.fields)
        case Array():
            return kind.count * _bits(kind.element)
        case Text() | Sequence():
            return 0


def _record(message: Message, plan: Plan, fields: Iterable[str] | None) -> _Record:
    leaves = {leaf.path: leaf for leaf in plan.leaves}
    if isinstance(fields, str):
        raise TypeError(f"Fields must be a list of names, not the text {fields!r}")
    wanted = None if fields is None else [tuple(name.split(".")) for name in fields]
    unknown = set(wanted or ())
    record = _Record(data.StructLayout({}))

    def included(path: Path, kind: FieldType) -> bool:
        if wanted is None:
            return _fixed(kind)
        for name in wanted:
            if path[: len(name)] == name and _fixed(kind):
                unknown.discard(name)
                return True
        return False

    def part(kind: Message, path: Path) -> data.StructLayout | None:
        members: dict[str, Shapes] = {}
        for item in kind.fields:
            here = (*path, item.name)
            if included(here, item.type):
                if _bits(item.type) > MAX_RECORD_BITS:
                    raise ValueError(_too_wide(message, ".".join(here), _bits(item.type)))
                members[item.name] = _walk(item.type, here, here, plan, leaves, record.transfers)
            elif isinstance(item.type, Message) and (nested := part(item.type, here)) is not None:
                members[item.name] = nested
        return data.StructLayout(members) if members else None

    layout = part(message, ())
    if unknown:
        names = ", ".join(repr(".".join(name)) for name in sorted(unknown))
        raise ValueError(f"Message {message.name} has no field of fixed size {names}")
    if layout is None:
        raise ValueError(f"Message {message.name} has no field of fixed size for a record")
    if layout.size > MAX_RECORD_BITS:
        raise ValueError(_too_wide(message, "record", layout.size))
    record.layout = layout
    return record


def _too_wide(message: Message, what: str, bits: int) -> str:
    return (
        f"Record of {message.name} is too wide: {what} has {bits} bits, and Amaranth elaborates at "
        f"most {MAX_RECORD_BITS}"
    )


def _walk(
    kind: FieldType,
    path: Path,
    place: Place,
    plan: Plan,
    leaves: dict[Path, Leaf],
    transfers: dict[Path, list[list[Place]]],
) -> Shapes:
    """Note where the transfers of a value go, in the order in which they come; return its shape."""
    match kind:
        case Primitive():
            transfers.setdefault(path, []).append([place])
            return leaf_shape(leaves[path])
        case Message(fields=()):
            # On a wire where it has bytes there is one octet, and else one trigger.
            name = "trigger" if (*path, "trigger") in leaves else _empty_member(path, leaves)
            member = Field(name=name, type=OCTET)
            shape = _walk(member.type, (*path, name), (*place, name), plan, leaves, transfers)
            return data.StructLayout({name: shape})
        case Message():
            return data.StructLayout(
                {
                    item.name: _walk(
                        item.type, (*path, item.name), (*place, item.name), plan, leaves, transfers
                    )
                    for item in kind.fields
                }
            )
        case Array(element=Primitive(), count=count):
            leaf = leaves[(*path, "items")]
            shape = leaf_shape(leaf)["data"].shape.elem_shape
            for first in range(0, count, leaf.lanes):
                places = [(*place, index) for index in range(first, min(first + leaf.lanes, count))]
                transfers.setdefault(leaf.path, []).append(places)
            return data.ArrayLayout(shape, count)
        case Array(element=element, count=count):
            shapes = [
                _walk(element, (*path, "item"), (*place, index), plan, leaves, transfers)
                for index in range(count)
            ]
            return data.ArrayLayout(shapes[0], count)
    raise AssertionError(kind)


def _empty_member(path: Path, leaves: dict[Path, Leaf]) -> str:
    return next(leaf[-1] for leaf in leaves if leaf[:-1] == path)


def _bits_at(layout: Shapes, place: Place) -> slice:
    """Return which bits of a record a value has."""
    bit = 0
    for key in place:
        assert isinstance(layout, data.Layout)
        member = layout[key]
        bit, layout = bit + member.offset, member.shape
    return slice(bit, bit + Shape.cast(layout).width)


class _Adapter(wiring.Component):
    def __init__(
        self,
        message: Message,
        *,
        wire: Wire | None,
        bus_bytes: int,
        fields: Iterable[str] | None,
        reads: bool,
    ):
        self.plan = build_plan(lay_out(message, wire), bus_bytes=bus_bytes)
        self.tree = member_tree(leaf.path for leaf in self.plan.leaves)
        self._record = _record(message, self.plan, fields)
        inner, outer = (In, Out) if reads else (Out, In)
        signature = {
            "message": inner(plan_signature(self.plan, self.tree)),
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

    def _bits(self, places: list[Place]) -> slice:
        """Return which bits of the record a transfer has: items of an array are neighbours."""
        ends = [_bits_at(self._record.layout, place) for place in (places[0], places[-1])]
        return slice(ends[0].start, ends[1].stop)

    def _streams(self) -> Iterator[tuple[list[list[Place]], stream.Interface]]:
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
            source, sink = ends if isinstance(self, RecordReader) else ends[::-1]
            m.d.comb += [
                sink.payload.eq(source.payload),
                sink.valid.eq(source.valid),
                source.ready.eq(sink.ready),
            ]


def _member(interface: object, path: Path) -> stream.Interface:
    for name in path:
        interface = getattr(interface, name)
    return interface


def _values(interface: stream.Interface) -> Value:
    """Return the values of a transfer: its lanes, the first one lowest, or the one scalar."""
    payload = interface.payload
    return Value.cast(payload.data if isinstance(payload, data.View) else payload)


class RecordReader(_Adapter):
    """Join the leaves of a message that have a fixed size into one stream of records.

    A record is offered when every one of its leaves is there; latency 0. `record.valid` depends
    combinationally on the leaves' `valid`, their `ready` on `record.ready`. Arrays of more than one
    transfer are collected in registers; their next message waits until the record is taken.

    Parameters
    ----------
    message, wire, fields
        As for :func:`record_layout`.
    bus_bytes : int
        That of the converter.

    Members
    -------
    message : In(MessageSignature(message, bus_bytes))
    record : Out(stream.Signature(record_layout(message)))
    rest : Out(Signature)
        The leaves that are not in the record, passed on; absent if there are none.
    """

    def __init__(
        self,
        message: Message,
        *,
        wire: Wire | None = None,
        bus_bytes: int = 8,
        fields: Iterable[str] | None = None,
    ):
        super().__init__(message, wire=wire, bus_bytes=bus_bytes, fields=fields, reads=True)

    def elaborate(self, platform: object) -> Module:
        m = Module()
        self._pass_on(m)
        taken = Signal()
        there: list[Value] = []
        parts: dict[int, Value] = {}
        for transfers, leaf in self._streams():
            if len(transfers) == 1:
                kept = _values(leaf)
                m.d.comb += leaf.ready.eq(taken)
                there.append(leaf.valid)
            else:
                kept, full = self._collect(m, len(transfers), leaf, taken)
                there.append(full)
            for number, places in enumerate(transfers):
                bits = self._bits(places)
                first = number * len(_values(leaf))
                parts[bits.start] = kept[first : first + bits.stop - bits.start]
        m.d.comb += [
            # One assignment: those to slices take time that grows with the square of their number.
            Value.cast(self.record.payload).eq(Cat(parts[bit] for bit in sorted(parts))),
            self.record.valid.eq(Cat(there).all()),
            taken.eq(self.record.valid & self.record.ready),
        ]
        return m

    def _collect(
        self, m: Module, count: int, leaf: stream.Interface, taken: Value
    ) -> tuple[Value, Value]:
        """Shift transfers through registers; return these, and whether all are there."""
        incoming = _values(leaf)
        width = len(incoming)
        index = Signal(range(count + 1))
        full = index == count
        m.d.comb += leaf.ready.eq(~full)
        with m.If(taken):
            m.d.sync += index.eq(0)
        with m.Elif(leaf.valid & ~full):
            m.d.sync += index.eq(index + 1)
        # Lanes that are in no record make it wider than a record can be.
        most = MAX_CELL_BITS // width
        parts: list[Signal] = []
        while count:
            # From the end of the message on, where transfers come in.
            parts.insert(0, kept := Signal(min(count, most) * width, name=f"kept_{len(parts)}"))
            with m.If(leaf.valid & ~full):
                m.d.sync += kept.eq(Cat(kept[width:], incoming))
            incoming, count = kept[:width], count - min(count, most)
        return (parts[0] if len(parts) == 1 else Cat(parts)), full


class RecordWriter(_Adapter):
    """Split a stream of records into leaves of a message: the mirror of :class:`RecordReader`.

    Every leaf is offered at once; the record is taken with the last of them. Latency 0;
    `record.ready` depends combinationally on the leaves' `ready`.

    Parameters
    ----------
    message, wire, bus_bytes, fields
        As for :class:`RecordReader`.

    Members
    -------
    record : In(stream.Signature(record_layout(message)))
    rest : In(Signature)
        The leaves that are not in the record; absent if there are none.
    message : Out(MessageSignature(message, bus_bytes))
    """

    def __init__(
        self,
        message: Message,
        *,
        wire: Wire | None = None,
        bus_bytes: int = 8,
        fields: Iterable[str] | None = None,
    ):
        super().__init__(message, wire=wire, bus_bytes=bus_bytes, fields=fields, reads=False)

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
        self, m: Module, transfers: list[list[Place]], leaf: stream.Interface, index: Signal
    ) -> None:
        vector = Value.cast(self.record.payload)
        with m.Switch(index):
            for number, places in enumerate(transfers):
                with m.Case(number):
                    m.d.comb += _values(leaf).eq(vector[self._bits(places)])
        if isinstance(leaf.payload, data.View):
            ends = [number for number, last in enumerate(_array_ends(transfers)) if last]
            m.d.comb += leaf.payload.last.eq(Cat(index == number for number in ends).any())


def _array_ends(transfers: list[list[Place]]) -> Iterator[bool]:
    """Yield, per transfer, whether it is the last one of its array."""
    for now, following in zip(transfers, [*transfers[1:], None], strict=True):
        yield following is None or following[0][:-1] != now[0][:-1]
