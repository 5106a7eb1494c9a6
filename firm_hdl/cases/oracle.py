"""The oracle: rosbags, which writes and reads messages without any code of ours.

Wire bytes are rosbags' own. Leaf transfers come from a walk over the objects that rosbags decoded
and the field definitions that rosbags keeps. The walk shares no code with the model, the layout or
the plan. So it also shows a mistake that both directions of our converters share.
docs/reference/errata.md lists where rosbags differs from ROS itself.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any, Literal, TypeAlias

from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_typestore
from rosbags.typesys.base import normalize_fieldname
from rosbags.typesys.store import Typestore

from firm_hdl.cases import NotJudgedError
from firm_hdl.wire import Wire

__all__ = ["DISTRO_STORES", "FieldType", "RosbagsOracle", "Transfers", "distro_oracle"]

DISTRO_STORES = {
    "noetic": Stores.ROS1_NOETIC,
    "foxy": Stores.ROS2_FOXY,
    "humble": Stores.ROS2_HUMBLE,
    "iron": Stores.ROS2_IRON,
    "jazzy": Stores.ROS2_JAZZY,
    "kilted": Stores.ROS2_KILTED,
    "lyrical": Stores.ROS2_LYRICAL,
}
"""rosbags' name for the set of types of each distribution."""

FieldType: TypeAlias = "tuple[Nodetype, Any]"
"""How rosbags describes the type of a field."""

Transfers: TypeAlias = "dict[tuple[str, ...], list[int | tuple[tuple[int, ...], bool]]]"
"""Payloads of each leaf, in order, by the leaf's path."""

ROSBAGS_WIRES: frozenset[Wire] = frozenset({"ros1", "cdr"})
"""The wires that rosbags writes and reads. It cannot judge any other wire."""

SIZES = {"bool": 1, "byte": 1, "octet": 1, "char": 1, "float32": 4, "float64": 8}
SIZES |= {f"{sign}int{8 * size}": size for sign in ("", "u") for size in (1, 2, 4, 8)}

# On purpose not that of the model, which the oracle is there to judge.
EMPTY_MEMBER = "structure_needs_at_least_one_member"
ROS1_TIMES = ("builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration")


@dataclass(frozen=True, slots=True)
class RosbagsOracle:
    """rosbags' view of a set of types."""

    store: Typestore
    # The dialect of the types. In ROS 1, `byte` is signed, and times have `secs` and `nsecs`.
    dialect: Literal["ros1", "ros2"]

    def names(self) -> list[str]:
        """List all types as rosbags names them, ``package/msg/Type``."""
        builtin = ROS1_TIMES if self.dialect == "ros1" else ()
        return sorted(name for name in self.store.fielddefs if name not in builtin)

    def fields(self, name: str) -> list[tuple[str, FieldType]]:
        """Return the fields of a type. An empty message of ROS 2 has its one-byte member here."""
        return list(self.store.fielddefs[name][1])

    def structure(self, name: str) -> tuple[Any, ...]:
        """Return all that determines the wire format of a type, including its nested types."""

        def expand(kind: FieldType) -> Any:
            node, detail = kind
            if node == Nodetype.NAME:
                return detail, self.structure(detail)
            if node == Nodetype.BASE:
                return detail
            return node.name, expand(detail[0]), detail[1]

        return (self.dialect, tuple((field, expand(kind)) for field, kind in self.fields(name)))

    def write(self, value: object, name: str, wire: str) -> bytes:
        """Serialize an object; `NotJudgedError` if rosbags does not know the wire."""
        self._check(wire)
        if wire == "ros1":
            return bytes(self.store.serialize_ros1(value, name))
        return bytes(self.store.serialize_cdr(value, name, little_endian=True))

    def read(self, packet: bytes, name: str, wire: str) -> object:
        """Deserialize a packet; `NotJudgedError` if rosbags does not know the wire."""
        self._check(wire)
        if wire == "ros1":
            return self.store.deserialize_ros1(packet, name)
        return self.store.deserialize_cdr(packet, name)

    def _check(self, wire: str) -> None:
        if wire not in ROSBAGS_WIRES:
            raise NotJudgedError(f"rosbags does not write {wire}")

    def transfers(self, value: object, name: str, wire: str, bus_bytes: int) -> Transfers:
        """Return what the leaves of a deserializer transfer for an object."""
        walk = _Walk(self, wire, bus_bytes, {})
        walk.message(value, name, ())
        return walk.found


