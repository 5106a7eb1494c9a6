"""A definition, our reading of it, and what an oracle says: do they agree?"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from firm_hdl.errors import DefinitionError
from firm_hdl.jobs.processes import cpu_seconds
from firm_hdl.model import Interface
from firm_hdl.verify.results.records import OracleVerdict
from firm_hdl.verify.results.verdict import Failed, NotJudged, Verdict
from firm_hdl.verify.ts1.again import Again
from firm_hdl.verify.ts1.case import DefinitionCase
from firm_hdl.verify.ts1.oracles.oracle import Answer, Oracle
from firm_hdl.verify.ts1.universe import Universe

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
    case: DefinitionCase
    verdict: Verdict
    is_refused: bool = False

    @classmethod
    def of(cls, case: DefinitionCase, said: OracleVerdict) -> Outcome:
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
    metrics: Mapping[str, float] = field(default_factory=dict)


def judge_case(universe: Universe, oracles: Sequence[Oracle], case: DefinitionCase) -> Judgement:
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


def _metrics(case: DefinitionCase, ours: Interface | Exception) -> dict[str, float]:
    found = {"characters": len(case.text)}
    if not isinstance(ours, Exception):
        found["fields"] = sum(len(message.fields) for message in ours.messages)
        found["depth"] = max(message.depth for message in ours.messages)
    return {name: float(value) for name, value in found.items()}


def judge(
    universe: Universe,
    oracle: Oracle,
    cases: Sequence[DefinitionCase],
    ours: Callable[[DefinitionCase], Interface | Exception] | None = None,
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
        yield compare(oracle, case, mine, answer, universe)


def read(universe: Universe, case: DefinitionCase) -> Interface | Exception:
    """Read a definition as users of firm-hdl do."""
    try:
        return universe.interface(case)
    except Exception as error:  # Whatever it is, the next definition is to be judged, too.
        return error


def compare(
    oracle: Oracle,
    case: DefinitionCase,
    ours: Interface | Exception,
    answer: Answer,
    universe: Universe | None = None,
) -> Outcome:
    """Compare what we make of a definition with an oracle's answer.

    Parameters
    ----------
    ours : Message, Service, Action or Exception
        As `read` gives it.
    universe : Universe or None
        Where the definition is; `None`: no difference is known.
    """
    is_refused = False
    verdict: Verdict
    if isinstance(answer, NotJudged):
        verdict = answer
    elif isinstance(ours, Exception) and not isinstance(ours, DefinitionError):
        verdict = Failed((f"verdict: firm-hdl raised {type(ours).__name__}: {ours}",))
    else:
        verdict, is_refused = Again(universe, oracle, case, ours, answer, read).verdict()
    return Outcome(oracle=oracle.name, case=case, verdict=verdict, is_refused=is_refused)
