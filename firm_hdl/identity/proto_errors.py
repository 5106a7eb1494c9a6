"""The error of a type whose example cannot be printed."""

from __future__ import annotations

__all__ = ["TooLargeError"]


class TooLargeError(ValueError):
    """An example would be too long; the message names the type."""
