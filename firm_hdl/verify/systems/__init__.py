"""What all test systems share: their interface, their tasks, and how a run ends."""

from __future__ import annotations

__all__ = []
