"""Find the measured converter that is nearest to a given one.

``python -m lab.bench`` writes ``figures.json``. An estimate is the measured figures of the
nearest converter with the same bus width and direction; nothing is computed from them. The nearest
converter has the smallest distance. A plan has three features: bits of the payloads of all leaves,
steps, and lengths; each is increased by 1 because it may be 0. The distance is the sum of the
absolute binary logarithms of the features' ratios, plus 1 for another wire format.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from math import log2
from typing import Any

from firm_hdl.plan import DIRECTIONS, Plan

__all__ = ["DATA", "Estimate", "estimate_text", "estimates_of", "features_of"]

DATA = "figures.json"
"""Name of the file, in this package."""

FEATURES = ("bits", "steps", "lengths")
"""Names of the features of a plan."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Estimate:
    """An estimate of a converter, or of another part of a node."""

    part: str  # FPGA and speed grade.
    # Look-up tables and flip-flops.
    lut: int
    ff: int
    mhz: float  # Clock rate.
    type: str  # The type that was measured, or which parts were.
    # Whether the measured type is the type itself, with a plan of the same features. Parts that are
    # not converters are estimated.
    is_same: bool


def features_of(plan: Plan) -> dict[str, int]:
    """Return the features by which plans are near each other, by the names of `FEATURES`."""
    bits = sum(leaf.primitive.bits * leaf.lanes for leaf in plan.leaves)
    lengths = sum(leaf.kind == "length" for leaf in plan.leaves)
    return {"bits": bits, "steps": len(plan.steps), "lengths": lengths}


def estimates_of(
    plan: Plan, measured: Sequence[Mapping[str, Any]] | None = None
) -> dict[str, Estimate]:
    """Return the nearest estimate of each converter of a plan.

    * `measured`: entries of the file; `None`: those of the package.

    The result is by ``deserializer`` and ``serializer``; empty if no converter with that bus was
    measured.
    """
    entries = _measured() if measured is None else measured
    features = features_of(plan)
    found: dict[str, Estimate] = {}
    for direction in DIRECTIONS:
        near = [
            (_distance(features, plan, entry), entry["type"], entry)
            for entry in entries
            if (entry["direction"], entry["bus_bytes"]) == (direction, plan.bus_bytes)
        ]
        if near:
            distance, name, entry = min(near, key=lambda each: each[:2])
            found[direction] = Estimate(
                part=entry["part"],
                lut=entry["lut"],
                ff=entry["ff"],
                mhz=entry["mhz"],
                type=name,
                is_same=name == plan.message and distance == 0,
            )
    return found


def _distance(features: Mapping[str, int], plan: Plan, entry: Mapping[str, Any]) -> float:
    apart: float = sum(abs(log2((1 + features[name]) / (1 + entry[name]))) for name in FEATURES)
    return apart + bool(entry["wire"] != plan.wire)


def estimate_text(plan: Plan) -> str:
    """Return lines with the estimates of a plan's converters; empty if there are none."""
    lines = []
    for direction, each in estimates_of(plan).items():
        what = "measured" if each.is_same else f"that of {each.type}, the nearest measured type"
        lines.append(
            f"    {direction} on {each.part}: {each.lut:,} look-up tables, {each.ff:,} "
            f"flip-flops, {each.mhz:.0f} MHz ({what})"
        )
    return "\n".join(lines)


@cache
def _measured() -> list[dict[str, Any]]:
    text = resources.files("firm_hdl.estimates").joinpath(DATA).read_text(encoding="utf-8")
    found: list[dict[str, Any]] = json.loads(text)
    return found
