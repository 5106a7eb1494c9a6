"""Scenes of blocks: what drives each of them, and what is claimed."""

from __future__ import annotations

__all__: list[str] = []
