"""TS2: is the plan of a type correct, and does it still match the accepted golden plan?"""

__all__ = []
