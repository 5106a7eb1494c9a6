"""Convert values of a message to transfers of its leaves, and back.

A value is a nested dict by ROS field names, or an object with the fields as attributes, such as a
message of rosbags. The code here walks over the message model and finds leaves only by their paths.
So the code is independent of the plan that it tests.
"""

from __future__ import annotations

import dataclasses
import keyword
import struct
from collections.abc import Iterable, Iterator, Mapping
from operator import index
from typing import Any

from firm_hdl.model import Array, Field, FieldType, Message, Primitive, Sequence, String
from firm_hdl.plan import Leaf, Payload, Plan
from firm_hdl.wire import CDR, Path

__all__ = ["from_transfers", "to_transfers"]

FLOATS = {4: "<f", 8: "<d"}
# rosbags uses the member names of ROS 2 for time and duration of ROS 1, too.
ALIASES = {"secs": "sec", "nsecs": "nanosec"}


def to_transfers(
    plan: Plan, message: Message, value: object, *, check_bounds: bool = True
) -> dict[int, list[Payload]]:
    """Return the transfers of every leaf for a value.

    Parameters
    ----------
    plan : Plan
        A plan of `message`.
    message : Message
    value : mapping or object
        Mappings have the ROS field names as keys, objects have them as attributes (rosbags'
        spellings ``from_`` and ``nanosec`` are accepted). Numbers may be Python's or numpy's. The
        bits of a float are kept if it is a numpy scalar or array of the field's own width. Text is
        `str`, or `bytes` without conversion. For a `wstring`, UTF-16 units as numbers are accepted
        instead of `bytes`. A ``byte`` is a number from -128 to 255, or `bytes` of length 1.
    check_bounds : bool
        Raise an error for more elements than a declared bound.

    Returns
    -------
    dict
        Payloads by index of the leaf, in order; every leaf has an entry.

    Raises
    ------
    TypeError
        If a value has the wrong type for its field.
    ValueError
        If a number, a count or a set of fields is not allowed by the message type.
    """
    _check(plan, message)
    splitter = _Splitter(plan, check_bounds)
    splitter.message(message, value, (), "")
    return splitter.streams


def from_transfers(
    plan: Plan,
    message: Message,
    transfers: Mapping[int, Iterable[Payload]],
    *,
    exact: bool = False,
) -> dict[str, Any]:
    """Return the value of a message, given its transfers.

    Numbers become `int`, `float` and `bool`, arrays and sequences become lists, and messages become
    dicts. Text becomes `str`. Text that is not UTF-8 becomes `bytes`, and a `wstring` with units
    over 0xFFFF becomes a list of numbers.

    Parameters
    ----------
    exact : bool
        Return floats as their bits, because a Python float does not keep every NaN. Return text
        always as `bytes`, and wide text always as a list of numbers.

    Raises
    ------
    ValueError
        If transfers are missing or left over, or if `last` is not set in exactly the last one.
    """
    _check(plan, message)
    if not isinstance(transfers, Mapping):
        raise TypeError(f"Transfers must be a dict of lists by leaf, not {transfers!r}")
    for leaf in transfers:
        if leaf not in range(len(plan.leaves)):
            last = len(plan.leaves) - 1
            raise ValueError(f"{plan.message} has the leaves 0 to {last}, not {leaf!r}")
    joiner = _Joiner(plan, transfers, exact)
    value = joiner.message(message, ())
    for leaf, stream in joiner.streams.items():
        if any(True for _ in stream):
            raise ValueError(f"Leaf {plan.leaves[leaf]} has more transfers than the message needs")
    return value


def _check(plan: Plan, message: Message) -> None:
    """Check that a plan of a user's is one of the message."""
    if not isinstance(plan, Plan) or not isinstance(message, Message):
        raise TypeError(f"A Plan and its Message are needed, not {plan!r} and {message!r}")
    if plan.message != message.name:
        raise ValueError(f"The plan is that of {plan.message}, not of {message.name}")


class _Leaves:
    """The leaves of a plan by path."""

    def __init__(self, plan: Plan):
        self.plan = plan
        self.indices = {leaf.path: number for number, leaf in enumerate(plan.leaves)}

    def leaf(self, path: Path) -> tuple[int, Leaf]:
        if path not in self.indices:
            raise ValueError(f"Plan of {self.plan.message} has no leaf {'.'.join(path)}")
        number = self.indices[path]
        return number, self.plan.leaves[number]

    def empty(self, path: Path) -> tuple[int, int]:
        """Return the leaf of an empty message, and its payload."""
        trigger = (*path, "trigger")
        if trigger in self.indices:
            return self.indices[trigger], 1
        assert CDR.empty_member is not None
        return self.leaf((*path, CDR.empty_member))[0], 0


