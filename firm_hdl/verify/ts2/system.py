"""TS2: what a converter is meant to do, checked and compared before there is any circuit.

Every plan must keep the invariants of plans and be one of its layout (:func:`firm_hdl.plan.check`),
and its printed form must say all of it: read back, it is the same plan. Where golden plans are
given, those of the types that were asked for must mean the same as today's.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

from tqdm import tqdm

from firm_hdl.errors import DefinitionError, described
from firm_hdl.export.build import BuildError, plan_of
from firm_hdl.jobs.executors import PROCESSES
from firm_hdl.jobs.processes import cpu_seconds
from firm_hdl.model import Message
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES, check, from_yaml, to_yaml
from firm_hdl.verify.cases.figures import digest, figures
from firm_hdl.verify.results.records import Record, Seconds, Test, clipped_verdict
from firm_hdl.verify.results.verdict import Failed, NotJudged, Passed, Verdict
from firm_hdl.verify.systems.again import command_again
from firm_hdl.verify.systems.libraries import library_of
from firm_hdl.verify.systems.system import (
    Judged,
    Recorder,
    System,
    judged,
    run_shares,
    shares_of,
    wire_of,
)
from firm_hdl.verify.systems.tasks import TypeUnderTest
from firm_hdl.verify.ts2.golden import Checked, Golden, check_golden, read_golden
from firm_hdl.wire import Wire, lay_out, refusals

__all__ = ["Ts2", "Ts2Options", "check_plan"]

YAML_STEPS = 2000
"""Longer plans are not printed and read back: it takes a second per some thousand steps."""

MOST_IN_A_SHARE = 16


@dataclass(frozen=True, slots=True, kw_only=True)
class Invariants:
    """What was found out about the plan of a type.

    Attributes
    ----------
    verdict : Verdict
        A case is a plan.
    shape : str
        Digest of the plan without names.
    metrics : dict of str to float
        Figures of the type and of its plan.
    planning_seconds, checking_seconds, cpu_seconds : float
        From the definition to the plan; for everything that is checked; of the processor.
    """

    verdict: Verdict
    shape: str = ""
    metrics: Mapping[str, float] = field(default_factory=dict)
    planning_seconds: float = 0.0
    checking_seconds: float = 0.0
    cpu_seconds: float = 0.0


def check_plan(message: Message, wire: Wire | None, bus_bytes: int) -> Invariants:
    """Plan a type, and check the plan. Nothing is raised for what is wrong with it."""
    if wrong := refusals(message):
        return Invariants(verdict=NotJudged(wrong[0].message))
    began = time.perf_counter()
    try:
        plan = plan_of(message, wire, bus_bytes, DEFAULT_MAX_MESSAGE_BYTES)
    except (BuildError, DefinitionError) as error:
        return Invariants(verdict=Failed((str(error),)))
    planned = time.perf_counter()
    problems = list(check(plan, lay_out(message, wire)))
    if len(plan.steps) <= YAML_STEPS and from_yaml(to_yaml(plan)) != plan:
        problems.append("the plan in YAML, read back, is another one")
    checked = time.perf_counter()
    metrics = figures(message, plan, ())
    # There are no cases.
    metrics.pop("case_bytes", None)
    return Invariants(
        verdict=Failed(tuple(problems)) if problems else Passed(1),
        shape=digest(plan),
        metrics=metrics,
        planning_seconds=planned - began,
        checking_seconds=checked - planned,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Ts2Options:
    """How to plan types.

    Attributes
    ----------
    paths : tuple of str
        Folders with ROS packages, searched first.
    wire : "ros1", "cdr" or None
        `None`: that of the distribution.
    widths : tuple of int
        Buses, in bytes.
    golden : str or None
        Folder of golden plans.
    """

    paths: tuple[str, ...] = ()
    wire: Wire | None = None
    widths: tuple[int, ...] = (8,)
    golden: str | None = None

    def command(
        self, distro: str, name: str, *, bus_bytes: int | None = None, golden: str | None = None
    ) -> str:
        """Return the command that checks one type again."""
        return command_again(
            name,
            systems="ts2",
            distro=distro,
            path=self.paths,
            wire=self.wire,
            bus_bytes=bus_bytes,
            golden=golden,
        )


@dataclass(frozen=True, slots=True)
class _Item:
    """A plan to check."""

    task: TypeUnderTest
    bus_bytes: int


class Ts2(System):
    """Plans of types; a test is one plan, or one golden plan.

    Parameters
    ----------
    tasks : sequence of Task
    options : Ts2Options
    jobs : int or None
        Processes; `None`: one per processor.
    executor : str
        See :func:`firm_hdl.jobs.executors.run_each`.

    Raises
    ------
    BuildError
        When its tests are asked for, if the folder is not one of golden plans.
    """

    name = "ts2"

    def __init__(
        self,
        tasks: Sequence[TypeUnderTest],
        options: Ts2Options | None = None,
        *,
        jobs: int | None = None,
        executor: str = PROCESSES,
    ):
        self._how = options or Ts2Options()
        self._items = [_Item(task, width) for task in tasks for width in self._how.widths]
        self._tasks, self._jobs, self._executor = tasks, jobs, executor

    @cached_property
    def tests(self) -> Sequence[Test]:
        """Those of plans, and those of golden plans."""
        return [*map(self._test, self._items), *map(self._golden_test, self._goldens)]

    @property
    def options(self) -> Mapping[str, Any]:
        """Where golden plans are."""
        return {"golden": self._how.golden}

    def run(self, recorder: Recorder) -> list[Judged]:
        """Check all plans, and compare golden ones."""
        # Before the first plan is made.
        goldens = self._goldens
        records = recorder.resume({item: self._test(item) for item in self._items}, "plans")
        self._check(records, recorder)
        self._count(records)
        found = judged(records.values())
        if self._how.golden is not None:
            found += self._compare(goldens, recorder)
        return found

    def _check(self, records: dict[_Item, Record], recorder: Recorder) -> None:
        """Check the plans that have no record yet, and add their records."""
        left = [item for item in self._items if item not in records]
        shares = shares_of(left, MOST_IN_A_SHARE)
        run = run_shares(_check_share, self._how, shares, executor=self._executor, jobs=self._jobs)
        total, known = len(self._items), len(records)
        bar = tqdm(total=total, initial=known, unit="plan", desc="TS2", disable=None)
        with bar, closing(run):
            for share, result in run:
                if isinstance(result, Exception):
                    why = f"{type(result).__name__}: {result}"
                    result = [Invariants(verdict=Failed((why,)))] * len(share)
                found = result
                made = {i: self._record(i, each) for i, each in zip(share, found, strict=True)}
                recorder.add(*made.values())
                records |= made
                for item, record in made.items():
                    _say(item, record)
                bar.update(len(share))

    def _count(self, records: Mapping[_Item, Record]) -> None:
        good: Counter[tuple[str, int]] = Counter()
        total: Counter[tuple[str, int]] = Counter()
        for item in self._items:
            keys = [(distro, item.bus_bytes) for distro in item.task.same]
            if not isinstance(records[item].verdict, NotJudged):
                total.update(keys)
            if isinstance(records[item].verdict, Passed):
                good.update(keys)
        for key in total:
            print(f"{key[0]:8} {good[key]:4} of {total[key]:4} plans are sound ({key[1]}-byte bus)")
        verdicts = [record.verdict for record in records.values()]
        shapes = {each.shape for each in records.values() if isinstance(each.verdict, Passed)}
        if silent := sum(isinstance(verdict, NotJudged) for verdict in verdicts):
            print(f"{silent} of {len(records)} plans not judged")
        print(f"{len(shapes)} different circuits")

    def _test(self, item: _Item) -> Test:
        task = item.task
        return Test(
            system=self.name,
            distro=task.distro,
            type=task.name,
            same=task.same,
            wire=wire_of(task.distro, self._how.wire),
            bus_bytes=item.bus_bytes,
            options=",".join(f"path={path}" for path in self._how.paths),
        )

    def _record(self, item: _Item, found: Invariants) -> Record:
        return Record(
            test=self._test(item),
            verdict=clipped_verdict(found.verdict),
            seconds=Seconds(generation=found.planning_seconds, testing=found.checking_seconds),
            cpu_seconds=found.cpu_seconds,
            metrics=found.metrics,
            shape=found.shape,
            command=self._how.command(
                item.task.distro, item.task.name, bus_bytes=item.bus_bytes
            ),
        )

    @cached_property
    def _goldens(self) -> list[Golden]:
        """The golden plans of the types that were asked for."""
        if self._how.golden is None:
            return []
        try:
            goldens = read_golden(self._how.golden)
        except ValueError as error:
            raise BuildError(str(error)) from None
        wanted = {(distro, _plain(task.name)) for task in self._tasks for distro in task.same}
        return [each for each in goldens if (each.distro, _plain(each.plan.message)) in wanted]

    def _compare(self, goldens: Sequence[Golden], recorder: Recorder) -> list[Judged]:
        """Compare golden plans."""
        known = {
            golden.path: record
            for golden in goldens
            if (record := recorder.known(self._golden_test(golden))) is not None
        }
        for result in check_golden([g for g in goldens if g.path not in known], self._how.paths):
            known[result.golden.path] = record = self._golden_record(result)
            recorder.add(record)
            if isinstance(record.verdict, Failed):
                _report(str(result.golden.path), record.verdict.failures)
        found = [Judged(what=str(path), verdict=known[path].verdict) for path in known]
        differing = sum(isinstance(each.verdict, Failed) for each in found)
        print(f"golden plans: {len(goldens)} compared, {differing} differ")
        none = NotJudged("none of them is of a type that was asked for")
        return found or [Judged(what=f"golden plans of {self._how.golden}", verdict=none)]

    def _golden_test(self, golden: Golden) -> Test:
        return Test(
            system=self.name,
            distro=golden.distro,
            type=golden.plan.message,
            wire=golden.plan.wire,
            bus_bytes=golden.plan.bus_bytes,
            options=f"golden={golden.path}",
        )

    def _golden_record(self, result: Checked) -> Record:
        test = self._golden_test(result.golden)
        return Record(
            test=test,
            verdict=clipped_verdict(result.verdict),
            command=self._how.command(test.distro, test.type, golden=self._how.golden),
        )


def _check_share(options: Ts2Options, share: tuple[_Item, ...]) -> list[Invariants]:
    return [_checked(options, item) for item in share]


def _checked(options: Ts2Options, item: _Item) -> Invariants:
    """Read, plan and check one type. Nothing is raised: what goes wrong is in the result."""
    began, began_cpu = time.perf_counter(), cpu_seconds()
    try:
        message = library_of(item.task.distro, options.paths).message(item.task.name)
        read = time.perf_counter() - began
        found = check_plan(message, options.wire, item.bus_bytes)
    except Exception as error:  # Whatever it is, the other types are to go on.
        verdict = Failed((described(error),))
        return Invariants(verdict=verdict, cpu_seconds=cpu_seconds() - began_cpu)
    return replace(
        found,
        planning_seconds=read + found.planning_seconds,
        cpu_seconds=cpu_seconds() - began_cpu,
    )


def _plain(name: str) -> str:
    """Return a name as both ROS 1 and rosbags may write it."""
    return name.replace("/msg/", "/")


def _say(item: _Item, record: Record) -> None:
    task = item.task
    if isinstance(record.verdict, Failed):
        _report(f"{task.name} ({task.distro}), {item.bus_bytes}-byte bus", record.verdict.failures)


def _report(what: str, lines: Iterable[str]) -> None:
    tqdm.write("\n".join([f"FAIL {what}", *(f"    {line}" for line in lines)]))
