"""Messages and packets to test a type with, chosen for its plan, and the oracle that writes them.

Test benches, nodes and `firm_hdl.verify` use the same cases. The oracle is rosbags.
"""

from __future__ import annotations

__all__ = ["NotJudgedError"]


class NotJudgedError(Exception):
    """No oracle can judge something, such as a type; the text says why."""
