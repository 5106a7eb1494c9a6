"""The two converters of a plan."""

from __future__ import annotations

from typing import Literal, TypeAlias

__all__ = ["DIRECTIONS", "Direction"]

Direction: TypeAlias = Literal["deserializer", "serializer"]
DIRECTIONS: tuple[Direction, ...] = ("deserializer", "serializer")
