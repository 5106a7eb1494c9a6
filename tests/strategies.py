"""Hypothesis strategies for message definitions and values, shared by all tests.

A definition comes as our model and as the ``.msg`` texts that rosbags, the oracle for bytes,
registers. Values are dicts by ROS field names; `to_rosbags` makes a rosbags object of one.
"""

from __future__ import annotations

import keyword
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from inspect import signature
from typing import Any

import numpy as np
from hypothesis import strategies as st
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from firm_hdl.model import PRIMITIVES, Array, Field, Message, Primitive, Sequence, String

__all__ = [
    "BUS_WIDTHS",
    "DIALECTS",
    "TIMES",
    "Definition",
    "definitions",
    "make",
    "on_every_bus",
    "texts_of",
    "to_rosbags",
    "values",
]

BUS_WIDTHS = (1, 2, 4, 8, 16, 32, 64)
DIALECTS = ("ros1", "ros2")


def on_every_bus(test: Callable[..., None]) -> Callable[..., None]:
    """Decorate a test that takes about a millisecond: it runs with each `bus_bytes`."""

    @wraps(test)
    def run(**arguments: Any) -> None:
        for width in BUS_WIDTHS:
            test(bus_bytes=width, **arguments)

    own = signature(test)
    others = [each for name, each in own.parameters.items() if name != "bus_bytes"]
    run.__signature__ = own.replace(parameters=others)  # type: ignore[attr-defined]
    return run


# Names that are legal in both dialects, but reserved or special in some other language.
# fmt: off
NAMES = [
    "a", "b", "c", "d", "data", "range", "type", "map", "label", "units", "from", "class",
    "signature", "metadata", "clk", "rst", "yes", "on", "off", "null", "length", "items", "item",
    "trigger", "last", "count", "e1", "pad", "fixed", "x1", "y", "sec", "nsecs", "header",
]
# fmt: on
SIZES = st.one_of(
    st.integers(0, 4), st.sampled_from([5, 7, 8, 9, 15, 16, 17, 31, 32, 33, 63, 64, 65, 130])
)


def _time(name: str, kind: str) -> Message:
    fields = tuple(Field(name=part, type=PRIMITIVES["ros1"][kind]) for part in ("secs", "nsecs"))
    return Message(name=name, dialect="ros1", fields=fields)


TIMES = (_time("time", "uint32"), _time("duration", "int32"))


@dataclass(frozen=True)
class Definition:
    """A message type.

    Attributes
    ----------
    message : Message
    texts : dict
        ``.msg`` texts of it and of all that it depends on, by the names that rosbags has for them.
    """

    message: Message
    texts: dict[str, str]

    def __repr__(self) -> str:
        return "\n".join(f"--- {name}\n{text}" for name, text in self.texts.items())

    @property
    def rosbags_name(self) -> str:
        return _rosbags_name(self.message)

    def store(self) -> Any:
        """Return a rosbags type store that knows the type."""
        store = get_typestore(Stores.EMPTY)
        types: dict[str, Any] = {}
        for name, text in self.texts.items():
            types.update(get_types_from_msg(text, name))
        store.register(types)
        return store


def _rosbags_name(message: Message) -> str:
    builtin = {"time": "Time", "duration": "Duration"}
    if message.name in builtin:
        return f"builtin_interfaces/msg/{builtin[message.name]}"
    return f"{message.package}/msg/{message.base_name}"


def _text(message: Message) -> str:
    return "".join(f"{item.type} {item.name}\n" for item in message.fields)


def texts_of(message: Message) -> dict[str, str]:
    """Return the ``.msg`` texts of a type and its dependencies as rosbags registers them."""
    texts: dict[str, str] = {}
    for child in message.children:
        texts.update(texts_of(child))
    if message.name in ("time", "duration"):
        return {_rosbags_name(message): "int32 sec\nuint32 nanosec\n"}
    texts[_rosbags_name(message)] = _text(message)
    return texts


def make(dialect: Any, fields: dict[str, Any], name: str = "T") -> Message:
    """Make a message type; a field's type is as in a ``.msg``, or an element and its suffix."""
    middle = "" if dialect == "ros1" else "msg/"
    return Message(
        name=f"p/{middle}{name}",
        dialect=dialect,
        fields=tuple(Field(name=n, type=_parse(dialect, kind)) for n, kind in fields.items()),
    )


def _parse(dialect: Any, kind: Any) -> Any:
    element, suffix = kind if isinstance(kind, tuple) else (kind, "")
    if isinstance(element, str):
        found = re.fullmatch(r"(\w+)(?:<=(\d+))?((?:\[.*\])?)", element)
        assert found is not None
        name, bound, suffix = found[1], found[2] and int(found[2]), found[3]
        text = name in ("string", "wstring")
        element = String(bound=bound, wide=name[0] == "w") if text else PRIMITIVES[dialect][name]
    if not suffix:
        return element
    inside = suffix[1:-1]
    if inside.isdigit():
        return Array(element=element, count=int(inside))
    return Sequence(element=element, bound=int(inside[2:]) if inside else None)


@st.composite
def definitions(
    draw: st.DrawFn, dialect: str | None = None, *, wide: bool = False, depth: int = 3
) -> Definition:
    """Build definitions of all kinds; `wide` adds `wstring`, which rosbags lacks."""
    if dialect is None:
        dialect = draw(st.sampled_from(DIALECTS))
    pool: list[Message] = list(TIMES) if dialect == "ros1" else []
    message = _message(draw, dialect, depth, pool, wide)
    return Definition(message=message, texts=texts_of(message))


