"""The common parts of all test systems: their interface, their options, and their tasks."""

__all__ = []