@cache
def distro_oracle(distro: str) -> RosbagsOracle:
    """Return the oracle of a distribution."""
    store = get_typestore(DISTRO_STORES[distro])
    return RosbagsOracle(store, "ros1" if distro == "noetic" else "ros2")


@dataclass(slots=True)
class _Walk:
    """The leaves of one object, in wire order."""

    oracle: RosbagsOracle
    wire: str
    bus_bytes: int
    found: Transfers

    def put(self, path: tuple[str, ...], payload: int | tuple[tuple[int, ...], bool]) -> None:
        self.found.setdefault(path, []).append(payload)

    def message(self, value: object, name: str, path: tuple[str, ...]) -> None:
        fields = self.oracle.fields(name)
        if not fields or fields[0][0] == EMPTY_MEMBER:
            if self.wire == "ros1":
                self.put((*path, "trigger"), 1)
            else:
                self.put((*path, EMPTY_MEMBER), 0)
            return
        if self.oracle.dialect == "ros1" and name in ROS1_TIMES:
            bits = 32
            sign = 1 << 31 if name.endswith("Duration") else 0
            for member, ours in (("sec", "secs"), ("nanosec", "nsecs")):
                number = getattr(value, member) & ((1 << bits) - 1)
                self.put((*path, ours), (number ^ sign) - sign)
            return
        for field, kind in fields:
            self.field(getattr(value, normalize_fieldname(field)), kind, (*path, field))

    def field(self, value: Any, kind: FieldType, path: tuple[str, ...]) -> None:
        node, detail = kind
        if node == Nodetype.NAME:
            self.message(value, detail, path)
        elif node == Nodetype.BASE and detail[0] == "string":
            text = value.encode()
            self.put((*path, "length"), len(text))
            self.items("uint8", text, len(text), path)
        elif node == Nodetype.BASE:
            self.put(path, self.scalar(value, detail[0]))
        else:
            element, _ = detail
            if node == Nodetype.SEQUENCE:
                self.put((*path, "length"), len(value))
            if element[0] == Nodetype.BASE and element[1][0] != "string":
                self.items(element[1][0], value.tobytes(), len(value), path)
            else:
                for each in value:
                    self.field(each, element, (*path, "item"))

    def scalar(self, value: Any, name: str) -> int:
        if name == "float32":
            return int(struct.unpack("<I", struct.pack("<f", value))[0])
        if name == "float64":
            return int(struct.unpack("<Q", struct.pack("<d", value))[0])
        return self.number(value & ((1 << 8 * SIZES[name]) - 1), name)

    def number(self, bits: int, name: str) -> int:
        signed = name.startswith("int") or (name == "byte" and self.oracle.dialect == "ros1")
        sign = 1 << (8 * SIZES[name] - 1) if signed else 0
        return (bits ^ sign) - sign

    def items(self, name: str, data: bytes, count: int, path: tuple[str, ...]) -> None:
        size = SIZES[name]
        lanes = max(1, self.bus_bytes // size)
        numbers = [
            self.number(int.from_bytes(data[at : at + size], "little"), name)
            for at in range(0, count * size, size)
        ]
        for chunk, last in _chunks(numbers, lanes):
            self.put((*path, "items"), (tuple(chunk), last))


def _chunks(numbers: list[int], size: int) -> Iterator[tuple[list[int], bool]]:
    for start in range(0, len(numbers), size):
        chunk = numbers[start : start + size]
        yield chunk + [0] * (size - len(chunk)), start + size >= len(numbers)
