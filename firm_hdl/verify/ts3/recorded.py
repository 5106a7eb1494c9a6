"""TS3 and records: which test a task is, and what is kept of its result."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from firm_hdl.errors import DefinitionError
from firm_hdl.export.build import BuildError, plan_of
from firm_hdl.verify.cases.effort import message_limit
from firm_hdl.verify.cases.figures import digest
from firm_hdl.verify.choices import LONGEST
from firm_hdl.verify.results.records import PlanCoverage, Record, Seconds, Test, clipped_verdict
from firm_hdl.verify.systems.options import Options
from firm_hdl.verify.systems.system import wire_of
from firm_hdl.verify.systems.tasks import TypeUnderTest, library_of
from firm_hdl.verify.ts3.result import Result, command_of
from firm_hdl.wire import lay_out

__all__ = ["record_of", "same_circuits", "test_of"]

# What people have a look at first; the command makes it.
WAVEFORM_FOLDER = "waveforms"


def test_of(task: TypeUnderTest, options: Options) -> Test:
    """Return the test that runs a task with some options."""
    own = [f"seed={options.seed}"]
    own += [] if options.most_cases is None else [f"cases={options.most_cases}"]
    own += [] if options.stalled else ["no-stalls"]
    own += [] if options.broken else ["no-broken"]
    own += [] if options.references is None else [f"references={'+'.join(options.references)}"]
    own += [f"path={path}" for path in options.paths]
    own += [f"bag={bag}" for bag in options.bags]
    own += [] if options.longest == LONGEST else [f"longest={options.longest}"]
    return Test(
        system="ts3",
        simulator=options.simulator,
        distro=task.distro,
        type=task.name,
        same=task.same,
        wire=wire_of(task.distro, options.wire),
        bus_bytes=options.bus_bytes,
        options=",".join(own),
    )


# Pytest takes functions of such names for tests, wherever they come from.
test_of.__test__ = False  # type: ignore[attr-defined]


def record_of(task: TypeUnderTest, result: Result, options: Options, same_as: str = "") -> Record:
    """Return what is kept of a result.

    Parameters
    ----------
    same_as : str
        Key of the test that simulates the circuit for this one.
    """
    testing = result.seconds - result.setup_seconds - result.simulation_seconds
    waveform = replace(options, vcd=WAVEFORM_FOLDER, simulator="python")
    return Record(
        test=test_of(task, options),
        verdict=clipped_verdict(result.verdict),
        note=result.note,
        seconds=Seconds(
            generation=result.setup_seconds,
            simulation=result.simulation_seconds,
            testing=max(0.0, testing) if result.setup_seconds else 0.0,
        ),
        cpu_seconds=result.cpu_seconds,
        cases=result.cases,
        packets=result.packets,
        cycles=result.simulated_cycles,
        beats=result.beats,
        coverage=_coverage(result),
        metrics=result.metrics,
        shape=result.shape,
        same_as=same_as,
        written_by=("rosbags", *result.written_by) if result.cases else (),
        command=result.command,
        waveform_command=command_of(waveform, task.distro, task.name),
    )


def _coverage(result: Result) -> PlanCoverage | None:
    coverage = result.coverage
    if coverage is None:
        return None
    return PlanCoverage(
        taken=len(coverage.taken),
        possible=len(coverage.possible),
        missing=tuple(f"step {edge.step}: {edge.way}" for edge in coverage.missing),
    )


def same_circuits(
    tasks: Sequence[TypeUnderTest], options: Options
) -> dict[TypeUnderTest, TypeUnderTest]:
    """Return tasks whose circuit is that of an earlier task, and that task.

    Circuits are the same where plans are the same but for names.
    """
    first: dict[str, TypeUnderTest] = {}
    found: dict[TypeUnderTest, TypeUnderTest] = {}
    for task in tasks:
        try:
            message = library_of(task.distro, options.paths).message(task.name)
            wire: Any = options.wire or message.wire
            limit = message_limit(lay_out(message, wire).min_bytes)
            plan = plan_of(message, wire, options.bus_bytes, limit)
        except (DefinitionError, BuildError, ValueError):
            # Whatever is wrong with it, its own test says.
            continue
        other = first.setdefault(digest(plan), task)
        if other is not task:
            found[task] = other
    return found
