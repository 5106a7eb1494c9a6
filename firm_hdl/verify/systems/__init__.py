"""What all test systems share: their interface, their options, and their tasks."""

__all__ = []
