"""Identifiers for the leaves, the states and the transfers of a plan, in the circuit's text."""

from __future__ import annotations

from collections.abc import Iterable

from firm_hdl.names.identifiers import first_free, plain
from firm_hdl.plan.tree import Plan, Run, Step

__all__ = ["leaf_names", "state_names", "unique"]


def leaf_names(plan: Plan) -> tuple[str, ...]:
    """Return an identifier for each leaf, such as ``header_frame_id_length``."""
    return unique("_".join(leaf.path) for leaf in plan.leaves)


def state_names(plan: Plan) -> tuple[str, ...]:
    """Return an identifier for each step: its length, or else the first leaf that it has bytes of.

    A step that only takes the rest of a run has the suffix ``_rest``.
    """
    leaves = leaf_names(plan)
    return unique(_wanted(plan, leaves, step) for step in plan.steps)


def _wanted(plan: Plan, leaves: tuple[str, ...], step: Step | Run) -> str:
    if isinstance(step, Run):
        return leaves[step.leaf]
    if step.parts:
        lengths = (part for part in step.parts if plan.leaves[part.leaf].kind == "length")
        return leaves[next(lengths, step.parts[0]).leaf]
    if step.rest is not None:
        return f"{leaves[step.rest]}_rest"
    return "encapsulation" if step.bytes else "nothing"


def unique(wanted: Iterable[str]) -> tuple[str, ...]:
    """Make names identifiers of VHDL and Verilog; equal ones get numbers, regardless of case."""
    taken: set[str] = set()
    names = []
    for text in wanted:
        name = first_free(plain(text, "n"), taken)
        taken.add(name.lower())
        names.append(name)
    return tuple(names)
