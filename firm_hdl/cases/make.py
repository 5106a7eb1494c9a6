"""Test cases: messages of a type with chosen values.

Over the cases of a type, every string, sequence and run takes the lengths 0, 1 and 2. It also takes
every residue modulo the bus, lengths over two bus words, and its bound. Each of them takes its
lengths in another order, so that combinations differ. Primitives are all zero, all highest, all
lowest, all special (signed zeros, infinities, NaN with payloads, subnormal numbers) and then mixed.
Everything follows from the seed.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from rosbags.interfaces import Nodetype
from rosbags.typesys.base import normalize_fieldname

from firm_hdl.cases.oracle import EMPTY_MEMBER, SIZES, FieldType, RosbagsOracle, Transfers
from firm_hdl.cases.values import as_float, is_nan
from firm_hdl.plan import DecodeStatus

__all__ = ["Case", "make_cases", "run_lengths"]

MOST_BYTES = 1 << 13
"""Larger bounds, in bytes, are not reached, because simulation would take too long."""

MODES = ("zero", "high", "low", "special", "mixed")
CHARACTERS = ("azAZ09 _/~\x01\x7f", "äéßøÿ", "€漢ﬀ\ufeff", "🤖𝔸")  # noqa: RUF001
NUMPY_NAMES = {"bool": "bool", "byte": "uint8", "octet": "uint8", "char": "uint8"}
FLOATS = {
    "float32": (
        0x80000000,
        0x7F800000,
        0xFF800000,
        0x7FC12345,
        0xFFFFFFFF,
        1,
        0x7F7FFFFF,
        0x7F812345,
    ),
    "float64": (
        0x8000000000000000,
        0x7FF0000000000000,
        0xFFF0000000000000,
        0x7FF8000012345678,
        0xFFFFFFFFFFFFFFFF,
        1,
        0x7FEFFFFFFFFFFFFF,
        0x7FF0000000000001,
    ),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """One message."""

    what: str  # A description of how the values were chosen.
    value: object = field(repr=False)  # The rosbags object.
    packet: bytes  # The packet that rosbags writes for `value`.
    # The transfers of the message's leaves, from what rosbags reads in the packet.
    transfers: Transfers = field(repr=False)
    given: bytes | None = None  # The input of the deserializer, if it differs from `packet`.
    status: DecodeStatus = "OK"  # The expected status of the deserializer.

    @property
    def sent(self) -> bytes:
        """The input of the deserializer."""
        return self.packet if self.given is None else self.given


def run_lengths(item_bytes: int, bus_bytes: int, bound: int | None) -> list[int]:
    """Return the lengths that items should have at least once, without repetition."""
    lanes = max(1, bus_bytes // item_bytes)
    # On a narrow bus, every residue modulo 8 still counts: padding depends on it.
    most = max(3, lanes + 2, 8 // item_bytes + 2)
    lengths = [*range(most), 2 * lanes, 2 * lanes + 1, 3 * lanes - 1]
    if bound:
        lengths = [length for length in lengths if length <= bound]
        lengths += [bound] if bound * item_bytes <= MOST_BYTES else []
    return list(dict.fromkeys(lengths))


def make_cases(
    oracle: RosbagsOracle,
    name: str,
    *,
    wire: str,
    bus_bytes: int = 8,
    seed: int = 0,
    most: int | None = None,
) -> Iterator[Case]:
    """Yield the cases of a type, as many as are needed for all lengths.

    * `name`: ``package/msg/Type``.
    * `most`: the maximum number of cases; `None`: as many as the lengths need.
    """
    visits: dict[tuple[str, ...], _Visits] = {}
    number = 0
    while _more(number, most, visits):
        mode = MODES[min(number, len(MODES) - 1)]
        rng = random.Random(f"{seed}/{name}/{number}")
        maker = _Maker(oracle, bus_bytes, rng, mode, visits)
        value = maker.message(name, ())
        packet = oracle.write(value, name, wire)
        transfers = oracle.transfers(oracle.read(packet, name, wire), name, wire, bus_bytes)
        what = f"case {number} of {name}, seed {seed}: {mode} values"
        yield Case(what=what, value=value, packet=packet, transfers=transfers)
        number += 1


@dataclass(slots=True)
class _Visits:
    """The lengths that a place still has to take, and all its lengths."""

    left: list[int]
    lengths: list[int]


def _more(number: int, most: int | None, visits: dict[tuple[str, ...], _Visits]) -> bool:
    """Whether another case is needed: for all modes, and then until every length was taken.

    After twice as many cases as a place has lengths, no more cases are made.
    """
    if most is not None and number >= most:
        return False
    if number < len(MODES):
        return True
    longest = max((len(each.lengths) for each in visits.values()), default=0)
    return number < 2 * longest and any(each.left for each in visits.values())


@dataclass(slots=True)
class _Maker:
    """Makes the values of one case. All cases of a type share `visits`."""

    oracle: RosbagsOracle
    bus_bytes: int
    rng: random.Random
    mode: str
    visits: dict[tuple[str, ...], _Visits]
    # What is left for items. Once it is spent, lengths that are repeated are 0 or 1: otherwise,
    # nested sequences would explode.
    budget: int = 1000

    def message(self, name: str, path: tuple[str, ...]) -> Any:
        members = {}
        for member, kind in self.oracle.fields(name):
            value: Any = 0 if member == EMPTY_MEMBER else self.field(kind, (*path, member))
            members[normalize_fieldname(member)] = value
        return self.oracle.store.types[name](**members)

    def field(self, kind: FieldType, path: tuple[str, ...]) -> Any:
        node, detail = kind
        if node == Nodetype.NAME:
            return self.message(detail, path)
        if node == Nodetype.BASE:
            name, bound = detail
            if name == "string":
                return self.text(self.length(path, run_lengths(1, self.bus_bytes, bound)))
            return self.scalar(name)
        element, count = detail
        primitive = element[0] == Nodetype.BASE and element[1][0] != "string"
        if node == Nodetype.SEQUENCE:
            bound = count or None
            if primitive:
                lengths = run_lengths(SIZES[element[1][0]], self.bus_bytes, bound)
            else:
                lengths = [n for n in (2, 0, 1, 3) if bound is None or n <= bound]
                lengths += [bound] if bound and 3 < bound <= 16 else []
            count = self.length(path, lengths, cost=1 if primitive else 40)
        if primitive:
            return self.array(element[1][0], count)
        return [self.field(element, (*path, "item")) for _ in range(count)]

    def length(self, path: tuple[str, ...], lengths: list[int], cost: int = 1) -> int:
        """Choose a length that this place has not had yet, or any length if it has had all."""
        visits = self.visits.get(path)
        if visits is None:
            # Each place has its own order, so that neighbours combine differently in each case.
            order = self.rng.sample(lengths, len(lengths))
            visits = self.visits[path] = _Visits(left=order, lengths=lengths)
        if visits.left:
            choice = visits.left.pop()
        elif self.budget > 0:
            choice = self.rng.choice(lengths)
        else:
            choice = int(self.rng.random() < 0.4)
        self.budget -= cost * choice
        return choice

    def text(self, size: int) -> str:
        text = ""
        while size:
            most = self.rng.randint(1, min(4, size)) if self.mode != "zero" else 1
            text += self.rng.choice(CHARACTERS[most - 1])
            size -= most
        return text

    def scalar(self, name: str) -> Any:
        bits = self.bits(name)
        if name == "bool":
            return bool(bits)
        if name in FLOATS:
            size = SIZES[name]
            if is_nan(bits, size):
                # A Python float does not keep a signalling NaN, so the NaN is quiet at once.
                bits |= 1 << (22 if size == 4 else 51)
            return as_float(bits, size)
        # rosbags takes -128 to 127 for a byte, in ROS 2 as well.
        signed = name.startswith("int") or name == "byte"
        sign = 1 << (8 * SIZES[name] - 1) if signed else 0
        return (bits ^ sign) - sign

    def array(self, name: str, count: int) -> Any:
        dtype = np.dtype(NUMPY_NAMES.get(name, name))
        data = b"".join(self.bits(name).to_bytes(dtype.itemsize, "little") for _ in range(count))
        return np.frombuffer(data, dtype=dtype)

    def bits(self, name: str) -> int:
        """Choose a primitive by the mode of the case."""
        width = 1 if name == "bool" else 8 * SIZES[name]
        everything = (1 << width) - 1
        signed = name.startswith("int") or name == "byte"
        mode = self.rng.choice(("special", "any", "any")) if self.mode == "mixed" else self.mode
        if mode == "zero":
            return 0
        if mode == "high":
            return everything >> 1 if signed else everything
        if mode == "low":
            return 1 << (width - 1) if signed else 0 if name not in FLOATS else 1 << (width - 1)
        if mode == "special" and name in FLOATS:
            return self.rng.choice(FLOATS[name])
        if mode == "special":
            return self.rng.choice(
                (0, 1, everything, everything >> 1, everything ^ everything >> 1)
            )
        return self.rng.getrandbits(width)
