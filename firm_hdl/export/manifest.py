"""The manifest describes a folder of generated files, for tools and for people.

Back ends and packagers read the manifest instead of parsing hardware descriptions. `firm-hdl build`
reads it to see whether a folder is current. The manifest does not depend on the machine or the time
of the build.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from importlib.metadata import version
from math import isfinite
from typing import Any

import firm_hdl
from firm_hdl.estimates import estimates_of
from firm_hdl.export.top import field_of, leaf_names
from firm_hdl.gateware.signatures import LATENCY_CYCLES, Status
from firm_hdl.model import Constant, Message, closure
from firm_hdl.plan import Leaf, Plan, to_yaml
from firm_hdl.timing import LINE_RATES, Cost, Timing, clock_mhz

__all__ = [
    "FORMAT",
    "MANIFEST",
    "converter_facts",
    "converter_sections",
    "digest",
    "figures_of",
    "inputs_of",
    "manifest_of",
    "to_json",
]

FORMAT = 1
"""Version of the manifest's format."""

MANIFEST = "manifest.json"


def inputs_of(facts: Mapping[str, Any]) -> dict[str, Any]:
    """Return all that the files of a folder depend on: facts, and what makes the files of them."""
    inputs = {
        **facts,
        "generator": {"firm-hdl": firm_hdl.__version__, "amaranth": version("amaranth")},
    }
    # As the manifest is read back: lists in place of tuples.
    found: dict[str, Any] = json.loads(to_json(inputs))
    return found


def manifest_of(
    inputs: Mapping[str, Any], files: Mapping[str, str], sections: Mapping[str, Any]
) -> dict[str, Any]:
    """Describe a folder.

    * `inputs`: as :func:`inputs_of` returns them.
    * `files`: text of every other file in the folder, by name.
    * `sections`: what tools and people have to know of the design.
    """
    return {
        "format": FORMAT,
        "inputs": dict(inputs),
        "inputs_sha256": digest(to_json(inputs)),
        **sections,
        "files": {name: digest(text) for name, text in sorted(files.items())},
    }


def converter_facts(message: Message, plan: Plan) -> dict[str, Any]:
    """Return what the files of a type's converters depend on, besides options of the export."""
    return {
        "message": message.name,
        "dialect": message.dialect,
        "dependencies": sorted(child.name for child in closure(message.children)),
        "plan_sha256": digest(to_yaml(plan)),
    }


def converter_sections(message: Message, plan: Plan, figures: Timing) -> dict[str, Any]:
    """Describe the converters of a type."""
    statuses: Any = Status
    return {
        **figures_of(plan, figures),
        "status": {status.name: status.value for status in statuses},
        "leaves": list(_leaves(message, plan)),
        "constants": [_constant(constant) for constant in message.constants],
    }


def to_json(value: Any) -> str:
    """Print the manifest or a part of it; the text is deterministic."""
    return json.dumps(value, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def digest(text: str) -> str:
    """Return the SHA-256 of a text, in hexadecimal. Bytes that are not UTF-8 are surrogates."""
    return hashlib.sha256(text.encode("utf-8", "surrogateescape")).hexdigest()


def figures_of(plan: Plan, figures: Timing) -> dict[str, Any]:
    """Return timing and estimates of the converters of a plan, as a manifest has them."""
    return {
        "timing": _timing(figures),
        "estimates": {name: asdict(found) for name, found in estimates_of(plan).items()},
    }


def _timing(figures: Timing) -> dict[str, Any]:
    return {
        "steps": figures.steps,
        "latency_cycles": dict(LATENCY_CYCLES),
        "shortest_packet": _cost(figures.shortest),
        "hardest_packet_tried": _cost(figures.hardest),
        "recovery": {
            "most_cycles": figures.recovery.cycles,
            "longest_packet_cycles": figures.recovery.longest_packet,
        },
        "long_arrays_clock_mhz": _clocks(Cost(bytes=figures.bus_bytes, beats=1, steps=1, cycles=1)),
    }


def _cost(cost: Cost) -> dict[str, Any]:
    return {
        "bytes": cost.bytes,
        "beats": cost.beats,
        "cycles": cost.cycles,
        "clock_mhz": _clocks(cost),
    }


def _clocks(cost: Cost) -> dict[str, float]:
    return {rate: round(clock_mhz(cost, bits), 3) for rate, bits in LINE_RATES.items()}


def _leaves(message: Message, plan: Plan) -> Iterator[dict[str, Any]]:
    names = leaf_names(plan)
    for leaf in plan.leaves:
        field = field_of(message, leaf)
        entry = {
            "path": str(leaf),
            "name": names[leaf.path],
            "kind": leaf.kind,
            "type": leaf.type,
            "signed": leaf.signed,
            "layout": _layout(leaf),
        }
        if field is not None and field.comment:
            entry["comment"] = field.comment
        if field is not None and field.unit:
            entry["unit"] = field.unit
        yield entry


def _layout(leaf: Leaf) -> dict[str, int]:
    """Return the layout of a leaf's ``data``; item k starts at bit k * item_bits."""
    bits = leaf.primitive.bits
    return {"lanes": leaf.lanes, "item_bits": bits, "data_bits": leaf.lanes * bits}


def _constant(constant: Constant) -> dict[str, Any]:
    entry: dict[str, Any] = {
        "name": constant.name,
        "type": str(constant.type),
        "value": _plain(constant.value),
    }
    if constant.unit:
        entry["unit"] = constant.unit
    return entry


def _plain(value: object) -> object:
    """Return a value that JSON can represent: bytes, infinities and NaN become text."""
    if isinstance(value, bytes):
        return value.decode("utf-8", "backslashreplace")
    return str(value) if isinstance(value, float) and not isfinite(value) else value
