"""The generated VHDL test benches as a test system."""

from __future__ import annotations

__all__ = []
