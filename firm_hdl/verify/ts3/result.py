"""The test of a type with some options, its result, and the record of the result."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from firm_hdl.cases.effort import message_limit
from firm_hdl.cases.figures import digest
from firm_hdl.errors import DefinitionError
from firm_hdl.export.build import BuildError, plan_of
from firm_hdl.verify.choices import LONGEST
from firm_hdl.verify.results.records import PlanCoverage, Record, Seconds, Test, clipped_verdict
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed, Verdict
from firm_hdl.verify.simulators.crosscheck import Comparison
from firm_hdl.verify.systems.options import Options, command_again
from firm_hdl.verify.systems.system import Stopwatch, wire_of
from firm_hdl.verify.systems.tasks import TypeUnderTest, library_of
from firm_hdl.wire import lay_out

__all__ = ["Result", "command_of", "record_of", "same_circuits", "test_of"]

WAVEFORM_FOLDER = "waveforms"
"""The folder that the command for a waveform writes to."""


@dataclass(slots=True, kw_only=True)
class Result:
    """The result of a type.

    Attributes
    ----------
    distro, name : str
    failures : list of str
        Failures in the order in which they were found.
    judged : int
        The number of packets whose bytes and transfers were compared with the oracle's. They come
        from the circuit, or from the golden model if the circuit is not to be simulated.
    obstacle : NotJudged or None
        Why the type cannot be judged, or why a library that was named could not confirm it.
    cases, packets : int
        Cases of the type, and packets sent for them in all runs.
    beats, cycles : int
        Beats and cycles of the run without stalls.
    simulated_cycles : int
        Cycles of all runs.
    watch : Stopwatch
        Measures the stages of the test.
    seconds : Seconds
    cpu_seconds : float
    coverage : PlanCoverage or None
        Decisions of the plan that undamaged packets took.
    metrics : dict of str to float
        Figures of the type, of its plan and of its cases.
    shape : str
        Digest of the plan without names.
    command : str
        The command that repeats the test.
    note : str
        A remark about the oracle; empty in most cases.
    written_by : tuple of str
        Libraries that wrote the same values as rosbags.
    known : tuple of str
        Keys of the known divergences between rosbags and these libraries.
    comparison : Comparison or None
        The comparison with another simulator, if there was one.
    """

    distro: str
    name: str
    failures: list[str] = field(default_factory=list)
    judged: int = 0
    obstacle: NotJudged | None = None
    cases: int = 0
    packets: int = 0
    beats: int = 0
    cycles: int = 0
    simulated_cycles: int = 0
    watch: Stopwatch = field(default_factory=Stopwatch, repr=False, compare=False)
    seconds: Seconds = field(default_factory=Seconds)
    cpu_seconds: float = 0.0
    coverage: PlanCoverage | None = None
    metrics: dict[str, float] = field(default_factory=dict)
    shape: str = ""
    command: str = ""
    note: str = ""
    written_by: tuple[str, ...] = ()
    known: tuple[str, ...] = ()
    comparison: Comparison | None = None

    def add_note(self, what: str) -> None:
        """Add to the note."""
        self.note = "; ".join(filter(None, [self.note, what]))

    @property
    def verdict(self) -> Verdict:
        """The verdict; its cases are packets that were judged."""
        if self.failures:
            return Failed(tuple(self.failures))
        if self.obstacle is not None:
            return self.obstacle
        if not self.judged:
            return NotJudged("no packet was compared with the oracle")
        if self.known:
            return KnownDifference(self.known, self.judged)
        return Passed(self.judged)


def command_of(options: Options, distro: str, name: str) -> str:
    """Return the command that runs one type again."""
    references = options.references
    return command_again(
        name,
        distro=distro,
        path=options.paths,
        depends=options.depends,
        bag=options.bags,
        max_message_bytes=None if options.longest == LONGEST else options.longest,
        simulator=None if options.simulator == "python" else options.simulator,
        bus_bytes=options.bus_bytes,
        wire=options.wire,
        seed=options.seed,
        no_stalls=not options.stalled,
        no_broken=not options.broken,
        cases=options.most_cases,
        reference=("none",) if references == () else references,
        vcd=options.vcd,
    )


def test_of(task: TypeUnderTest, options: Options) -> Test:
    """Return the test that runs a task with some options."""
    own = [f"seed={options.seed}"]
    own += [] if options.most_cases is None else [f"cases={options.most_cases}"]
    own += [] if options.stalled else ["no-stalls"]
    own += [] if options.broken else ["no-broken"]
    own += [] if options.references is None else [f"references={'+'.join(options.references)}"]
    own += options.folders
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


# Pytest takes functions with such names for tests, even if a test module only imports them.
test_of.__test__ = False  # type: ignore[attr-defined]


def record_of(task: TypeUnderTest, result: Result, options: Options, same_as: str = "") -> Record:
    """Return the record of a result.

    Parameters
    ----------
    same_as : str
        Key of the test that simulates the circuit for this one.
    """
    waveform = replace(options, vcd=WAVEFORM_FOLDER, simulator="python")
    return Record(
        test=test_of(task, options),
        verdict=clipped_verdict(result.verdict),
        note=result.note,
        seconds=result.seconds,
        cpu_seconds=result.cpu_seconds,
        cases=result.cases,
        packets=result.packets,
        cycles=result.simulated_cycles,
        beats=result.beats,
        coverage=result.coverage,
        metrics=result.metrics,
        shape=result.shape,
        same_as=same_as,
        written_by=("rosbags", *result.written_by) if result.cases else (),
        command=result.command,
        waveform_command=command_of(waveform, task.distro, task.name),
    )


def same_circuits(
    tasks: Sequence[TypeUnderTest], options: Options
) -> dict[TypeUnderTest, TypeUnderTest]:
    """Return the tasks whose circuit is equal to that of an earlier task, with the earlier task.

    Circuits are equal if plans are equal apart from names.
    """
    first: dict[str, TypeUnderTest] = {}
    found: dict[TypeUnderTest, TypeUnderTest] = {}
    for task in tasks:
        try:
            message = library_of(task.distro, options).message(task.name)
            wire: Any = options.wire or message.wire
            limit = message_limit(lay_out(message, wire).min_bytes)
            plan = plan_of(message, wire, options.bus_bytes, limit)
        except (DefinitionError, BuildError, ValueError):
            # The task's own test reports the error.
            continue
        other = first.setdefault(digest(plan), task)
        if other is not task:
            found[task] = other
    return found
