"""TS2: checks plans, and compares them with golden plans, before there is any circuit.

Every plan must keep the invariants of plans and match its layout (:func:`firm_hdl.plan.check`). If
golden plans are given, those of the types that were asked for must mean the same as today's plans.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any

from firm_hdl.cases import NotJudgedError
from firm_hdl.cases.effort import digest, figures
from firm_hdl.errors import DefinitionError
from firm_hdl.export.build import BuildError, plan_of
from firm_hdl.model import Message
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES, check
from firm_hdl.verify.results.file import ResultsWriter
from firm_hdl.verify.results.records import Record, Test, clipped_verdict
from firm_hdl.verify.results.verdict import Counts, NotJudged
from firm_hdl.verify.systems.options import CaseOptions
from firm_hdl.verify.systems.system import (
    Made,
    Trial,
    TypesSystem,
    failure_of,
    run_and_record,
    run_tests,
    summary_of,
)
from firm_hdl.verify.systems.tasks import library_of
from firm_hdl.verify.ts2.golden import Golden, check_golden, read_golden
from firm_hdl.wire import Wire, lay_out, refusals

__all__ = ["Ts2", "check_plan"]

MOST_IN_A_SHARE = 16


def check_plan(message: Message, wire: Wire | None, trial: Trial) -> None:
    """Plan a type for the bus of a test, and check the plan. The plan is the only case."""
    if wrong := refusals(message):
        raise NotJudgedError(wrong[0].message)
    record = trial.record
    try:
        plan = plan_of(message, wire, record.test.bus_bytes, DEFAULT_MAX_MESSAGE_BYTES)
    except (BuildError, DefinitionError) as error:
        trial.failures.append(str(error))
        return
    trial.watch.enter("testing")
    trial.failures += check(plan, lay_out(message, wire))
    record.metrics = figures(message, plan, ())
    # The plan has no cases, so this figure means nothing.
    record.metrics.pop("case_bytes", None)
    record.shape = digest(plan)
    trial.judged = 1


class Ts2(TypesSystem):
    """Plans of types; a test is one plan, or one golden plan.

    * `request`: `paths`, `wire`, `widths`, `golden`, and `jobs` are used.

    Raises `UserError`: from `tests`, if the folder of golden plans cannot be used.
    """

    name = "ts2"
    passes = "plans are sound"

    @cached_property
    def tests(self) -> Sequence[Test]:
        """The tests of plans, and then the tests of golden plans."""
        return [*super().tests, *map(self._golden_test, self._goldens)]

    @property
    def options(self) -> Mapping[str, Any]:
        """The folder of golden plans."""
        return {"golden": self._request.golden}

    def records(self, writer: ResultsWriter | None) -> list[Record]:
        """Check all plans, and compare golden ones."""
        # Read the golden plans before any plan is made, so that errors show at once.
        goldens, request = self._goldens, self._request

        def checked(left: Sequence[Test]) -> Made:
            return run_tests(
                *(_checked, request, left, self._command), most=MOST_IN_A_SHARE, jobs=request.jobs
            )

        plans = run_and_record(super().tests, writer, checked, _lines_of, label="TS2", unit="plan")
        return plans + ([] if request.golden is None else self._compare(goldens, writer))

    def summary(self, records: Sequence[Record], seconds: float) -> Iterator[str]:
        """Yield lines about plans, and one about golden plans."""
        plans = len(self.tests) - len(self._goldens)
        yield from summary_of(records[:plans], self.passes, seconds)
        if self._request.golden is not None:
            differing = Counts.of(each.verdict for each in records[plans:]).failed
            yield f"golden plans: {len(self._goldens)} compared, {differing} differ"

    @cached_property
    def _goldens(self) -> list[Golden]:
        """The golden plans of the types that were asked for."""
        if self._request.golden is None:
            return []
        goldens = read_golden(self._request.golden)
        wanted = {(distro, _plain(task.name)) for task in self._tasks for distro in task.same}
        return [each for each in goldens if (each.distro, _plain(each.plan.message)) in wanted]

    def _compare(self, goldens: Sequence[Golden], writer: ResultsWriter | None) -> list[Record]:
        """Compare golden plans."""
        request = self._request
        tests = {self._golden_test(golden): golden for golden in goldens}

        def compared(left: Sequence[Test]) -> Made:
            chosen = [tests[test] for test in left]
            results = check_golden(chosen, request.paths, depends=request.depends)
            for test, result in zip(left, results, strict=True):
                verdict = clipped_verdict(result.verdict)
                command = self._command(test, golden=request.golden)
                yield [Record(test=test, verdict=verdict, command=command)]

        found = run_and_record(
            list(tests),
            writer,
            compared,
            lambda record: failure_of(str(tests[record.test].path), record),
            label="TS2",
            unit="golden plan",
        )
        whole = Test(system=self.name, distro="", type=f"golden plans of {request.golden}")
        none = NotJudged("none of them is of a type that was asked for")
        return found or [Record(test=whole, verdict=none)]

    def _golden_test(self, golden: Golden) -> Test:
        return Test(
            system=self.name,
            distro=golden.distro,
            type=golden.plan.message,
            wire=golden.plan.wire,
            bus_bytes=golden.plan.bus_bytes,
            options=f"golden={golden.path}",
        )


def _checked(options: CaseOptions, test: Test) -> Record:
    """Read, plan and check one type. An exception becomes the verdict."""
    with Trial.of(test) as trial:
        check_plan(library_of(test.distro, options).message(test.type), options.wire, trial)
    return trial.end()


def _lines_of(record: Record) -> Iterable[str]:
    test = record.test
    return failure_of(f"{test.type} ({test.distro}), {test.bus_bytes}-byte bus", record)


def _plain(name: str) -> str:
    """Return a name without ``msg``, so that names of ROS 1 and of rosbags are equal."""
    return name.replace("/msg/", "/")