class _Splitter(_Leaves):
    def __init__(self, plan: Plan, check_bounds: bool):
        super().__init__(plan)
        self.check_bounds = check_bounds
        self.streams: dict[int, list[Payload]] = {n: [] for n in range(len(plan.leaves))}

    def message(self, message: Message, value: object, path: Path, where: str) -> None:
        members = _members(message, value, where)
        if not message.fields:
            number, payload = self.empty(path)
            self.streams[number].append(payload)
        for item, member in zip(message.fields, members, strict=True):
            name = f"{where}.{item.name}" if where else item.name
            either = message.name in ("time", "duration")
            self.field(item.type, member, (*path, item.name), name, either=either)

    def field(
        self, kind: FieldType, value: Any, path: Path, where: str, *, either: bool = False
    ) -> None:
        match kind:
            case Primitive():
                self.streams[self.leaf(path)[0]].append(_bits(kind, value, where, either=either))
            case Message():
                self.message(kind, value, path, where)
            case String():
                items = _text_items(kind, value, where)
                self.length(len(items), kind.bound, path, where)
                self.items(items, path)
            case Array(element=element) | Sequence(element=element):
                if isinstance(value, str | Mapping) or not hasattr(value, "__len__"):
                    raise TypeError(f"{where} must be a list of {element}, not {value!r}")
                if isinstance(kind, Sequence):
                    self.length(len(value), kind.bound, path, where)
                elif len(value) != kind.count:
                    raise ValueError(f"{where} must have {kind.count} elements, not {len(value)}")
                if isinstance(element, Primitive):
                    self.items(_array_items(element, value, where), path)
                else:
                    for n, each in enumerate(value):
                        self.field(element, each, (*path, "item"), f"{where}[{n}]")

    def length(self, count: int, bound: int | None, path: Path, where: str) -> None:
        if self.check_bounds and bound is not None and count > bound:
            raise ValueError(f"{where} must have at most {bound} elements, not {count}")
        self.streams[self.leaf((*path, "length"))[0]].append(count)

    def items(self, values: list[int], path: Path) -> None:
        number, leaf = self.leaf((*path, "items"))
        for first in range(0, len(values), leaf.lanes):
            lanes = values[first : first + leaf.lanes]
            lanes += [0] * (leaf.lanes - len(lanes))
            self.streams[number].append((tuple(lanes), first + leaf.lanes >= len(values)))


class _Joiner(_Leaves):
    def __init__(self, plan: Plan, transfers: Mapping[int, Iterable[Payload]], exact: bool):
        super().__init__(plan)
        self.exact = exact
        self.streams: dict[int, Iterator[Payload]] = {n: iter(t) for n, t in transfers.items()}

    def receive(self, number: int) -> Payload:
        for payload in self.streams.get(number, iter(())):
            return payload
        leaf = self.plan.leaves[number]
        raise ValueError(f"Leaf {leaf} has fewer transfers than the message needs")

    def number(self, number: int) -> int:
        payload = self.receive(number)
        if not isinstance(payload, int):
            raise ValueError(f"Leaf {self.plan.leaves[number]} transfers numbers, not {payload!r}")
        return payload

    def message(self, message: Message, path: Path) -> dict[str, Any]:
        if not message.fields:
            self.number(self.empty(path)[0])
        return {item.name: self.field(item.type, (*path, item.name)) for item in message.fields}

    def field(self, kind: FieldType, path: Path) -> Any:
        match kind:
            case Primitive():
                return _number(kind, self.number(self.leaf(path)[0]), self.exact)
            case Message():
                return self.message(kind, path)
            case String():
                return _text(kind, self.items(self.length(path), path), self.exact)
            case Array(element=element) | Sequence(element=element):
                count = kind.count if isinstance(kind, Array) else self.length(path)
                if isinstance(element, Primitive):
                    items = self.items(count, path)
                    return [_number(element, bits, self.exact) for bits in items]
                return [self.field(element, (*path, "item")) for _ in range(count)]

    def length(self, path: Path) -> int:
        return self.number(self.leaf((*path, "length"))[0])

    def items(self, count: int, path: Path) -> list[int]:
        number, leaf = self.leaf((*path, "items"))
        values: list[int] = []
        while len(values) < count:
            payload = self.receive(number)
            if isinstance(payload, int):
                raise ValueError(f"Leaf {leaf} transfers lanes and `last`, not {payload!r}")
            lanes, last = payload
            values += lanes[: count - len(values)]
            if last != (len(values) == count):
                item = f"item {len(values)} of {count}"
                raise ValueError(f"Leaf {leaf} has the wrong `last` at {item}")
        return values


def _members(message: Message, value: object, where: str) -> list[Any]:
    """Return the values of a message's fields, in order."""
    what = where or "value"
    if isinstance(value, Mapping):
        given = dict(value)
    elif dataclasses.is_dataclass(value) and not isinstance(value, type):
        names = [f.name for f in dataclasses.fields(value) if not f.name.startswith("__")]
        given = {name: getattr(value, name) for name in names}
    elif isinstance(value, int | float | str | bytes | list | tuple | type | None):
        raise TypeError(f"{what} must be a {message.name} ({_fields(message)}), not {value!r}")
    else:
        names = [name for item in message.fields for name in _spellings(item)]
        given = {name: getattr(value, name) for name in names if hasattr(value, name)}
    if not message.fields:
        given.pop(CDR.empty_member, None)
    members = []
    for item in message.fields:
        names = [name for name in _spellings(item) if name in given]
        if not names:
            raise ValueError(
                f"{what} lacks the field {item.name!r} of {message.name} ({_fields(message)})"
            )
        members.append(given.pop(names[0]))
    if given:
        name = next(iter(given))
        raise ValueError(
            f"{what} has a field {name!r} that {message.name} does not have ({_fields(message)})"
        )
    return members


