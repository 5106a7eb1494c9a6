"""Small designs beside the VHDL that an engineer would write for them, each showing one rule.

The rules decide which operator gets a name, which condition is repeated, and what becomes an `if`,
a `case` or a conditional assignment. The hardware is the same either way, but not how easily people
read the text. All texts were reviewed line by line, and no tool updates them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from amaranth.hdl import Module, Signal

Made = tuple[Module, list[Any]]
GALLERY: dict[str, tuple[Callable[[], Made], str]] = {}


def shows(text: str) -> Callable[[Callable[[], Made]], Callable[[], Made]]:
    """Register a design with the text of its architecture, without the first and last line."""

    def register(make: Callable[[], Made]) -> Callable[[], Made]:
        assert make.__name__ not in GALLERY
        GALLERY[make.__name__] = make, text
        return make

    return register


def signals(names: str, width: int = 1) -> list[Any]:
    return [Signal(width, name=name) for name in names.split()]
