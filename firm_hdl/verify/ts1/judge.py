"""A definition, our reading of it, and what an oracle says: do they agree?"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from firm_hdl.errors import DefinitionError
from firm_hdl.identity import md5sum, proto, type_hash
from firm_hdl.model import Action, Interface, Message, Service
from firm_hdl.verify.processes import cpu_seconds
from firm_hdl.verify.records import OracleVerdict
from firm_hdl.verify.ts1.case import Case
from firm_hdl.verify.ts1.facts import Difference, Facts, count_facts, differences, structure
from firm_hdl.verify.ts1.known import known_key
from firm_hdl.verify.ts1.oracle import Accepted, Answer, Oracle, Refused
from firm_hdl.verify.ts1.universe import Universe
from firm_hdl.verify.verdict import Failed, KnownDifference, NotJudged, Passed, Verdict

__all__ = ["Judgement", "Outcome", "compare", "judge", "judge_case", "read"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """What came of one definition before one oracle.

    Attributes
    ----------
    oracle : str
    case : Case
    verdict : Verdict
        Cases are facts that were compared; 1 if one refuses.
    is_refused : bool
        Whether both refuse it.
    """

    oracle: str
    case: Case
    verdict: Verdict
    is_refused: bool = False

    @classmethod
    def of(cls, case: Case, said: OracleVerdict) -> Outcome:
        """Say it of a definition again."""
        return cls(
            oracle=said.oracle,
            case=case,
            verdict=said.verdict,
            is_refused=said.is_refused,
        )

    @property
    def said(self) -> OracleVerdict:
        """The same without the definition."""
        return OracleVerdict(oracle=self.oracle, verdict=self.verdict, is_refused=self.is_refused)


@dataclass(frozen=True, slots=True, kw_only=True)
class Judgement:
    """What came of one definition before all oracles.

    Attributes
    ----------
    said : tuple of OracleVerdict
        Of those that read definitions of its language.
    reading_seconds, asking_seconds : float
        Until we had read it; for the oracles and for comparing.
    cpu_seconds : float
        Of this process and of those of oracles.
    metrics : dict of str to float
        Figures of the definition.
    """

    said: tuple[OracleVerdict, ...] = ()
    reading_seconds: float = 0.0
    asking_seconds: float = 0.0
    cpu_seconds: float = 0.0
    metrics: dict[str, float] = field(default_factory=dict)


def judge_case(universe: Universe, oracles: Sequence[Oracle], case: Case) -> Judgement:
    """Compare our reading of one definition with those of oracles."""
    began, began_cpu = time.perf_counter(), cpu_seconds()
    ours = read(universe, case)
    had_read = time.perf_counter()
    said: list[OracleVerdict] = []
    elsewhere = 0.0
    for oracle in oracles:
        # Two of them may share a process, so it is the difference that is the one's own.
        before = oracle.cpu_seconds()
        try:
            said += [out.said for out in judge(universe, oracle, [case], lambda _: ours)]
        except Exception as error:  # As with ours: the next definition is to be judged, too.
            why = f"the oracle raised {type(error).__name__}: {error}"
            said.append(OracleVerdict(oracle=oracle.name, verdict=Failed((why,))))
        elsewhere += max(0.0, oracle.cpu_seconds() - before)
    return Judgement(
        said=tuple(said),
        reading_seconds=had_read - began,
        asking_seconds=time.perf_counter() - had_read,
        cpu_seconds=cpu_seconds() - began_cpu + elsewhere,
        metrics=_metrics(case, ours),
    )


def _metrics(case: Case, ours: Interface | Exception) -> dict[str, float]:
    found = {"characters": len(case.text)}
    if not isinstance(ours, Exception):
        found["fields"] = sum(len(message.fields) for message in ours.messages)
        found["depth"] = max(message.depth for message in ours.messages)
    return {name: float(value) for name, value in found.items()}


def judge(
    universe: Universe,
    oracle: Oracle,
    cases: Sequence[Case],
    ours: Callable[[Case], Interface | Exception] | None = None,
) -> Iterator[Outcome]:
    """Compare our reading of definitions with an oracle's, in order.

    Parameters
    ----------
    ours : callable or None
        Gives our reading of a case; `None`: as `read` does.
    """
    taken = [
        case
        for case in cases
        if case.language in oracle.languages.get(case.dialect, ())
        and (oracle.judges_changes or not case.is_changed)
    ]
    answers = list(oracle.judge(taken))
    if len(answers) != len(taken):
        # Nobody can say which answer is to which question.
        why = f"the oracle gave {len(answers)} answers to {len(taken)} questions"
        for case in taken:
            yield Outcome(oracle=oracle.name, case=case, verdict=Failed((why,)))
        return
    for case, answer in zip(taken, answers, strict=True):
        mine = read(universe, case) if ours is None else ours(case)
        yield compare(oracle, case, mine, answer, universe.show)


def read(universe: Universe, case: Case) -> Interface | Exception:
    """Read a definition as users of firm-hdl do."""
    try:
        return universe.interface(case)
    except Exception as error:  # Whatever it is, the next definition is to be judged, too.
        return error


def compare(
    oracle: Oracle,
    case: Case,
    ours: Interface | Exception,
    answer: Answer,
    show: Callable[[Case], str] = lambda case: "",
) -> Outcome:
    """Compare what we make of a definition with an oracle's answer.

    Parameters
    ----------
    ours : Message, Service, Action or Exception
        As `read` gives it.
    show : callable
        Prints a definition as ``firm-hdl show`` does.
    """
    is_refused = isinstance(ours, DefinitionError) and isinstance(answer, Refused)
    verdict = _verdict(oracle, case, ours, answer, show)
    return Outcome(oracle=oracle.name, case=case, verdict=verdict, is_refused=is_refused)


def _verdict(
    oracle: Oracle,
    case: Case,
    ours: Interface | Exception,
    answer: Answer,
    show: Callable[[Case], str],
) -> Verdict:
    if isinstance(answer, NotJudged):
        return answer
    if isinstance(ours, Exception) and not isinstance(ours, DefinitionError):
        return Failed((f"verdict: firm-hdl raised {type(ours).__name__}: {ours}",))
    cases = 1
    match ours, answer:
        case DefinitionError(), Refused():
            return Passed(cases)
        case DefinitionError(), Accepted():
            why = ours.diagnostics[0].message
            found = [Difference(path="verdict", ours=f"refuses: {why}", theirs="accepts")]
        case _, Refused(message):
            found = [Difference(path="verdict", ours="accepts", theirs=f"refuses: {message}")]
        case _, Accepted(facts):
            assert not isinstance(ours, Exception)
            cases = count_facts(facts)
            if not cases:
                return NotJudged("the oracle takes the definition, and says nothing of it")
            found = list(
                differences(_facts(ours, facts, oracle.alike(case), lambda: show(case)), facts)
            )
        case _:
            raise TypeError(f"An oracle must accept, refuse or not judge, not {answer!r}")
    keys = [known_key(oracle.name, case, ours, each) for each in found]
    unknown = [str(each) for each, key in zip(found, keys, strict=True) if key is None]
    if unknown:
        return Failed(tuple(unknown))
    names = tuple(dict.fromkeys(key for key in keys if key is not None))
    return KnownDifference(names, cases) if names else Passed(cases)


def _facts(
    ours: Interface, theirs: Facts, alike: Mapping[str, str], show: Callable[[], str]
) -> Facts:
    """Say of our model what the oracle says of its own."""
    makers: dict[str, Callable[[], Any]] = {
        "structure": lambda: structure(ours, alike),
        "names": lambda: [ours.name],
        "show": show,
        "md5": lambda: _md5(ours),
        "hash": lambda: {ours.name: type_hash(ours)},
        "proto": lambda: proto(ours),
    }
    return {key: _made(makers[key]) for key in theirs}


def _made(make: Callable[[], Any]) -> Any:
    try:
        return make()
    except Exception as error:  # It is ours, and a difference like any other.
        return f"raises {type(error).__name__}: {error}"


def _md5(interface: Interface) -> dict[str, str]:
    if isinstance(interface, Action):
        return {each.name: md5sum(each) for each in interface.messages}
    assert isinstance(interface, Message | Service)
    return {interface.name: md5sum(interface)}
