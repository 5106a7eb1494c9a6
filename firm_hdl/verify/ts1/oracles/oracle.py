"""The interface of oracles, which are readers of definitions by other projects."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, TypeAlias

from firm_hdl.model import Dialect
from firm_hdl.verify.results.verdict import NotJudged
from firm_hdl.verify.ts1.facts import Facts
from firm_hdl.verify.ts1.universe import DefinitionCase, Universe

__all__ = ["Accepted", "Answer", "NotJudged", "Oracle", "Refused"]


@dataclass(frozen=True, slots=True)
class Accepted:
    """The oracle accepts the definition; `facts` are what it knows about the definition."""

    facts: Facts


@dataclass(frozen=True, slots=True)
class Refused:
    """The oracle refuses the definition, or one that it depends on."""

    message: str


Answer: TypeAlias = "Accepted | Refused | NotJudged"


class Oracle(ABC):
    """A reader of definitions that shares no code with ours."""

    name: ClassVar[str]
    # The languages that it reads, for each dialect: `msg`, `srv`, `action`, `idl`.
    languages: ClassVar[Mapping[Dialect, frozenset[str]]]

    def __init__(self, universe: Universe) -> None:
        self.universe = universe

    @abstractmethod
    def missing(self) -> str | None:
        """Return why the oracle cannot be asked here; `None` if it can."""

    @abstractmethod
    def judge(self, case: DefinitionCase) -> Answer:
        """Return the answer to a case in one of its languages."""

    def alike(self, case: DefinitionCase) -> Mapping[str, str]:
        """Return the primitives that it cannot tell from others in a case, with the others."""
        return {}

    def version(self) -> str:
        """Return the release of the oracle; empty if it is unknown."""
        return ""

    def cpu_seconds(self) -> float:
        """Return the processor time of the oracle's own process; 0 if it has none."""
        return 0.0

    def close(self) -> None:  # noqa: B027 - most have nothing to do.
        """End the processes that the oracle has started."""
