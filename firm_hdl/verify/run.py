"""A run of ``firm-hdl verify``: test systems, or client libraries under test.

A test system is an entry of :data:`SYSTEMS`: a function that makes its systems for a workload. TS1
has one for each distribution. All systems write to one file of results, which lists the planned
tests of all systems first.

A type that was asked for by name has to be judged. If all types are tested, those that no oracle
can judge are listed and do not count. A run that judged no test fails.

From the command to the exit status, with TS3 as the example::

    command.run_verify                  arguments become a Request
        command.resolve                     and this a Workload: the types to test
        run.run_workload
            System.run                      for each system
                Ts3.records
                    system.run_and_record       the tests that the file of results lacks
                        system.run_tests            in processes (jobs.executors.run_each)
                            acceptance.accepted         one test: begins a Trial
                                acceptance.accept_message
                                    Acceptance.check_circuit, compare.run_differences
                                Trial.end
                system.counted
                system.summary_of
            run.failure

A verdict is made in `Trial.verdict`, of what the test added to its trial. It may change once, in
`records.settled`, which `system.counted` calls: a type whose circuit was simulated for another type
has the verdict of that one. `failure` decides the exit status.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from contextlib import ExitStack

from firm_hdl.jobs.processes import unwound_when_terminated
from firm_hdl.verify.board.system import Boards
from firm_hdl.verify.clients.system import Libraries
from firm_hdl.verify.command import Workload
from firm_hdl.verify.generated_benches import Benches
from firm_hdl.verify.report.formats import write_report
from firm_hdl.verify.results.file import (
    ResultsWriter,
    code_digest,
    environment,
    inputs_digest,
)
from firm_hdl.verify.results.records import Record
from firm_hdl.verify.results.verdict import Failed, NotJudged
from firm_hdl.verify.systems.options import Request
from firm_hdl.verify.systems.system import System
from firm_hdl.verify.ts1.system import Ts1, each_distro
from firm_hdl.verify.ts2.system import Ts2
from firm_hdl.verify.ts3.system import Ts3

__all__ = ["SYSTEMS", "failure", "run_workload"]

_FAILS = ", so the run fails"


def run_workload(work: Workload) -> int:
    """Run the tests of a workload, print a summary, and return the exit status.

    Raises `UserError` if a tool, a library or a file cannot be used. Raises `DefinitionError` if a
    definition that is named cannot be used. Without names, the usable types are tested, and the
    errors in the others are printed at the end.
    """
    request = work.request
    with unwound_when_terminated(), ExitStack() as stack:
        systems: Sequence[System] = [Libraries(work.tasks, request)]
        if not request.libraries:
            systems = [each for name in request.systems for each in SYSTEMS[name](work)]
        for system in systems:
            stack.enter_context(system)
        writer = None
        if request.results is not None:
            writer = stack.enter_context(_writer(work, request.results, systems))
        # All systems run, even if an earlier one has failures.
        found = [each for system in systems for each in system.run(writer)]
        why = failure(found, request, len(work.problems))
        if writer is not None:
            writer.conclude(why)
    for line in concluded(found, request):
        print(line)
    if request.report is not None and request.results is not None:
        write_report([request.results], request.report)
        print(f"wrote   {request.report}")
    for problem in work.problems:
        print(problem, file=sys.stderr)
    return 1 if why else 0


def failure(found: Sequence[Record], request: Request, refused: int = 0) -> str:
    """Return why a run is no success; empty if no test failed, and enough was judged.

    * `request`: if the user named the types, every test has to be judged; otherwise, one.
    * `refused`: definitions with errors.
    """
    failed = [each.test.title for each in found if isinstance(each.verdict, Failed)]
    reasons = [f"{len(failed)} of {len(found)} tests failed, such as {failed[0]}"] if failed else []
    if _is_unjudged(found, request):
        reasons.append(concluded(found, request)[-1].removesuffix(_FAILS))
    if refused:
        wrong = "definition is" if refused == 1 else "definitions are"
        reasons.append(f"{refused} {wrong} refused")
    return "; ".join(reasons)


def _is_unjudged(found: Sequence[Record], request: Request) -> bool:
    """Whether a run fails because of what was not judged."""
    silent = sum(isinstance(each.verdict, NotJudged) for each in found)
    return silent == len(found) or (request.is_named and silent > 0)


def concluded(found: Sequence[Record], request: Request) -> list[str]:
    """Return lines for the end of a run: the tests that were not judged, and the consequence."""
    not_judged = [
        (each.test.title, each.verdict) for each in found if isinstance(each.verdict, NotJudged)
    ]
    lines = [f"not judged: {what}: {verdict.reason}" for what, verdict in not_judged]
    if len(not_judged) == len(found):
        return [*lines, f"no test was judged{_FAILS}"]
    if not_judged:
        were = "was" if len(not_judged) == 1 else "were"
        is_wrong = _is_unjudged(found, request)
        meaning = f", although named{_FAILS}" if is_wrong else ""
        lines.append(f"{len(not_judged)} of {len(found)} tests {were} not judged{meaning}")
    return lines


def _writer(work: Workload, path: str, systems: Sequence[System]) -> ResultsWriter:
    """Open a new file of results, or one to continue."""
    request = work.request
    files = filter(None, [request.golden, request.node])
    read = [*request.paths, *request.depends, *request.bags, *files]
    options = {**request.kept, "code": code_digest(), "inputs": inputs_digest(read)}
    for system in systems:
        options |= system.options
    session = environment()
    if problems := work.problems:
        # TS2, TS3 and the benches have no tests of these definitions, so the file names them here.
        session["definitions that are refused"] = f"{len(problems)}: {min(problems)}"
    return ResultsWriter(
        path,
        options=options,
        planned=[test for system in systems for test in system.tests],
        session=session,
    )


def _boards(work: Workload) -> Sequence[System]:
    assert work.board is not None
    return [Boards(work.board, work.request)]


SYSTEMS: dict[str, Callable[[Workload], Sequence[System]]] = {
    "ts1": lambda work: [Ts1(each) for each in each_distro(work.request)],
    "ts2": lambda work: [Ts2(work.tasks, work.request)],
    "ts3": lambda work: [Ts3(work.tasks, work.request)],
    "bench": lambda work: [Benches(work.tasks, work.request)],
    "board": _boards,
}
"""Test systems by the names that ``--systems`` takes."""
