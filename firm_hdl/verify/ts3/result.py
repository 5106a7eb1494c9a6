"""What becomes of a type in acceptance, and how to run it again."""

from __future__ import annotations

from dataclasses import dataclass, field

from firm_hdl.verify.cases.directed import Coverage
from firm_hdl.verify.choices import LONGEST
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed, Verdict
from firm_hdl.verify.simulators.crosscheck import Comparison
from firm_hdl.verify.systems.options import Options, command_again

__all__ = ["Result", "command_of"]


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


def command_of(options: Options, distro: str, name: str) -> str:
    """Return the command that runs one type again."""
    references = options.references
    return command_again(
        name,
        distro=distro,
        path=options.paths,
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
