"""Texts of results: shortened texts, and the first difference of two sequences."""

from __future__ import annotations

from collections.abc import Sequence

__all__ = ["clipped", "first_difference"]


def clipped(text: str, most: int) -> str:
    """Return at most `most` characters of a text, and its length if it is longer."""
    return text if len(text) <= most else f"{text[:most]}... ({len(text)} characters)"


def first_difference(received: Sequence[object], expected: Sequence[object]) -> int:
    """Return the index of the first item that differs; their common length if none does."""
    pairs = enumerate(zip(received, expected, strict=False))
    return next((n for n, (a, b) in pairs if a != b), min(len(received), len(expected)))
