"""Choose the fields of a record view, and map the transfers of leaves to bits of the record."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import TypeAlias

from amaranth.hdl import Shape
from amaranth.lib import data

from firm_hdl.gateware.limits import MAX_CELL_BITS
from firm_hdl.gateware.signatures import leaf_shape
from firm_hdl.model import (
    Array,
    FieldType,
    Message,
    Primitive,
    Sequence,
    String,
    is_fixed_size,
)
from firm_hdl.plan import Leaf, Plan, build_plan
from firm_hdl.wire import Wire, lay_out

__all__ = ["Record", "Transfer", "record_layout"]

Path: TypeAlias = "tuple[str, ...]"
"""ROS field names, the outermost one first."""

Place: TypeAlias = "tuple[str | int, ...]"
"""Keys of a layout, the outermost one first: names of fields, indexes of arrays."""

Shapes: TypeAlias = "Shape | data.StructLayout | data.ArrayLayout"

Transfer: TypeAlias = "list[Place]"
"""The places of the values of one transfer: one for a scalar, one per used lane for items."""


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
        Dotted names of the fields to include (``"header.stamp"``). `None`: all fields of fixed size
        that are not inside a sequence.

    Raises
    ------
    ValueError
        If a name is not that of a field of fixed size, if the record would be empty, or if it has
        more than 65,535 bits.
    """
    return Record(message, build_plan(lay_out(message, wire)), fields).layout


class Record:
    """The layout of a record, and the place of each transfer in it.

    * `message`, `fields`: as for :func:`record_layout`, errors included.
    * `plan`: the plan of the message.
    """

    def __init__(self, message: Message, plan: Plan, fields: Iterable[str] | None):
        # The transfers of each leaf of the record, in order.
        self.transfers: dict[Path, list[Transfer]] = {}
        self._message = message
        self._leaves = {leaf.path: leaf for leaf in plan.leaves}
        self._choice = _Choice.of(fields)
        members = self._chosen(message, ())
        if not message.fields and fields is None:
            # Its one leaf says that the message came.
            whole = self._value(message, (), ())
            assert isinstance(whole, data.StructLayout)
            members = {name: field_.shape for name, field_ in whole}
        if self._choice.unknown:
            names = ", ".join(repr(".".join(name)) for name in sorted(self._choice.unknown))
            raise ValueError(
                f"Message {message.name} has no field of fixed size {names}; it has "
                f"{', '.join(_fixed_fields(message)) or 'none'}"
            )
        if not members:
            fields_ = ", ".join(f"{item.name} ({item.type})" for item in message.fields)
            raise ValueError(
                f"Message {message.name} has no field of fixed size for a record; "
                f"its fields: {fields_ or 'none'}"
            )
        self.layout = data.StructLayout(members)
        self._check_width("record", self.layout.size)

    def bits_of(self, transfer: Transfer) -> slice:
        """Return the bits of the record that a transfer fills; they are contiguous."""
        ends = [_bits_at(self.layout, place) for place in (transfer[0], transfer[-1])]
        return slice(ends[0].start, ends[1].stop)

    def _chosen(self, message: Message, path: Path) -> dict[str, Shapes]:
        """Return the members of the record for a message and the messages inside it."""
        members: dict[str, Shapes] = {}
        for item in message.fields:
            name = (*path, item.name)
            if self._choice.takes(name, item.type):
                self._check_width(".".join(name), _bits(item.type))
                members[item.name] = self._value(item.type, name, name)
            elif isinstance(item.type, Message) and (nested := self._chosen(item.type, name)):
                members[item.name] = data.StructLayout(nested)
        return members

    def _check_width(self, what: str, bits: int) -> None:
        if bits > MAX_CELL_BITS:
            raise ValueError(
                f"Record of {self._message.name} is too wide: {what} has {bits} bits, and Amaranth "
                f"elaborates at most {MAX_CELL_BITS}"
            )

    def _value(self, kind: FieldType, path: Path, place: Place) -> Shapes:
        """Record the places of the transfers of a value; return its shape."""
        match kind:
            case Primitive():
                return self._scalar(path, place)
            case Message(fields=()):
                # Its one leaf is an octet where the wire format gives it bytes, else a trigger.
                (name,) = (leaf[-1] for leaf in self._leaves if leaf[:-1] == path)
                return data.StructLayout({name: self._scalar((*path, name), (*place, name))})
            case Message(fields=fields):
                return data.StructLayout(
                    {
                        item.name: self._value(item.type, (*path, item.name), (*place, item.name))
                        for item in fields
                    }
                )
            case Array(element=Primitive(), count=count):
                return self._items(self._leaves[(*path, "items")], place, count)
            case Array(element=element, count=count):
                shapes = [
                    self._value(element, (*path, "item"), (*place, index)) for index in range(count)
                ]
                return data.ArrayLayout(shapes[0], count)
        raise AssertionError(kind)

    def _scalar(self, path: Path, place: Place) -> Shapes:
        self.transfers.setdefault(path, []).append([place])
        return leaf_shape(self._leaves[path])

    def _items(self, leaf: Leaf, place: Place, count: int) -> data.ArrayLayout:
        for first in range(0, count, leaf.lanes):
            places = [(*place, index) for index in range(first, min(first + leaf.lanes, count))]
            self.transfers.setdefault(leaf.path, []).append(places)
        return data.ArrayLayout(leaf_shape(leaf)["data"].shape.elem_shape, count)


@dataclass(slots=True)
class _Choice:
    """The fields that a user wants, by their paths; `None`: all of fixed size."""

    wanted: list[Path] | None
    # Wanted names that no field has matched so far.
    unknown: set[Path] = field(default_factory=set)

    @classmethod
    def of(cls, fields: Iterable[str] | None) -> _Choice:
        if isinstance(fields, str):
            raise TypeError(f"Fields must be a list of names, not the text {fields!r}")
        if fields is None:
            return cls(None)
        names = list(fields) if isinstance(fields, Iterable) else [fields]
        if not all(isinstance(name, str) for name in names):
            raise TypeError(f"Fields must be a list of names, not {fields!r}")
        if not names:
            raise ValueError("Fields must have at least one name; None takes all")
        wanted = [tuple(name.split(".")) for name in names]
        return cls(wanted, set(wanted))

    def takes(self, path: Path, kind: FieldType) -> bool:
        """Return whether all of a field is in the record."""
        if not is_fixed_size(kind):
            return False
        if self.wanted is None:
            return True
        name = next((name for name in self.wanted if path[: len(name)] == name), None)
        if name is not None:
            self.unknown.discard(name)
        return name is not None


def _fixed_fields(message: Message, path: Path = ()) -> Iterator[str]:
    """Yield the names of the fields that a record can have, without those inside of others."""
    for item in message.fields:
        name = (*path, item.name)
        if is_fixed_size(item.type):
            yield ".".join(name)
        elif isinstance(item.type, Message):
            yield from _fixed_fields(item.type, name)


def _bits(kind: FieldType) -> int:
    match kind:
        case Primitive():
            return kind.bits
        case Message():
            return sum(_bits(item.type) for item in kind.fields)
        case Array():
            return kind.count * _bits(kind.element)
        case String() | Sequence():
            return 0


def _bits_at(layout: Shapes, place: Place) -> slice:
    """Return the bits of a layout that a value has."""
    bit = 0
    for key in place:
        assert isinstance(layout, data.Layout)
        member = layout[key]
        bit, layout = bit + member.offset, member.shape
    return slice(bit, bit + Shape.cast(layout).width)
