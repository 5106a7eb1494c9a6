"""TS2: what a converter is meant to do, checked and compared before there is any circuit.

Every plan must keep the invariants of plans and be one of its layout (:func:`firm_hdl.plan.check`),
and its printed form must say all of it: read back, it is the same plan. Where golden plans are
given, those of the types that were asked for must mean the same as today's.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from tqdm import tqdm

from firm_hdl.errors import DefinitionError
from firm_hdl.export.build import BuildError, plan_of
from firm_hdl.frontend import Library
from firm_hdl.model import Message
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES, check, from_yaml, to_yaml
from firm_hdl.plan.shape import shape
from firm_hdl.verify.golden import check_golden, read_golden
from firm_hdl.verify.runner import Task
from firm_hdl.wire import Wire, lay_out

__all__ = ["Invariants", "check_plan", "run_ts2"]

YAML_STEPS = 2000
"""Longer plans are not printed and read back: it takes a second per some thousand steps."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Invariants:
    """What was found out about the plan of a type.

    Attributes
    ----------
    problems : tuple of str
        Empty if all is well.
    shape : int
        Hash of the plan without names.
    steps : int
    """

    problems: tuple[str, ...]
    shape: int = 0
    steps: int = 0


def check_plan(message: Message, wire: Wire | None, bus_bytes: int) -> Invariants:
    """Plan a type, and check the plan. Nothing is raised for what is wrong with it."""
    try:
        plan = plan_of(message, wire, bus_bytes, DEFAULT_MAX_MESSAGE_BYTES)
    except (BuildError, DefinitionError) as error:
        return Invariants(problems=(str(error),))
    problems = list(check(plan, lay_out(message, wire)))
    if len(plan.steps) <= YAML_STEPS and from_yaml(to_yaml(plan)) != plan:
        problems.append("the plan in YAML, read back, is another one")
    return Invariants(problems=tuple(problems), shape=hash(shape(plan)), steps=len(plan.steps))


def run_ts2(
    tasks: Sequence[Task],
    *,
    paths: Sequence[str] = (),
    wire: Wire | None = None,
    widths: Sequence[int] = (8,),
    golden: str | None = None,
) -> bool:
    """Check the plans of types, print what is wrong with them, and say whether nothing is.

    Parameters
    ----------
    paths : sequence of str
        Folders with ROS packages, searched first.
    widths : sequence of int
        Buses, in bytes.
    golden : str or None
        Folder of golden plans.

    Raises
    ------
    BuildError
        If that folder is not one of golden plans.
    """
    libraries: dict[str, Library] = {}
    good: Counter[tuple[str, int]] = Counter()
    total: Counter[tuple[str, int]] = Counter()
    shapes: set[int] = set()
    failed = 0
    for task in tqdm(tasks, unit="type", desc="TS2", disable=None):
        if task.distro not in libraries:
            libraries[task.distro] = Library(task.distro, paths)
        message = libraries[task.distro].message(task.name)
        for bus_bytes in widths:
            found = check_plan(message, wire, bus_bytes)
            keys = [(distro, bus_bytes) for distro in task.same]
            total.update(keys)
            if found.problems:
                failed += 1
                _report(f"{task.name} ({task.distro}), {bus_bytes}-byte bus", found.problems)
            else:
                good.update(keys)
                shapes.add(found.shape)
    for distro, bus_bytes in total:
        key = distro, bus_bytes
        print(f"{distro:8} {good[key]:4} of {total[key]:4} plans are sound ({bus_bytes}-byte bus)")
    print(f"{len(shapes)} different circuits")
    if golden is not None:
        failed += _golden(tasks, golden, paths)
    return not failed


def _golden(tasks: Sequence[Task], folder: str, paths: Sequence[str]) -> int:
    """Compare the golden plans of some types; return how many differ."""
    try:
        goldens = read_golden(folder)
    except ValueError as error:
        raise BuildError(str(error)) from None
    wanted = {(distro, _plain(task.name)) for task in tasks for distro in task.same}
    chosen = [each for each in goldens if (each.distro, _plain(each.plan.message)) in wanted]
    differing = [result for result in check_golden(chosen, paths) if not result.is_same]
    for result in differing:
        _report(str(result.golden.path), [*result.problems, *map(str, result.changes)])
    print(f"golden plans: {len(chosen)} compared, {len(differing)} differ")
    return len(differing)


def _plain(name: str) -> str:
    """Return a name as both ROS 1 and rosbags may write it."""
    return name.replace("/msg/", "/")


def _report(what: str, lines: Sequence[str]) -> None:
    tqdm.write("\n".join([f"FAIL {what}", *(f"    {line}" for line in lines)]))
