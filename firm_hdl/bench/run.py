"""Converters of message types, each simulated and measured in a process of its own."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from amaranth.back import rtlil

from firm_hdl.bench.cycles import STATED, Cycles, Stated, count_cycles
from firm_hdl.bench.devices import DEVICES, Device
from firm_hdl.bench.flow import PREPARATIONS, Measured, measure
from firm_hdl.bench.results import Converted, Result, measured_from_json, measured_to_json
from firm_hdl.bench.tools import versions
from firm_hdl.errors import DefinitionError, UserError
from firm_hdl.export.build import check_size, plan_of
from firm_hdl.export.top import converter_of
from firm_hdl.files import write_file
from firm_hdl.frontend import open_library
from firm_hdl.jobs import run_each

__all__ = ["BenchTask", "measure_once", "run_tasks"]


FORMAT = 1
"""A part of the key. Change it if the figures of a circuit change for a reason not in the key."""


def measure_once(
    rtlil: str, device: Device, seeds: Sequence[int], *, mapping: str, folder: Path | None
) -> Measured:
    """Measure a circuit, unless the folder has its figures. Parameters as for `measure`.

    A file's name is a hash of the RTLIL, the device's options, the seeds, and the versions of the
    tools. A result without clock rates for all seeds is not kept.

    * `folder`: created if it does not exist; `None`: measure always.
    """
    if folder is None:
        return measure(rtlil, device, seeds, mapping=mapping)
    # Without seeds, nextpnr is not run, and may be missing.
    tools = versions(device, with_placer=bool(seeds))
    parts = [FORMAT, rtlil, repr(device), PREPARATIONS, list(seeds), mapping, tools]
    key = hashlib.sha256(json.dumps(parts).encode()).hexdigest()
    file = folder / f"{key}.json"
    with suppress(OSError, ValueError, KeyError, TypeError):
        return measured_from_json(json.loads(file.read_text(encoding="utf-8")))
    found = measure(rtlil, device, seeds, mapping=mapping)
    if not found.problem:
        # Another process may write or read the same file.
        write_file(file, json.dumps(measured_to_json(found)))
    return found


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
        plan = plan_of(message, what.wire, what.bus_bytes, what.max_message_bytes)
        check_size(plan)
        if task.stated is not None:
            converter = converter_of(message, plan, what.direction)
            cycles = count_cycles(converter, message, task.stated)
        if task.device is not None:
            measured = measure_once(
                rtlil.convert(
                    converter_of(message, plan, what.direction), name="top", emit_src=False
                ),
                DEVICES[task.device],
                task.seeds,
                mapping=task.mapping,
                folder=None if task.cache is None else Path(task.cache),
            )
            problem = measured.problem
    except (UserError, DefinitionError, ValueError) as error:
        problem = str(error)
    return Result(converter=what, cycles=cycles, measured=measured, problem=problem)
