"""Texts in IDL: finding their code and its declarations, and changing them."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

__all__ = ["DECLARED", "TYPEDEF", "blanked", "changed", "in_code", "modules_of"]

# String literals and comments.
_QUIET = re.compile(r'("(?:[^"\\\n]|\\.)*"|//[^\n]*|/\*.*?\*/)', re.DOTALL)

DECLARED = re.compile(r"\bconst\s+([\w :]+?)\s+(\w+)\s*=\s*([^;]*?)\s*;")
"""A constant: its type, its name, and its value."""

TYPEDEF = re.compile(r"\btypedef\s+([^;{}]*?)\s*\b(\w+)\s*((?:\[[^\]]*\])?)\s*;")
"""A typedef: its type, its name, and the size of an array in brackets."""


def blanked(text: str) -> str:
    """Replace string literals and comments by blanks, so that the length stays the same."""
    return _QUIET.sub(lambda match: " " * len(match[0]), text)


def in_code(text: str, pattern: str, change: Any) -> str:
    """Replace a pattern outside of string literals and comments."""
    parts = _QUIET.split(text)
    parts[::2] = [re.sub(pattern, change, part) for part in parts[::2]]
    return "".join(parts)


def modules_of(code: str) -> set[str]:
    """Return the names of the modules that are declared."""
    return set(re.findall(r"\bmodule\s+(\w+)", code))


def changed(text: str, changes: Iterable[tuple[int, int, str]]) -> str:
    """Replace pieces of a text. A change is the start and the end of a piece, and its new text."""
    for start, end, new in sorted(changes, reverse=True):
        text = text[:start] + new + text[end:]
    return text
