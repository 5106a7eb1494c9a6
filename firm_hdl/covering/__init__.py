"""Covering sets: a few types that have every feature of many, and the command that chooses them."""

from __future__ import annotations

__all__ = []
