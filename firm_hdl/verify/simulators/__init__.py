"""Simulators of exported text, which replay the runs of the Python simulation."""

__all__ = []
