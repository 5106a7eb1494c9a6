"""What is proved: scenes, their claims, and a bug for each claim that it has to find."""

from __future__ import annotations

from dataclasses import dataclass

from lab.formal.bugs import Bug
from lab.formal.scene import Build
from lab.formal.solve import Method

__all__ = ["Claim", "Proof", "Study"]


@dataclass(frozen=True, slots=True)
class Claim:
    """A claim of a scene.

    Attributes
    ----------
    name : str
        As in the scene.
    bug : Bug
        What it has to find.
    method : "PDR", "BMC" or "induction"
    depth : int
        Cycles of `BMC`.
    found_within : int
        Cycles in which the bug has to be found, if the method is not "BMC"; else it is `depth`.
    """

    name: str
    bug: Bug
    method: Method = "PDR"
    depth: int = 0
    found_within: int = 20

    @property
    def reach(self) -> str:
        """For how many cycles the claim is proved."""
        return str(self.depth) if self.method == "BMC" else "unbounded"


@dataclass(frozen=True, slots=True)
class Study:
    """A scene with its claims.

    Attributes
    ----------
    name : str
        Short, for the command line.
    block : str
        What is proved, for the table: the block with its parameters.
    build : callable
    claims : tuple of Claim
        All claims of the scene.
    """

    name: str
    block: str
    build: Build
    claims: tuple[Claim, ...]


@dataclass(frozen=True, slots=True)
class Proof:
    """A claim of a study; `key` is its name on the command line."""

    study: Study
    claim: Claim

    @property
    def key(self) -> str:
        """Name of the study, a slash, and the name of the claim with hyphens."""
        return f"{self.study.name}/{self.claim.name.replace(' ', '-')}"
