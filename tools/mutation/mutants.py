"""Mutants, and keys that identify them even if lines move."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

__all__ = ["Change", "Mutant", "Place", "identify"]


@dataclass(frozen=True)
class Change:
    """A place of a text, and the new text for that place.

    Attributes
    ----------
    start, end : int
        Start and end of the text that is replaced, in characters.
    new : str
        The new text.
    rule : str
        The name of the rule that made the change.
    scope : str
        The function, class or grammar rule around the place.
    """

    start: int
    end: int
    new: str
    rule: str
    scope: str

    def apply(self, text: str) -> str:
        """Return the text with the change."""
        return text[: self.start] + self.new + text[self.end :]


@dataclass(frozen=True)
class Place:
    """Whole lines before and after a change, without indentation."""

    old: str
    new: str

    @classmethod
    def of(cls, text: str, change: Change) -> Place:
        """Return the lines that a change touches."""
        first = text.rfind("\n", 0, change.start) + 1
        last = text.find("\n", change.end)
        last = len(text) if last < 0 else last
        old = text[first:last]
        new = text[first : change.start] + change.new + text[change.end : last]
        return cls(old=_shortened(old), new=_shortened(new))


def _shortened(lines: str) -> str:
    return "\n".join(line.strip() for line in lines.splitlines() if line.strip())


@dataclass(frozen=True)
class Mutant:
    """A change of a file of the repository.

    Attributes
    ----------
    path : str
        The file, from the root of the repository.
    target : str
        The part of the program that the file belongs to.
    line : int
        Line where the change starts.
    change : Change
    place : Place
    number : int
        Number of the change among changes that look the same, from 0.
    """

    path: str
    target: str
    line: int
    change: Change
    place: Place
    number: int

    @property
    def key(self) -> str:
        """A name for the mutant by its content, which does not depend on other lines."""
        what = (
            self.path,
            self.change.scope,
            self.change.rule,
            self.place.old,
            self.place.new,
            str(self.number),
        )
        return hashlib.sha256("\0".join(what).encode()).hexdigest()[:12]


def identify(path: str, target: str, text: str, changes: Iterable[Change]) -> list[Mutant]:
    """Make mutants of changes of one file."""
    seen: Counter[tuple[str, str, Place]] = Counter()
    mutants: list[Mutant] = []
    for change in changes:
        place = Place.of(text, change)
        look = (change.scope, change.rule, place)
        line = text.count("\n", 0, change.start) + 1
        mutants.append(
            Mutant(
                path=path, target=target, line=line, change=change, place=place, number=seen[look]
            )
        )
        seen[look] += 1
    return mutants
