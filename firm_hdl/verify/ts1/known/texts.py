"""Values and names in definitions, for the rules of known differences.

A character that an oracle would read differently is replaced by one of a private-use area. A name
is replaced by one that encodes the original name. Both are restored in the oracle's facts. Numbers
are read by Python's rules, as in ROS 1 and ROS 2.
"""

from __future__ import annotations

import re
from typing import Any

from firm_hdl.model import Dialect

__all__ = [
    "FLOATS",
    "INTEGERS",
    "TEXTS",
    "float_of",
    "hidden",
    "integer_of",
    "limits",
    "renamed",
    "renamed_back",
    "shown",
]

INTEGERS: dict[str, int] = {
    f"{sign}int{bits}": bits for sign in ("", "u") for bits in (8, 16, 32, 64)
} | {"byte": 8, "char": 8}
"""Bits of the types of ``.msg`` whose values are integers."""

FLOATS = frozenset({"float32", "float64"})
TEXTS = frozenset({"string", "wstring"})

_AREA = 0xE000
_RENAMED = re.compile(r"RENAMED((?:[0-9A-F]{2})+)")


def hidden(text: str, characters: str) -> str:
    """Replace some ASCII characters of a text by characters of a private-use area."""
    return text.translate({ord(each): chr(_AREA + ord(each)) for each in characters})


def shown(value: Any) -> Any:
    """Restore the characters that `hidden` has replaced, in a text or in each text of a list."""
    if isinstance(value, list):
        return [shown(each) for each in value]
    if not isinstance(value, str):
        return value
    return re.sub("[\ue000-\ue07f]", lambda found: chr(ord(found[0]) - _AREA), value)


def renamed(name: str) -> str:
    """Return a name that encodes another one, and that every reader accepts for a constant."""
    return f"RENAMED{name.encode().hex().upper()}"


def renamed_back(item: dict[str, Any]) -> dict[str, Any]:
    """Restore the name of a constant that `renamed` has replaced."""
    found = _RENAMED.fullmatch(item["name"])
    return item if found is None else {**item, "name": bytes.fromhex(found[1]).decode()}


def limits(kind: str, dialect: Dialect) -> tuple[int, int]:
    """Return the smallest and the largest value of an integer type."""
    bits = INTEGERS[kind]
    is_signed = kind.startswith("int") or (kind == "byte" and dialect == "ros1")
    return (-(1 << bits - 1), (1 << bits - 1) - 1) if is_signed else (0, (1 << bits) - 1)


def integer_of(value: str, dialect: Dialect) -> int | None:
    """Read an integer as ROS does. Only ROS 2 accepts prefixes of other bases."""
    for base in (10, 0) if dialect == "ros2" else (10,):
        try:
            return int(value, base)
        except ValueError:
            continue
    return None


def float_of(value: str) -> float | None:
    """Read a floating-point number; the words for infinity and NaN are numbers, too."""
    try:
        return float(value.partition("#")[0])
    except ValueError:
        return None