def _message(draw: st.DrawFn, dialect: Any, depth: int, pool: list[Message], wide: bool) -> Message:
    names = draw(st.lists(st.sampled_from(NAMES), max_size=5, unique=True))
    fields = tuple(Field(name=name, type=_kind(draw, dialect, depth, pool, wide)) for name in names)
    middle = "" if dialect == "ros1" else "msg/"
    message = Message(name=f"p/{middle}T{len(pool)}", dialect=dialect, fields=fields)
    pool.append(message)
    return message


def _kind(draw: st.DrawFn, dialect: Any, depth: int, pool: list[Message], wide: bool) -> Any:
    element = _element(draw, dialect, depth, pool, wide)
    shape = draw(st.sampled_from(["one", "one", "one", "array", "sequence", "bounded"]))
    if shape == "one":
        return element
    small = isinstance(element, Message | String)
    if shape == "array":
        count = draw(st.integers(1, 3) if small else SIZES.filter(bool))
        return Array(element=element, count=count)
    if shape == "sequence" or dialect == "ros1":
        return Sequence(element=element)
    return Sequence(element=element, bound=draw(st.integers(1, 3 if small else 20)))


def _element(draw: st.DrawFn, dialect: Any, depth: int, pool: list[Message], wide: bool) -> Any:
    what = draw(st.sampled_from(["primitive", "primitive", "primitive", "text", "message", "old"]))
    if what == "message" and depth > 1:
        return _message(draw, dialect, depth - 1, pool, wide)
    # Only shallow earlier types, so that the depth stays within its limit.
    old = [message for message in pool if message.depth < depth]
    if what == "old" and old:
        return draw(st.sampled_from(old))
    if what == "text":
        bound = draw(st.none() | st.integers(1, 20)) if dialect == "ros2" else None
        return String(bound=bound, wide=wide and draw(st.booleans()))
    return draw(st.sampled_from(sorted(PRIMITIVES[dialect].values(), key=lambda p: p.name)))


def values(message: Message) -> st.SearchStrategy[dict[str, Any]]:
    """Values of a type, as dicts; arrays of primitives are numpy arrays, with NaNs."""
    return st.fixed_dictionaries({item.name: _values(item.type) for item in message.fields})


def _values(kind: Any) -> st.SearchStrategy[Any]:
    match kind:
        case Primitive(kind="bool"):
            return st.booleans()
        case Primitive(kind="float"):
            # A NaN may change on its way through a Python float.
            return st.floats(width=8 * kind.bytes, allow_nan=False)
        case Primitive():
            bits = 8 * kind.bytes
            low = -1 << (bits - 1) if kind.signed else 0
            return st.integers(low, low + (1 << bits) - 1)
        case Message():
            return values(kind)
        case String(wide=True, bound=bound):
            # A character beyond 16 bits takes two UTF-16 units.
            return st.text(max_size=12 if bound is None else bound // 2)
        case String(bound=bound):
            return st.text(max_size=20 if bound is None else bound // 4)
        case Array(element=Primitive() as item, count=count):
            return _arrays(item, st.just(count))
        case Sequence(element=Primitive() as item, bound=bound):
            sizes = SIZES if bound is None else st.integers(0, bound)
            return _arrays(item, sizes)
        case Array(element=element, count=count):
            return st.lists(_values(element), min_size=count, max_size=count)
        case Sequence(element=element, bound=bound):
            return st.lists(_values(element), max_size=min(3, bound or 3))
    raise AssertionError(kind)


def _arrays(item: Primitive, sizes: st.SearchStrategy[int]) -> st.SearchStrategy[Any]:
    if item.kind == "bool":
        dtype, mask = np.dtype(np.bool_), 1
    else:
        letter = {"float": "f", "int": "i" if item.signed else "u"}[item.kind]
        dtype, mask = np.dtype(f"<{letter}{item.bytes}"), 255

    def build(data: bytes) -> Any:
        return np.frombuffer(bytes(byte & mask for byte in data), dtype=dtype).copy()

    def sized(count: int) -> st.SearchStrategy[Any]:
        size = count * item.bytes
        return st.binary(min_size=size, max_size=size).map(build)

    return sizes.flatmap(sized)


def to_rosbags(store: Any, message: Message, value: dict[str, Any]) -> Any:
    """Make a rosbags object of a value."""
    cls = store.types[_rosbags_name(message)]
    given = {}
    for item in message.fields:
        name = {"secs": "sec", "nsecs": "nanosec"}.get(item.name, item.name)
        if message.name not in ("time", "duration"):
            name = item.name
        name += "_" if keyword.iskeyword(name) else ""
        given[name] = _to_rosbags(store, item.type, value[item.name])
    if message.name in ("time", "duration"):
        # rosbags has ROS 2's types in their place, which differ in signedness.
        given = {"sec": _wrap(given["sec"], True), "nanosec": _wrap(given["nanosec"], False)}
    return cls(**given)


def _wrap(number: int, signed: bool) -> int:
    return int.from_bytes((number & 0xFFFFFFFF).to_bytes(4, "little"), "little", signed=signed)


def _to_rosbags(store: Any, kind: Any, value: Any) -> Any:
    match kind:
        case Primitive(name="byte"):
            return (value + 128) % 256 - 128
        case Message():
            return to_rosbags(store, kind, value)
        case Array(element=Primitive(name="byte")) | Sequence(element=Primitive(name="byte")):
            return value.view(np.int8)
        case Array(element=Message() as element) | Sequence(element=Message() as element):
            return [to_rosbags(store, element, each) for each in value]
    return value
