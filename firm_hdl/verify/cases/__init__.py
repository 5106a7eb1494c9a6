"""Messages and packets to test a type with, chosen for its plan."""

__all__ = []
