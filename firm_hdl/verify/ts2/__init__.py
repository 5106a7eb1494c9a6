"""TS2: is the plan of a type right, and is it still the one that was accepted?"""

__all__ = []
