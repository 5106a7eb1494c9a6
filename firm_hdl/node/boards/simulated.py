# amaranth: UnusedElaboratable=no
"""The node in simulation, in place of a board."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from firm_hdl.errors import UserError
from firm_hdl.node.accelerator import conflicts_reported
from firm_hdl.node.boards.board import Board, BoardError
from firm_hdl.node.description import Description, Link
from firm_hdl.node.node import Node
from firm_hdl.sim.fast import BuildError, EngineName, FastSimulation, Report, SimulationError
from firm_hdl.sim.fast.ports import ports_of

__all__ = ["SimulatedBoard"]

_IN, _OUT = "link.frames_in", "link.frames_out"
_STALLS = (False, True)
"""The link is idle in every second cycle.

Gates drop what comes while they are behind. Links of boards are seldom full; a simulation that is
slower than its messages would always be."""
# A node has many converters, and with -O2 they take several minutes.
_OPTIONS = ("-O1",)


@contextmanager
def _reported() -> Iterator[None]:
    """Make the errors of a simulation those of a board, or of its user."""
    try:
        yield
    except BuildError as error:
        raise UserError(str(error)) from None
    except SimulationError as error:
        raise BoardError(str(error)) from None


class SimulatedBoard(Board):
    """A node that runs live in a :class:`.FastSimulation`, as fast as the engine can.

    The node has the link `stream`, whatever the description says: a frame is a packet, and the
    signals of a medium are not simulated. Core, gates, converters and accelerator are those of the
    hardware. The clock of a simulation is slower than that of the board, and slower still while
    nothing comes, so the time of the node is set several times per second. Frames come at half the
    rate of the bus.

    * `description`: with an accelerator.
    * `report`: told the stages of a compilation.
    * `wave`: a file that the waveform is written to: ``.fst`` is FST, any other VCD.

    Raises `DefinitionError` or `UserError` if the description has no accelerator, or one that
    cannot be used, or if the waveform cannot be written.
    """

    sample_seconds = 0.1
    has_real_time = False
    # An answer takes seconds on a busy machine, and a simulation that has ended says so.
    silent_seconds = 60.0
    # Its link loses nothing, and a request that is repeated takes its time.
    repeat_seconds = 5.0
    # Amaranth's simulator answers a few requests per second, and there is one for each counter.
    end_seconds = 60.0

    def __init__(
        self,
        description: Description,
        *,
        engine: EngineName = "auto",
        report: Report | None = None,
        wave: Path | None = None,
    ) -> None:
        super().__init__("sim")
        if not description.accelerator:
            raise UserError(
                "a simulated board needs an 'accelerator' in the description of the node: without "
                "one, nothing takes its messages"
            )
        # The registers are those of the board.
        link = Link(kind="stream", ethernet=description.link.ethernet)
        # Nobody is there to use a bus of the chip.
        self._description = replace(description, link=link, registers="")
        self._engine, self._report = engine, report
        self._wave = wave
        if wave is not None:
            if wave.suffix == ".ghw":
                raise UserError(f"cannot write '{wave}': Verilator has the formats .vcd and .fst")
            try:
                with wave.open("ab"):
                    pass
            except OSError as error:
                raise UserError(f"cannot write '{wave}': {error.strerror or error}") from None
        self._simulation: FastSimulation | None = None
        self._is_open = False

    def compile(self) -> None:
        """Elaborate and compile the node, which :meth:`open` does otherwise.

        Raises `UserError` if it cannot be compiled.
        """
        with _reported():
            self._simulation = self._start()
        self.close()

    def open(self) -> None:
        """Elaborate and compile the node unless that was done before, and let it run."""
        with _reported():
            if self._simulation is None:
                self._simulation = self._start()
            else:
                self._simulation.restart()
            self._simulation.stall(_IN, _STALLS)
            self._simulation.go_live()
        self._is_open = True

    def _start(self) -> FastSimulation:
        node = Node(self._description)
        outputs = (each.name for each in ports_of(node).streams if not each.is_input)
        ignored = [name for name in outputs if name != _OUT]
        with conflicts_reported(self._description):
            return FastSimulation(
                node,
                engine=self._engine,
                options=_OPTIONS,
                ignored=ignored,
                report=self._report,
                modules=getattr(node.accelerator, "modules", None),
                wave=self._wave,
            )

    def fileno(self) -> int:
        with _reported():
            return self._running().fileno()

    def send(self, frames: Sequence[bytes]) -> bool:
        with _reported():
            self._running().send_packets(_IN, frames)
        return True

    def receive(self) -> list[bytes]:
        with _reported():
            return self._running().receive_packets(_OUT)

    def close(self) -> None:
        self._is_open = False
        if self._simulation is not None:
            self._simulation.close()

    def _running(self) -> FastSimulation:
        if self._simulation is None or not self._is_open:
            raise BoardError("the simulation is closed")
        return self._simulation
