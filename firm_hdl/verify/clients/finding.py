"""A difference between a client library and its reference, and known divergences."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Literal

from firm_hdl.cases.values import Change, Plain
from firm_hdl.model import Message
from firm_hdl.verify.references.client import Refusal
from firm_hdl.wire import Wire

__all__ = ["Finding", "KnownDivergence"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """One difference.

    Attributes
    ----------
    library, reference : str
    wire : Wire
    what : str
        ``encode``, ``decode``, the name of an unusual case of a packet, or ``encode`` and that of
        a value.
    message : Message
    value : Plain
        The value to write, or the value of the packet.
    packet : bytes
        The packet to read.
    expected, got : bytes, Plain or Refusal
        The answers of the reference and of the library.
    """

    library: str
    reference: str
    wire: Wire
    what: str
    message: Message
    value: Plain = field(repr=False)
    packet: bytes = field(repr=False)
    expected: Any = field(repr=False)
    got: Any = field(repr=False)

    def answers(self, library: str) -> tuple[Any, Any]:
        """Return the answer of one of the two libraries, and the answer of the other."""
        if library == self.library:
            return self.got, self.expected
        return self.expected, self.got


@dataclass(frozen=True, slots=True, kw_only=True)
class KnownDivergence:
    """One known difference.

    Attributes
    ----------
    key : str
        The name of the difference, here and in docs/reference/divergences.md.
    libraries : tuple of str
        Libraries that differ from ROS.
    wires : str
        ``ros1``, ``cdr``, or both.
    text : str
        What the libraries do, in one sentence.
    take_out : callable or None
        Removes the difference from a value to write.
    same : callable or None
        Removes the difference from a value that was read.
    case_names : tuple of str
        Unusual cases that this divergence is about.
    answer : "takes", "refuses" or None
        What the libraries do with these cases while the other side does the opposite. `None`:
        both sides take them.
    """

    key: str
    libraries: tuple[str, ...]
    wires: str
    text: str
    take_out: Change | None = None
    same: Change | None = None
    case_names: tuple[str, ...] = ()
    answer: Literal["takes", "refuses"] | None = None

    def is_about(self, finding: Finding) -> str | None:
        """Return the library of a finding that this difference is about; `None` if neither is."""
        return self.affected_library(finding.wire, finding.library, finding.reference)

    def affected_library(self, wire: Wire, *libraries: str) -> str | None:
        """Return the first library that this difference is about on a wire; `None` if none is."""
        if wire not in self.wires.split():
            return None
        return next((name for name in libraries if name in self.libraries), None)

    def explains_answer(self, finding: Finding) -> bool:
        """Whether this difference explains which side takes an unusual packet or value."""
        name = self.is_about(finding)
        if name is None or finding.what not in self.case_names:
            return False
        mine, other = (isinstance(each, Refusal) for each in finding.answers(name))
        return (mine, other) == {
            "takes": (False, True),
            "refuses": (True, False),
            None: (False, False),
        }[self.answer]
