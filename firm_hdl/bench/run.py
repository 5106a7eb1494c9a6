"""Converters of message types, each simulated and measured in a process of its own."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from amaranth.back import rtlil

from firm_hdl.bench.cache import measure_once
from firm_hdl.bench.cycles import Converter, Cycles, count_cycles
from firm_hdl.bench.devices import DEVICES
from firm_hdl.bench.flow import Measured
from firm_hdl.bench.messages import STATED, Stated
from firm_hdl.bench.results import Converted, Result
from firm_hdl.errors import DefinitionError, UserError
from firm_hdl.export.build import check_size, plan_of
from firm_hdl.frontend import open_library
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.jobs import run_each
from firm_hdl.model import Message

__all__ = ["BenchTask", "run_tasks"]


@dataclass(frozen=True, slots=True, kw_only=True)
class BenchTask:
    """One converter."""

    converter: Converted
    # As for `open_library`.
    paths: tuple[str, ...] = ()
    bags: tuple[str, ...] = ()
    depends: tuple[str, ...] = ()
    device: str | None = "ecp5"  # A name of `DEVICES`; `None`: cycles only.
    seeds: tuple[int, ...] = (1, 2, 3)  # Seeds of nextpnr.
    mapping: str = ""  # Commands of Yosys before the mapping.
    stated: Stated | None = STATED  # Messages of the simulation; `None`: no simulation.
    cache: str | None = None  # Folder with figures that were computed before.


def run_tasks(tasks: Sequence[BenchTask], jobs: int | None = None) -> Iterator[Result]:
    """Run tasks in `jobs` processes (`None`: one per processor); yield results as they finish."""
    work = [(task, (task,)) for task in tasks]
    for task, result in run_each(run_task, work, jobs=jobs):
        if isinstance(result, Exception):
            result = Result(converter=task.converter, problem=str(result))
        yield result


def run_task(task: BenchTask) -> Result:
    """Run a task. If a type is wrong, or a tool fails, the result has the reason in `problem`."""
    what = task.converter
    cycles: Cycles | None = None
    measured: Measured | None = None
    problem = ""
    try:
        library = open_library(what.distro, task.paths, task.bags, depends=task.depends)
        message = library.message(what.type)
        check_size(plan_of(message, what.wire, what.bus_bytes, what.max_message_bytes))
        if task.stated is not None:
            cycles = count_cycles(_converter(what, message), message, task.stated)
        if task.device is not None:
            measured = _measure(task, message)
            problem = measured.problem
    except (UserError, DefinitionError, ValueError) as error:
        problem = str(error)
    return Result(converter=what, cycles=cycles, measured=measured, problem=problem)


def _measure(task: BenchTask, message: Message) -> Measured:
    assert task.device is not None
    return measure_once(
        rtlil.convert(_converter(task.converter, message), name="top", emit_src=False),
        DEVICES[task.device],
        task.seeds,
        mapping=task.mapping,
        folder=None if task.cache is None else Path(task.cache),
    )


def _converter(what: Converted, message: Message) -> Converter:
    component = Deserializer if what.direction == "deserializer" else Serializer
    return component(
        message,
        wire=what.wire,
        bus_bytes=what.bus_bytes,
        max_message_bytes=what.max_message_bytes,
    )
