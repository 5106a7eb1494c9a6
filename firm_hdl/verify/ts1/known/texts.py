"""Values and names in definitions, as far as known differences are about them.

A character that an oracle would read otherwise becomes one of a private-use area, a name becomes
one that says what it was. Both are found again in what the oracle says. Numbers are read as Python,
which both ROS 1 and ROS 2 leave them to, reads them.
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
    """Replace each of some ASCII characters."""
    return text.translate({ord(each): chr(_AREA + ord(each)) for each in characters})


def shown(value: Any) -> Any:
    """Put back what `hidden` has replaced, in a text or in each one of a list."""
    if isinstance(value, list):
        return [shown(each) for each in value]
    if not isinstance(value, str):
        return value
    return re.sub("[\ue000-\ue07f]", lambda found: chr(ord(found[0]) - _AREA), value)


def renamed(name: str) -> str:
    """Give a name that every reader takes for a constant's."""
    return f"RENAMED{name.encode().hex().upper()}"


def renamed_back(item: dict[str, Any]) -> dict[str, Any]:
    """Give a constant the name back that `renamed` was given."""
    found = _RENAMED.fullmatch(item["name"])
    return item if found is None else {**item, "name": bytes.fromhex(found[1]).decode()}


def limits(kind: str, dialect: Dialect) -> tuple[int, int]:
    """Return the least and the largest value of an integer type."""
    bits = INTEGERS[kind]
    is_signed = kind.startswith("int") or (kind == "byte" and dialect == "ros1")
    return (-(1 << bits - 1), (1 << bits - 1) - 1) if is_signed else (0, (1 << bits) - 1)


def integer_of(value: str, dialect: Dialect) -> int | None:
    """Read an integer as ROS does: with the prefix of another base in ROS 2 only."""
    for base in (10, 0) if dialect == "ros2" else (10,):
        try:
            return int(value, base)
        except ValueError:
            continue
    return None


def float_of(value: str) -> float | None:
    """Read a floating-point number; words for infinity and for none are some, too."""
    try:
        return float(value.partition("#")[0])
    except ValueError:
        return None
