"""Our reading of a definition against the readings of oracles: do they agree?"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from firm_hdl.errors import DefinitionError, Diagnostic
from firm_hdl.model import Interface, closure
from firm_hdl.verify.results.records import OracleVerdict, Record, Test
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed, Verdict
from firm_hdl.verify.systems.system import Stopwatch
from firm_hdl.verify.ts1.facts import Difference, Facts, Said, count_facts, differences, facts_of
from firm_hdl.verify.ts1.known import KNOWN
from firm_hdl.verify.ts1.oracles.oracle import Answer, Oracle, Refused
from firm_hdl.verify.ts1.universe import DefinitionCase, Universe

__all__ = ["compare", "judge", "judge_case", "read", "record_of"]


def judge_case(
    universe: Universe, oracles: Sequence[Oracle], case: DefinitionCase, test: Test
) -> Record:
    """Compare our reading of one definition with those of oracles.

    In the record, ``generation`` is the time of our reading, and ``testing`` that of oracles and of
    comparisons. The processor time includes the oracles' processes.
    """
    watch = Stopwatch()
    ours = read(universe, case)
    watch.enter("testing")
    verdicts: list[OracleVerdict] = []
    oracle_cpu_seconds = 0.0
    for oracle in oracles:
        # Two oracles may share a process, so only the difference is the time of this oracle.
        before = oracle.cpu_seconds()
        verdict = judge(universe, oracle, case, ours)
        verdicts += [] if verdict is None else [verdict]
        oracle_cpu_seconds += max(0.0, oracle.cpu_seconds() - before)
    seconds, own_cpu_seconds = watch.stop()
    metrics = {"characters": float(len(case.text))}
    if not isinstance(ours, Exception):
        metrics["fields"] = float(sum(len(message.fields) for message in ours.messages))
        metrics["depth"] = float(max(message.depth for message in ours.messages))
    return replace(
        record_of(test, case.language, verdicts),
        seconds=seconds,
        cpu_seconds=own_cpu_seconds + oracle_cpu_seconds,
        metrics=metrics,
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


def read(universe: Universe, case: DefinitionCase) -> Interface | Exception:
    """Read a definition as users of firm-hdl do; return an exception instead of raising it."""
    try:
        return universe.interface(case)
    except Exception as error:  # The next definition is judged in any case.
        return error


def judge(
    universe: Universe,
    oracle: Oracle,
    case: DefinitionCase,
    ours: Interface | Exception | None = None,
) -> OracleVerdict | None:
    """Compare our reading of a definition with an oracle's; `None` if the oracle does not read it.

    * `ours`: our reading; `None`: `read` is called for it.
    """
    if case.language not in oracle.languages.get(case.dialect, ()):
        return None
    ours = read(universe, case) if ours is None else ours
    is_refused = False
    verdict: Verdict
    try:
        answer = oracle.judge(case)
        is_refused = isinstance(ours, DefinitionError) and isinstance(answer, Refused)
        verdict = compare(universe, oracle, case, ours, answer)
    except Exception as error:  # The other oracles and definitions are judged in any case.
        verdict = Failed((f"the oracle raised {type(error).__name__}: {error}",))
    return OracleVerdict(oracle=oracle.name, verdict=verdict, is_refused=is_refused)


def compare(
    universe: Universe,
    oracle: Oracle,
    case: DefinitionCase,
    ours: Interface | Exception,
    answer: Answer,
) -> Verdict:
    """Compare our reading of a definition with an oracle's answer.

    * `ours`: the result of `read`.
    """
    if isinstance(answer, NotJudged):
        return answer
    if isinstance(ours, DefinitionError):
        if isinstance(answer, Refused):
            return _both_refuse(oracle, case, answer)
        return _only_we_refuse(oracle, case, ours)
    if isinstance(ours, Exception):
        return Failed((f"verdict: firm-hdl raised {type(ours).__name__}: {ours}",))
    if isinstance(answer, Refused):
        return _only_they_refuse(universe, oracle, case, ours, answer)
    return _compare_facts(universe, oracle, case, ours, answer.facts)


def _both_refuse(oracle: Oracle, case: DefinitionCase, answer: Refused) -> Verdict:
    # An oracle that refuses the definition anyway does not confirm that it has a mistake.
    key = next(_keys_of_refusal(oracle, [case], answer), None)
    if key is None:
        return Passed(1)
    return NotJudged(f"both refuse, but the oracle refuses all such definitions: {key}")


def _only_we_refuse(oracle: Oracle, case: DefinitionCase, ours: DefinitionError) -> Verdict:
    keys: list[str] = []
    for problem in ours.diagnostics:
        # The problem may be in a definition that this one needs.
        about = replace(case, language="idl") if _is_in_idl(problem) else case
        rules = [rule for rule in KNOWN if rule.is_about(oracle.name, about)]
        key = next((rule.key for rule in rules if rule.explains(problem)), None)
        if key is None and _is_unread(oracle, case, ours):
            return NotJudged("firm-hdl refuses a file that it needs, and the oracle does not read")
        if key is None:
            what = Said(f"refuses: {problem.message}")
            return _failed([Difference(path="verdict", ours=what, theirs=Said("accepts"))], keys)
        keys.append(key)
    return KnownDifference(tuple(dict.fromkeys(keys)), 1)


def _is_unread(oracle: Oracle, case: DefinitionCase, ours: DefinitionError) -> bool:
    """Whether all that we refuse is in files whose language the oracle does not read."""
    return "idl" not in oracle.languages[case.dialect] and all(map(_is_in_idl, ours.diagnostics))


def _is_in_idl(problem: Diagnostic) -> bool:
    return problem.span is not None and problem.span.source.name.endswith(".idl")


def _only_they_refuse(
    universe: Universe, oracle: Oracle, case: DefinitionCase, ours: Interface, answer: Refused
) -> Verdict:
    cases = [case, *_needs(universe, ours)]
    if (key := next(_keys_of_refusal(oracle, cases, answer), None)) is not None:
        return KnownDifference((key,), 1)
    what = Said(f"refuses: {answer.message}")
    return _failed([Difference(path="verdict", ours=Said("accepts"), theirs=what)], ())


def _keys_of_refusal(
    oracle: Oracle, cases: Sequence[DefinitionCase], answer: Refused
) -> Iterator[str]:
    for rule in KNOWN:
        about = [case for case in cases if rule.is_about(oracle.name, case)]
        if rule.refuses(answer.message) and any(map(rule.is_in, about)):
            yield rule.key


def _compare_facts(
    universe: Universe, oracle: Oracle, case: DefinitionCase, ours: Interface, theirs: Facts
) -> Verdict:
    keys: dict[str, None] = {}
    read = facts_of(ours, theirs, oracle.alike(case), lambda: universe.show(case))
    found = list(differences(read, theirs))
    left = []
    cases = [case, *_needs(universe, ours)] if found else []
    for difference in found:
        for rule in KNOWN:
            if any(
                rule.is_about(oracle.name, each) and rule.has(difference, each) for each in cases
            ):
                keys[rule.key] = None
                break
        else:
            left.append(difference)
    count = count_facts(theirs)
    if left:
        return _failed(left, keys)
    if not count:
        return NotJudged("the oracle takes the definition, and says nothing of it")
    if keys:
        return KnownDifference(tuple(keys), max(1, count - len(found)))
    return Passed(count)


def _failed(found: Iterable[Difference], known: Iterable[str]) -> Failed:
    beside = ", ".join(known)
    return Failed(tuple(f"{each} (beside {beside})" if beside else str(each) for each in found))


def _needs(universe: Universe, interface: Interface) -> Iterator[DefinitionCase]:
    """Yield the definitions of the messages that a definition needs."""
    own = {message.name for message in interface.messages}
    for message in closure(interface.messages):
        # Builtin messages, such as time, have no package.
        package, _, base = message.name.rpartition("/")
        need = universe.message_case(package.partition("/")[0], base)
        if need is not None and message.name not in own:
            yield need
