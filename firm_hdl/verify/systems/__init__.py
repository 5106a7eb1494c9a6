"""What all test systems share: their interface, their tasks, and how a run ends."""

__all__ = []
