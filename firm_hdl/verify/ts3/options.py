"""How acceptance runs the cases of a type, and what becomes of it."""

from __future__ import annotations

from dataclasses import dataclass, field

from firm_hdl.verify.cases.directed import Coverage
from firm_hdl.verify.choices import LONGEST
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed, Verdict
from firm_hdl.verify.simulators.crosscheck import Comparison
from firm_hdl.verify.systems.again import command_again

__all__ = ["Options", "Result"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """How to run the cases of a type.

    Attributes
    ----------
    bus_bytes : int
    wire : "ros1", "cdr" or None
        `None`: that of the distribution.
    seed : int
    stalled, broken : bool
        Whether to run with stalls, and with broken packets, as well.
    most_cases : int or None
    simulator : str
        ``python``, or the simulator of exported text that everything is replayed in as well; see
        :data:`firm_hdl.verify.simulators.SIMULATORS`.
    paths : tuple of str
        Folders with ROS packages, searched before the distribution's own types.
    bags : tuple of str
        Recordings whose messages are replayed; definitions come from nowhere else then.
    longest : int
        Longest recorded message to replay, in bytes.
    references : tuple of str or None
        Libraries that have to write the same bytes as rosbags; `None`: all that are here.
    vcd : str or None
        Folder for a waveform of each run.
    simulated : bool
        Whether to run the circuit at all, and not only the golden model: the same circuit may have
        been simulated for another type.
    """

    bus_bytes: int = 8
    wire: str | None = None
    seed: int = 0
    stalled: bool = True
    broken: bool = True
    most_cases: int | None = None
    simulator: str = "python"
    paths: tuple[str, ...] = ()
    bags: tuple[str, ...] = ()
    longest: int = LONGEST
    references: tuple[str, ...] | None = None
    vcd: str | None = None
    simulated: bool = True

    def command(self, distro: str, name: str) -> str:
        """Return the command that runs one type again."""
        references = self.references
        return command_again(
            name,
            distro=distro,
            path=self.paths,
            bag=self.bags,
            max_message_bytes=None if self.longest == LONGEST else self.longest,
            simulator=None if self.simulator == "python" else self.simulator,
            bus_bytes=self.bus_bytes,
            wire=self.wire,
            seed=self.seed,
            no_stalls=not self.stalled,
            no_broken=not self.broken,
            cases=self.most_cases,
            reference=("none",) if references == () else references,
            vcd=self.vcd,
        )


@dataclass(slots=True, kw_only=True)
class Result:
    """What became of a type.

    Attributes
    ----------
    distro, name : str
    failures : list of str
        What is wrong, as it is found.
    judged : int
        Packets whose bytes and transfers were compared with the oracle's: those that came out of
        the circuit, or of the golden model if the circuit is not to be simulated.
    obstacle : NotJudged or None
        Why there is no oracle for the type, and nothing was run.
    cases, packets : int
        Cases of the type, and packets sent for them in all runs.
    beats, cycles : int
        Of the run without stalls.
    simulated_cycles : int
        Of all runs.
    seconds, setup_seconds, simulation_seconds, cpu_seconds : float
        In total, until the circuit was ready to run, in simulators, and of the processor.
    wire : str
        Empty if nothing was run.
    coverage : Coverage or None
        Decisions of the plan that the packets took which are not damaged.
    metrics : dict of str to float
        Figures of the type, of its plan and of its cases.
    shape : str
        Digest of the plan without names.
    command : str
        How to run it again.
    note : str
        What is to be known about the oracle; empty in most cases.
    written_by : tuple of str
        Who was asked to write the same bytes as rosbags.
    known : tuple of str
        Keys of what explains that one of those writes other bytes than rosbags.
    comparison : Comparison or None
        With another simulator, if there was one.
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
    seconds: float = 0.0
    setup_seconds: float = 0.0
    simulation_seconds: float = 0.0
    cpu_seconds: float = 0.0
    wire: str = ""
    coverage: Coverage | None = None
    metrics: dict[str, float] = field(default_factory=dict)
    shape: str = ""
    command: str = ""
    note: str = ""
    written_by: tuple[str, ...] = ()
    known: tuple[str, ...] = ()
    comparison: Comparison | None = None

    def say(self, what: str) -> None:
        """Add to the note."""
        self.note = "; ".join(filter(None, [self.note, what]))

    @property
    def verdict(self) -> Verdict:
        """What all of this comes to; cases are packets that were judged."""
        if self.failures:
            return Failed(tuple(self.failures))
        if self.obstacle is not None:
            return self.obstacle
        if not self.judged:
            return NotJudged("no packet was compared with the oracle")
        if self.known:
            return KnownDifference(self.known, self.judged)
        return Passed(self.judged)
