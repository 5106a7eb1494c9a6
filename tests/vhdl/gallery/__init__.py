"""Small designs with the VHDL that an engineer would write for them. Each shows one rule.

The rules decide which operator gets a name, which condition is repeated, and what becomes an `if`,
a `case` or a conditional assignment. The hardware is the same either way; the rules make the text
easier to read. All texts were reviewed line by line, and no tool updates them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from amaranth.hdl import Module, Signal

Design = tuple[Module, list[Any]]
GALLERY: dict[str, tuple[Callable[[], Design], str]] = {}


def shows(text: str) -> Callable[[Callable[[], Design]], Callable[[], Design]]:
    """Register a design with the text of its architecture, without the first and last line."""

    def register(make: Callable[[], Design]) -> Callable[[], Design]:
        assert make.__name__ not in GALLERY
        GALLERY[make.__name__] = make, text
        return make

    return register


def signals(names: str, width: int = 1) -> list[Any]:
    return [Signal(width, name=name) for name in names.split()]
