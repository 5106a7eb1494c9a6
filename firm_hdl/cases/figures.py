"""Figures of a type and of its plan. A report correlates them with the times of tests."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence

from firm_hdl.metrics import metrics_of
from firm_hdl.model import Message
from firm_hdl.plan import Plan
from firm_hdl.plan.edges import edges
from firm_hdl.plan.shape import shape

__all__ = ["digest", "figures"]

OF_THE_TYPE = ("depth", "types", "leaves", "dynamic_leaves", "min_bytes", "shifting")
"""Attributes of :class:`firm_hdl.metrics.Metrics`."""


def figures(message: Message, plan: Plan, packets: Sequence[bytes]) -> dict[str, float]:
    """Return figures by name.

    Parameters
    ----------
    packets : sequence of bytes
        The packets of all cases.
    """
    of_the_type = metrics_of(message, plan.wire)
    found: dict[str, float] = {name: getattr(of_the_type, name) for name in OF_THE_TYPE}
    found["streams"] = len(plan.leaves)
    found["steps"] = len(plan.steps)
    found["loop_levels"] = plan.levels
    found["decisions"] = len(edges(plan))
    found["case_bytes"] = sum(map(len, packets))
    return found


def digest(plan: Plan) -> str:
    """Return a digest of the shape of a plan. Plans with equal circuits have equal digests."""
    return hashlib.sha256(repr(shape(plan)).encode()).hexdigest()[:16]
