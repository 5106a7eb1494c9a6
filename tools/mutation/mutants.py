"""What a mutant is, and how it is told from others when lines move."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

__all__ = ["Change", "Mutant", "Place", "identify"]


@dataclass(frozen=True)
class Change:
    """A place of a text, and what stands there instead.

    Attributes
    ----------
    start, end : int
        Where the text is that goes, in characters.
    new : str
        The text that comes.
    rule : str
        The name of the rule that made the change.
    scope : str
        The function, class or grammar rule around it.
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
        Where the change starts.
    change : Change
    place : Place
    number : int
        Which of several changes that look the same, from 0.
    """

    path: str
    target: str
    line: int
    change: Change
    place: Place
    number: int

    @property
    def key(self) -> str:
        """Name the mutant by its content, so that other lines may come and go."""
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
