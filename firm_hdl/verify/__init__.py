"""Verification: converters against oracles, on every type.

``python -m firm_hdl.verify`` runs it.
"""

__all__ = []
