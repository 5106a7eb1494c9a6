"""TS2: is the plan of a type right, and is it still the one that was accepted?"""

from __future__ import annotations

__all__ = []
