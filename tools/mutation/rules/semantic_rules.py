"""Faults that an engineer might make, besides the operators and numbers of `python_rules`."""

from __future__ import annotations

from tools.mutation.mutants import Change
from tools.mutation.rules import clause_rules, neighbour_rules, order_rules, state_rules
from tools.mutation.rules.index import Index, index_of
from tools.mutation.rules.source import Source

__all__ = ["changes"]

RULES = (
    *order_rules.RULES,
    *clause_rules.RULES,
    *state_rules.RULES,
    *neighbour_rules.RULES,
)


def changes(text: str, index: Index | None = None) -> list[Change]:
    """Return all changes of a module, in order; some of them may be no faults.

    Parameters
    ----------
    index : Index, optional
        Declarations of the whole program. Without it, only those of the module are known.
    """
    source = Source(text)
    index = index_of([text]) if index is None else index
    found = {change for rule in RULES for change in rule(source, index)}
    return sorted(found, key=lambda each: (each.start, each.end, each.rule, each.new))
