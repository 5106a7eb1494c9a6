"""Messages and packets to test a type with, chosen for its plan."""

from __future__ import annotations

__all__ = []
