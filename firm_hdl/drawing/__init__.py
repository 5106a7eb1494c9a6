"""Drawing: figures with scales and axes as SVG, inside a page or as files of their own."""

from __future__ import annotations

__all__ = []
