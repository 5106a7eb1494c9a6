"""Explanations of survivors. They name a survivor by its change, not by its line number."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import yaml

from tools.mutation.results import Record

__all__ = ["Explanation", "explain", "read_explanations"]

FILE = Path(__file__).parent / "survivors.yaml"
KINDS = {
    "equivalent": "no input shows a difference",
    "cost": "only time, memory or the size of circuits differ",
    "hint": "only the wording of an error message, or where it points, differs",
    "form": "the output reads differently, and means the same",
}


@dataclass(frozen=True, kw_only=True)
class Explanation:
    """The reason why no test notices a mutant, or why no test needs to.

    Attributes
    ----------
    path, scope, rule, old, new : str
        As in `Record`.
    kind : str
        One of `KINDS`.
    why : str
    """

    path: str
    scope: str
    rule: str
    old: str
    new: str
    kind: str
    why: str

    def fits(self, record: Record) -> bool:
        """Return whether the explanation is about this mutant."""
        return all(
            getattr(self, name) == getattr(record, name)
            for name in ("path", "scope", "rule", "old", "new")
        )


def read_explanations() -> list[Explanation]:
    """Read the explanations in `FILE`."""
    found = [Explanation(**entry) for entry in yaml.safe_load(FILE.read_text()) or []]
    unknown = {each.kind for each in found} - set(KINDS)
    if unknown:
        raise ValueError(f"Kinds of survivors must be of {sorted(KINDS)}, not {sorted(unknown)}")
    return found


def explain(record: Record, explanations: Iterable[Explanation]) -> Explanation | None:
    """Return the explanation of a mutant."""
    return next((each for each in explanations if each.fits(record)), None)
