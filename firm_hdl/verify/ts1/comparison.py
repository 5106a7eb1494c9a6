"""Compares our reading of a definition with the answer of an oracle."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from firm_hdl.errors import DefinitionError
from firm_hdl.identity import md5sum, proto, type_hash
from firm_hdl.model import Action, Interface, Message, Service
from firm_hdl.verify.ts1.facts import Difference, Facts, count_facts, differences, structure
from firm_hdl.verify.ts1.oracles.oracle import Accepted, Answer, Refused

__all__ = ["Compared", "compared"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Compared:
    """The result of a comparison.

    Attributes
    ----------
    differences : tuple of Difference
    cases : int
        Number of facts that were compared; 1 if one of the two refuses; 0 if the oracle gives no
        facts.
    is_refused : bool
        Whether both refuse.
    """

    differences: tuple[Difference, ...] = ()
    cases: int = 1
    is_refused: bool = False

    @property
    def is_about_verdict(self) -> bool:
        """Whether one of the two refuses and the other does not."""
        return any(each.path == "verdict" for each in self.differences)


def compared(
    ours: Interface | Exception,
    answer: Answer,
    alike: Mapping[str, str],
    show: Callable[[], str],
    hashed: Interface | Exception | None = None,
) -> Compared:
    """Compare our reading with the answer of an oracle, which must not be `NotJudged`.

    Parameters
    ----------
    ours : Message, Service, Action or Exception
    answer : Accepted or Refused
    alike : mapping of str to str
        As for `structure`.
    show : callable
        Returns the definition as ``firm-hdl show`` prints it.
    hashed : Message, Service, Action or None
        The model whose type hashes are compared; `None`: `ours`.
    """
    match ours, answer:
        case DefinitionError(), Refused():
            return Compared(is_refused=True)
        case DefinitionError(), Accepted():
            why = ours.diagnostics[0].message
            return _verdicts(f"refuses: {why}", "accepts")
        case Exception(), Accepted() | Refused():
            return _verdicts(f"raised {type(ours).__name__}: {ours}", _answer_text(answer))
        case _, Refused():
            return _verdicts("accepts", _answer_text(answer))
        case _, Accepted(facts):
            assert not isinstance(ours, Exception)
            assert not isinstance(hashed, Exception)
            found = differences(_facts(ours, facts, alike, show, hashed or ours), facts)
            return Compared(differences=tuple(found), cases=count_facts(facts))
        case _:
            raise TypeError(f"An oracle must accept, refuse or not judge, not {answer!r}")


def _verdicts(ours: str, theirs: str) -> Compared:
    return Compared(differences=(Difference(path="verdict", ours=ours, theirs=theirs),))


def _answer_text(answer: Answer) -> str:
    return f"refuses: {answer.message}" if isinstance(answer, Refused) else "accepts"


def _facts(
    ours: Interface,
    theirs: Facts,
    alike: Mapping[str, str],
    show: Callable[[], str],
    hashed: Interface,
) -> Facts:
    """Return the same facts about our model as those that the oracle gives."""
    makers: dict[str, Callable[[], Any]] = {
        "structure": lambda: structure(ours, alike),
        "names": lambda: [ours.name],
        "show": show,
        "md5": lambda: _md5(ours),
        "hash": lambda: _hashes(hashed),
        "proto": lambda: proto(ours),
    }
    return {key: _made(makers[key]) for key in theirs}


def _made(make: Callable[[], Any]) -> Any:
    try:
        return make()
    except Exception as error:  # An error of our code is a difference, too.
        return f"raises {type(error).__name__}: {error}"


def _hashes(interface: Interface) -> dict[str, str]:
    """Return the type hashes of an interface, and of its messages and services."""
    services = interface.services if isinstance(interface, Action) else ()
    return {each.name: type_hash(each) for each in (interface, *interface.messages, *services)}


def _md5(interface: Interface) -> dict[str, str]:
    if isinstance(interface, Action):
        return {each.name: md5sum(each) for each in interface.messages}
    assert isinstance(interface, Message | Service)
    return {interface.name: md5sum(interface)}
