"""Our reading of a definition against the readings of oracles: do they agree?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from firm_hdl.errors import DefinitionError
from firm_hdl.model import Interface
from firm_hdl.verify.results.records import OracleVerdict, Record, Test
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed, Verdict
from firm_hdl.verify.systems.system import Stopwatch
from firm_hdl.verify.ts1.case import DefinitionCase
from firm_hdl.verify.ts1.explain import Explainer
from firm_hdl.verify.ts1.oracles.oracle import Answer, Oracle
from firm_hdl.verify.ts1.universe import Universe

__all__ = ["compare", "judge", "judge_case", "read", "record_of"]


def judge_case(
    universe: Universe, oracles: Sequence[Oracle], case: DefinitionCase, test: Test
) -> Record:
    """Compare our reading of one definition with those of oracles.

    Returns
    -------
    Record
        ``generation`` is the time of our reading. ``testing`` is the time of the oracles and of
        comparisons.
        The processor time includes the oracles' processes.
    """
    watch = Stopwatch()
    ours = read(universe, case)
    watch.enter("testing")
    verdicts: list[OracleVerdict] = []
    oracle_cpu_seconds = 0.0
    for oracle in oracles:
        # Two oracles may share a process, so only the difference is the time of this oracle.
        before = oracle.cpu_seconds()
        try:
            verdict = judge(universe, oracle, case, ours)
        except Exception as error:  # The other oracles and definitions are judged in any case.
            verdict = _failed(oracle, f"the oracle raised {type(error).__name__}: {error}")
        verdicts += [] if verdict is None else [verdict]
        oracle_cpu_seconds += max(0.0, oracle.cpu_seconds() - before)
    seconds, own_cpu_seconds = watch.stop()
    record = record_of(test, case.language, verdicts)
    return replace(
        record,
        seconds=seconds,
        cpu_seconds=own_cpu_seconds + oracle_cpu_seconds,
        metrics=_metrics(case, ours),
    )


def record_of(test: Test, language: str, verdicts: Sequence[OracleVerdict]) -> Record:
    """Return the record of a test from the oracles' verdicts on a definition in some language."""
    known = [
        f"known difference from {each.oracle}: {key}"
        for each in verdicts
        if isinstance(each.verdict, KnownDifference)
        for key in each.verdict.keys
    ]
    verdict = _common_verdict(language, verdicts)
    return Record(test=test, verdict=verdict, note="; ".join(known), verdicts=tuple(verdicts))


def _common_verdict(language: str, verdicts: Sequence[OracleVerdict]) -> Verdict:
    """Return the common verdict. Oracles that did not judge count only if no oracle judged."""
    details: dict[type[Verdict], list[str]] = {}
    for each in verdicts:
        lines = details.setdefault(type(each.verdict), [])
        lines += [f"{each.oracle}: {detail}" for detail in each.verdict.details]
    if failures := details.get(Failed):
        return Failed(tuple(failures))
    found = [v.verdict for v in verdicts if isinstance(v.verdict, Passed | KnownDifference)]
    cases = sum(each.cases for each in found)
    if keys := tuple(dict.fromkeys(key for each in found for key in each.details)):
        return KnownDifference(keys, cases)
    if cases:
        return Passed(cases)
    reasons = details.get(NotJudged) or [f"no oracle that was asked reads .{language} files"]
    return NotJudged("; ".join(reasons))


def _metrics(case: DefinitionCase, ours: Interface | Exception) -> dict[str, float]:
    found = {"characters": len(case.text)}
    if not isinstance(ours, Exception):
        found["fields"] = sum(len(message.fields) for message in ours.messages)
        found["depth"] = max(message.depth for message in ours.messages)
    return {name: float(value) for name, value in found.items()}


def judge(
    universe: Universe,
    oracle: Oracle,
    case: DefinitionCase,
    ours: Interface | Exception | None = None,
) -> OracleVerdict | None:
    """Compare our reading of a definition with an oracle's; `None` if the oracle does not read it.

    Parameters
    ----------
    ours : Message, Service, Action, Exception or None
        Our reading; `None`: `read` is called for it.
    """
    if case.language not in oracle.languages.get(case.dialect, ()):
        return None
    if case.is_changed and not oracle.judges_changes:
        return None
    answers = list(oracle.judge([case]))
    if len(answers) != 1:
        return _failed(oracle, f"the oracle gave {len(answers)} answers to 1 question")
    ours = read(universe, case) if ours is None else ours
    return compare(oracle, case, ours, answers[0], universe)


def _failed(oracle: Oracle, why: str) -> OracleVerdict:
    return OracleVerdict(oracle=oracle.name, verdict=Failed((why,)))


def read(universe: Universe, case: DefinitionCase) -> Interface | Exception:
    """Read a definition as users of firm-hdl do; return an exception instead of raising it."""
    try:
        return universe.interface(case)
    except Exception as error:  # The next definition is judged in any case.
        return error


def compare(
    oracle: Oracle,
    case: DefinitionCase,
    ours: Interface | Exception,
    answer: Answer,
    universe: Universe | None = None,
) -> OracleVerdict:
    """Compare our reading of a definition with an oracle's answer.

    Parameters
    ----------
    ours : Message, Service, Action or Exception
        The result of `read`.
    universe : Universe or None
        The definitions of the run; `None`: no difference is known.
    """
    is_refused = False
    verdict: Verdict
    if isinstance(answer, NotJudged):
        verdict = answer
    elif isinstance(ours, Exception) and not isinstance(ours, DefinitionError):
        verdict = Failed((f"verdict: firm-hdl raised {type(ours).__name__}: {ours}",))
    else:
        verdict, is_refused = Explainer(universe, oracle, case, ours, answer, read).verdict()
    return OracleVerdict(oracle=oracle.name, verdict=verdict, is_refused=is_refused)
