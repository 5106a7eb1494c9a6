"""``firm-hdl verify --sut``: judges client libraries and prints the differences."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import closing
from typing import Any

from firm_hdl.cases.values import shown
from firm_hdl.terminal import stage
from firm_hdl.verify.clients.finding import Finding
from firm_hdl.verify.clients.judge import LibraryResult
from firm_hdl.verify.clients.run import command_of, comparison_of, judge_types, reference_of
from firm_hdl.verify.clients.shrink import shrunk
from firm_hdl.verify.references.client import ClientMissingError, Refusal
from firm_hdl.verify.references.clients import CLIENTS, REFERENCES, close_clients, find_clients
from firm_hdl.verify.references.objects import full_text
from firm_hdl.verify.results.texts import clipped
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed
from firm_hdl.verify.systems.options import Request
from firm_hdl.verify.systems.system import Judged, wire_of
from firm_hdl.verify.systems.tasks import TypeUnderTest
from firm_hdl.wire import Wire

__all__ = ["run_sut"]

MOST_SHOWN = 5
"""This many kinds of difference per library are shrunk and shown, counted over all libraries."""

MOST_NAMED = 5
"""This many types are named with each kind of difference, and this many reasons per library."""

MOST_CHARACTERS = 400

VERDICT_LABELS = {
    Passed.name: "agree",
    KnownDifference.name: "known",
    Failed.name: "differ",
    NotJudged.name: "not judged",
}
"""The columns of the summary, in order: their verdicts and headings."""


def run_sut(tasks: Sequence[TypeUnderTest], options: Request) -> list[Judged]:
    """Judge libraries on types, print the results, and return them.

    Raises
    ------
    ClientMissingError
        If a library under test is not installed.
    """
    began = time.perf_counter()
    references = {name for wire in _wires(tasks, options) for name in REFERENCES[wire]}
    asked = [*options.libraries, *(name for name in CLIENTS if name in references)]
    versions, missing = find_clients(list(dict.fromkeys(asked)))
    for name in options.libraries:
        if name in missing:
            raise ClientMissingError(missing[name])
    installed = tuple(name for name in CLIENTS if name in references and name in versions)
    for line in _judges(_wires(tasks, options), options, versions, missing, installed):
        print(line)
    results: list[tuple[TypeUnderTest, LibraryResult]] = []
    with closing(judge_types(tasks, options, installed)) as run:
        for number, (task, found) in enumerate(run):
            results += [(task, result) for result in found]
            stage("verify, client libraries: types", number + 1, len(tasks))
    for line in _differences(results, options):
        print(line)
    for line in _summary([result for _, result in results], options, versions):
        print(line)
    close_clients()
    count = sum(isinstance(result.verdict, Failed) for _, result in results)
    print(f"{len(tasks)} types, {time.perf_counter() - began:.0f} s, {count} differ")
    return [
        Judged(
            what=f"{task.name} ({', '.join(task.same)}), {result.library}", verdict=result.verdict
        )
        for task, result in results
        if result.is_asked
    ]


def _wires(tasks: Sequence[TypeUnderTest], options: Request) -> list[Wire]:
    wires = {wire_of(task.distro, options.wire) for task in tasks}
    return [wire for wire in REFERENCES if wire in wires]


def _judges(
    wires: Sequence[Wire],
    options: Request,
    versions: dict[str, str],
    missing: dict[str, str],
    installed: Sequence[str],
) -> Iterator[str]:
    """Yield lines that say which reference judges which library."""
    for wire in wires:
        ros = REFERENCES[wire][0]
        if ros in missing:
            yield f"{ros}, which is ROS's own on {wire}, is not installed: {missing[ros]}"
        for library in options.libraries:
            if wire in CLIENTS[library].wires:
                judge = reference_of(library, wire, installed)
                by = f"{judge} {versions[judge]}" if judge else "no reference"
                yield f"{library} {versions[library]} on {wire}: judged by {by}"


def _differences(
    results: Sequence[tuple[TypeUnderTest, LibraryResult]], options: Request
) -> Iterator[str]:
    """Yield lines about unknown differences, the first ones with the smallest case."""
    shown_of: Counter[tuple[str, str]] = Counter()
    for task, result in sorted(results, key=lambda each: (each[1].library, each[1].type)):
        for finding in result.findings:
            key = result.library, finding.what
            shown_of[key] += 1
            head = f"DIFFERS {result.library}, {finding.what}: {result.type} ({task.distro})"
            again = command_of(options, task.distro, task.name, result.library)
            if shown_of[key] == 1 and len(shown_of) <= MOST_SHOWN * len(options.libraries):
                small = shrunk(finding, comparison_of(result, finding.wire).again)
                yield "\n".join([head, *described(small), f"    again: {again}"])
            elif shown_of[key] <= MOST_NAMED:
                yield f"{head}\n    again: {again}"
    for task, result in results:
        if isinstance(result.obstacle, Failed):
            why = result.obstacle.failures[0]
            yield f"FAIL {result.library}: {result.type} ({task.distro}): {why}"
    for (library, what), count in shown_of.items():
        if count > MOST_NAMED:
            yield f"DIFFERS {library}, {what}: and {count - MOST_NAMED} more types"


def described(finding: Finding) -> list[str]:
    """Describe a difference in lines: definition, value, packet, and both answers."""
    lines = [f"    {line}" for line in full_text(finding.message).splitlines()]
    lines.append(f"    value: {clipped(shown(finding.message, finding.value), MOST_CHARACTERS)}")
    if not finding.what.startswith("encode"):
        lines.append(f"    packet: {clipped(finding.packet.hex() or 'no bytes', MOST_CHARACTERS)}")
    for name, answer in (
        (finding.reference, finding.expected),
        (finding.library, finding.got),
    ):
        lines.append(f"    {name}: {clipped(_answer(finding, answer), MOST_CHARACTERS)}")
    return lines


def _answer(finding: Finding, answer: Any) -> str:
    if isinstance(answer, Refusal):
        return f"refuses: {answer}"
    if isinstance(answer, bytes):
        return answer.hex() or "no bytes"
    try:
        return shown(finding.message, answer) or "a message without fields"
    # A library may give values that do not fit the type, such as a text in place of a float.
    except Exception:
        return repr(answer)


def _summary(
    results: Sequence[LibraryResult], options: Request, versions: dict[str, str]
) -> Iterator[str]:
    head = "".join(f"{name:>11}" for name in VERDICT_LABELS.values())
    yield f"{'types':24}{head}{'comparisons':>13}"
    for library in options.libraries:
        own = [result for result in results if result.library == library]
        counts = Counter(result.verdict.name for result in own)
        row = "".join(f"{counts[name]:11}" for name in VERDICT_LABELS)
        total = sum(result.comparisons for result in own)
        yield f"{f'{library} {versions[library]}':24}{row}{total:13}"
    for library in options.libraries:
        known: Counter[str] = Counter()
        reasons: Counter[str] = Counter()
        for result in results:
            if result.library == library:
                known.update(result.known)
                if isinstance(result.verdict, NotJudged):
                    reasons[result.verdict.reason] += 1
        for key, count in sorted(known.items()):
            yield f"known, {library}: {key}: {count}"
        for reason, count in reasons.most_common(MOST_NAMED):
            yield f"not judged, {library}: {reason}: {count}"
        if left := reasons.most_common()[MOST_NAMED:]:
            yield f"not judged, {library}: other reasons: {sum(count for _, count in left)}"
