"""Covering sets: a few types with every feature of many types, and the command to choose them."""

from __future__ import annotations

__all__ = []
