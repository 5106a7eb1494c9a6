"""What is wrong with a type of which no example can be printed."""

from __future__ import annotations

__all__ = ["TooLargeError"]


class TooLargeError(ValueError):
    """An example that would be too long; the text says of what."""
