"""Verification: converters against oracles, on every type. ``firm-hdl verify`` runs it."""

__all__ = []