def _fields(message: Message) -> str:
    names = ", ".join(item.name for item in message.fields)
    return f"its fields: {names}" if names else "it has no fields"


def _spellings(item: Field) -> list[str]:
    names = [item.name, ALIASES.get(item.name, item.name)]
    return [*names, item.name + "_"] if keyword.iskeyword(item.name) else names


def _bits(kind: Primitive, value: Any, where: str, *, either: bool = False) -> int:
    """Return the number that a leaf transfers; with `either`, accept signed and unsigned values."""
    if kind.kind == "float":
        return _float_bits(kind, value, where)
    if kind.kind == "bool":
        if type(value).__name__ not in ("bool", "bool_", "int") or value not in (0, 1):
            raise TypeError(f"{where} must be a bool, not {value!r}")
        return int(value)
    if kind.name == "byte" and isinstance(value, bytes) and len(value) == 1:
        value = value[0]
    if isinstance(value, bool) or not hasattr(value, "__index__"):
        raise TypeError(f"{where} must be an integer, not {value!r}")
    number = index(value)
    bits = 8 * kind.bytes
    # rosbags reads a ROS 2 byte as signed, and ROS 1 time as ROS 2 defines it.
    either = either or kind.name == "byte"
    low = -1 << (bits - 1) if kind.signed or either else 0
    high = 1 << (bits - 1 if kind.signed and not either else bits)
    if not low <= number < high:
        raise ValueError(f"{where} must be from {low} to {high - 1}, not {number}")
    return _signed(number, bits) if kind.signed else number & ((1 << bits) - 1)


def _signed(bits: int, width: int) -> int:
    half = 1 << (width - 1)
    return (bits + half) % (1 << width) - half


def _float_bits(kind: Primitive, value: Any, where: str) -> int:
    if getattr(value, "dtype", None) == f"float{8 * kind.bytes}":
        # Use the bytes of the array, because conversion to a Python float may change a NaN.
        return int.from_bytes(value.astype(value.dtype.newbyteorder("<")).tobytes(), "little")
    if isinstance(value, bool) or not hasattr(value, "__float__"):
        raise TypeError(f"{where} must be a number, not {value!r}")
    try:
        return int.from_bytes(struct.pack(FLOATS[kind.bytes], float(value)), "little")
    except OverflowError:
        raise ValueError(f"{where} is too large for a {kind}: {value!r}") from None


def _array_items(kind: Primitive, value: Any, where: str) -> list[int]:
    """Return the numbers that the items of an array transfer; fast for matching numpy arrays."""
    dtype = getattr(value, "dtype", None)
    if isinstance(value, bytes | bytearray) and kind.bytes == 1 and kind.kind == "int":
        value = list(value) if not kind.signed else [_signed(byte, 8) for byte in value]
    elif dtype is not None and kind.kind == "float" and dtype == f"float{8 * kind.bytes}":
        ordered = value.astype(dtype.newbyteorder("<"))
        return [int(bits) for bits in ordered.view(f"<u{kind.bytes}").tolist()]
    elif dtype is not None and kind.kind == "int" and dtype.kind in "iu":
        value = value.tolist()
    return [_bits(kind, each, f"{where}[{n}]") for n, each in enumerate(value)]


def _text_items(kind: String, value: Any, where: str) -> list[int]:
    if not kind.wide and isinstance(value, str | bytes | bytearray):
        return list(value.encode() if isinstance(value, str) else value)
    if kind.wide and isinstance(value, str):
        units = value.encode("utf-16-le", "surrogatepass")
        return [int.from_bytes(units[i : i + 2], "little") for i in range(0, len(units), 2)]
    if kind.wide and isinstance(value, list | tuple):
        unit = Primitive(name="uint32", bytes=4, signed=False, kind="int")
        return [_bits(unit, each, f"{where}[{n}]") for n, each in enumerate(value)]
    raise TypeError(f"{where} must be a {kind}, not {value!r}")


def _number(kind: Primitive, bits: int, exact: bool) -> int | float | bool:
    if kind.kind == "bool":
        return bool(bits)
    if kind.kind == "int" or exact:
        return bits
    value: float = struct.unpack(FLOATS[kind.bytes], bits.to_bytes(kind.bytes, "little"))[0]
    return value


def _text(kind: String, items: list[int], exact: bool) -> str | bytes | list[int]:
    if kind.wide:
        if exact or any(unit >> 16 for unit in items):
            return items
        return b"".join(unit.to_bytes(2, "little") for unit in items).decode(
            "utf-16-le", "surrogatepass"
        )
    data = bytes(items)
    if exact:
        return data
    try:
        return data.decode()
    except UnicodeDecodeError:
        return data
