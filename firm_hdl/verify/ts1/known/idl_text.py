"""Texts in IDL: what of them is code, what it declares, and changes of it."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

__all__ = ["DECLARED", "TYPEDEF", "blanked", "changed", "in_code", "modules_of"]

# Texts and comments.
_QUIET = re.compile(r'("(?:[^"\\\n]|\\.)*"|//[^\n]*|/\*.*?\*/)', re.DOTALL)

DECLARED = re.compile(r"\bconst\s+([\w :]+?)\s+(\w+)\s*=\s*([^;]*?)\s*;")
"""A constant: its type, its name, and its value."""

TYPEDEF = re.compile(r"\btypedef\s+([^;{}]*?)\s*\b(\w+)\s*((?:\[[^\]]*\])?)\s*;")
"""A typedef: what it means, its name, and the size of an array in brackets."""


def blanked(text: str) -> str:
    """Return a text of the same length with blanks for its texts and comments."""
    return _QUIET.sub(lambda match: " " * len(match[0]), text)


def in_code(text: str, pattern: str, change: Any) -> str:
    """Replace a pattern outside of texts and comments."""
    parts = _QUIET.split(text)
    parts[::2] = [re.sub(pattern, change, part) for part in parts[::2]]
    return "".join(parts)


def modules_of(code: str) -> set[str]:
    """Name the modules that are declared."""
    return set(re.findall(r"\bmodule\s+(\w+)", code))


def changed(text: str, changes: Iterable[tuple[int, int, str]]) -> str:
    """Put others in the place of pieces of a text, each of which has a start and an end."""
    for start, end, new in sorted(changes, reverse=True):
        text = text[:start] + new + text[end:]
    return text
