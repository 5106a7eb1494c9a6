"""Proofs that building blocks and converters keep their contracts, for every input on every port.

``lab/notes/formal.md`` has what is proved. ``make -C lab formal`` proves it.
"""

from __future__ import annotations

from lab.formal.run import all_proofs, prove, refute

__all__ = ["all_proofs", "prove", "refute"]
