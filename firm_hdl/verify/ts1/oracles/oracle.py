"""What an oracle is: somebody else's reader of definitions."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, TypeAlias

from firm_hdl.model import Dialect
from firm_hdl.verify.results.verdict import NotJudged
from firm_hdl.verify.ts1.case import DefinitionCase
from firm_hdl.verify.ts1.facts import Facts
from firm_hdl.verify.ts1.universe import Universe

__all__ = ["Accepted", "Answer", "NotJudged", "Oracle", "Refused"]


@dataclass(frozen=True, slots=True)
class Accepted:
    """The oracle takes the definition, and this is what it knows of it."""

    facts: Facts


@dataclass(frozen=True, slots=True)
class Refused:
    """The oracle refuses the definition, or one that it depends on."""

    message: str


Answer: TypeAlias = "Accepted | Refused | NotJudged"


class Oracle(ABC):
    """A reader of definitions that shares no code with ours.

    To add one, see ``docs/contributing.md``.

    Attributes
    ----------
    name : str
    languages : mapping of str to set of str
        What it can read, for each dialect: ``msg``, ``srv``, ``action``, ``idl``.
    judges_changes : bool
        Whether its word counts on texts that nobody wrote, and that are mostly wrong.
    changes_needs : bool
        Whether `judge_changed` changes the definitions that a definition needs, too.
    """

    name: ClassVar[str]
    languages: ClassVar[Mapping[Dialect, frozenset[str]]]
    judges_changes: ClassVar[bool] = True
    changes_needs: ClassVar[bool] = False

    def __init__(self, universe: Universe) -> None:
        self.universe = universe

    @abstractmethod
    def missing(self) -> str | None:
        """Tell why the oracle cannot be asked here; `None` if it can."""

    @abstractmethod
    def judge(self, cases: Sequence[DefinitionCase]) -> Iterator[Answer]:
        """Answer for each case, in order. All are of languages that it can read."""

    def judge_changed(
        self, case: DefinitionCase, change: Callable[[DefinitionCase], DefinitionCase]
    ) -> Answer:
        """Answer for a case with its text changed."""
        (answer,) = self.judge([change(case)])
        return answer

    def alike(self, case: DefinitionCase) -> Mapping[str, str]:
        """Name the primitives that it cannot tell from others in a case, and those others."""
        return {}

    def version(self) -> str:
        """Tell which release answers, as far as it is known."""
        return ""

    def cpu_seconds(self) -> float:
        """Tell how much processor time a process of its own has used."""
        return 0.0

    def close(self) -> None:  # noqa: B027 - most have nothing to do.
        """End what the oracle has started."""
