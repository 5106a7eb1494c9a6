"""The work of ``firm-hdl node run``: a bridge, its figures, and the account at its end."""

from __future__ import annotations

import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Any, TextIO

from firm_hdl.errors import UserError
from firm_hdl.node.boards import board_of
from firm_hdl.node.bridge.bridge import Bridge
from firm_hdl.node.bridge.counters import BridgeCounters
from firm_hdl.node.bridge.session import WrongBoardError
from firm_hdl.node.capacity import rate_problems
from firm_hdl.node.control import ETHERNET_COUNTERS, Register
from firm_hdl.node.description import Description
from firm_hdl.node.graphs import graph_of
from firm_hdl.node.timekeeping import ptp_clock
from firm_hdl.terminal import stage

if TYPE_CHECKING:
    from firm_hdl.sim.fast import EngineName

__all__ = ["StatusPrinter", "account", "run_bridge", "status_line"]

_ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
"""Ctrl-C, `kill`, and a terminal that is closed: peers are told that the node leaves."""


def run_bridge(
    description: Description,
    board: str,
    *,
    graph: str | None = None,
    domain: int | None = None,
    interface: str | None = None,
    seconds: float | None = None,
    engine: EngineName = "auto",
    quiet: bool = False,
    wave: Path | None = None,
    phc: str | None = None,
) -> None:
    """Run a bridge until Ctrl-C (SIGINT) or SIGTERM; print to standard error.

    * `board`: see :func:`firm_hdl.node.boards.board_of`.
    * `graph`, `domain`, `interface`: see :func:`firm_hdl.node.graphs.graph_of`.
    * `seconds`: end after so long.
    * `engine`: of a simulated board; see :class:`.SimulatedBoard`.
    * `quiet`: print no figures, only what happens.
    * `wave`: of a simulated board; see :class:`.SimulatedBoard`.
    * `phc`: the PTP hardware clock that the node follows, rather than the clock of the system.

    Raises `UserError` or `DefinitionError` if board, graph or clock cannot be used, if the board
    has another description, or if it has not answered in `seconds`, or until the graph has ended.
    """
    clock = time.time_ns if phc is None else ptp_clock(phc)
    joined = graph_of(graph, description, domain=domain, interface=interface)
    status = StatusPrinter(sys.stderr, quiet=quiet)
    simulation: dict[str, Any] = {"engine": engine}
    if wave is not None and board != "sim":
        raise UserError(f"the board {board} has no waveform; '--wave' goes with --board sim")
    if board == "sim":
        simulation["wave"] = wave
        status.report(f"board sim: starts; {_engine(engine)}")
        simulation["report"] = lambda stage: status.report(f"board sim: {stage}")
    way = board_of(board, description, **simulation)
    bridge = Bridge(
        description,
        way,
        joined,
        report=status.report,
        clock=clock,
    )
    for line in rate_problems(description):
        status.report(f"warning: {line}")
    baud = round(10 * (way.bytes_per_second or 0))
    if baud and baud != description.link.baud:
        status.report(
            f"warning: board {board} has {baud} baud, and the link of the description has "
            f"{description.link.baud}"
        )
    with _signals(bridge):
        try:
            bridge.run(seconds=seconds, each_second=lambda: status.show(bridge))
        except WrongBoardError as error:
            raise UserError(str(error)) from None
        except KeyboardInterrupt:
            # The board was being opened when a signal came.
            if not bridge.was_stopped:
                raise
    if not quiet:
        for line in account(bridge):
            status.report(line)
    if not (bridge.side.was_ready or bridge.was_stopped):
        within = "" if seconds is None else f" in {seconds:g} s"
        raise UserError(f"the board {board} did not answer{within}")


def _engine(name: EngineName) -> str:
    """Say what runs a simulation, and how long a user has to wait."""
    # Amaranth takes seconds to import, and a host of a real board does not need it.
    from firm_hdl.sim.fast.engines import expected_engine

    found, why = expected_engine(name)
    if found == "verilator":
        return "to compile a new node takes a minute or more"
    slow = "Amaranth's simulator takes a few messages per second"
    return f"{slow} ({why})" if why else slow


@contextmanager
def _signals(bridge: Bridge) -> Iterator[None]:
    """Let signals end the bridge; a second Ctrl-C interrupts whatever it does.

    The start of a board may take a minute, if it is compiled, and is interrupted at once.
    """

    def stop(number: int, frame: FrameType | None) -> None:
        bridge.stop()
        signal.signal(signal.SIGINT, signal.default_int_handler)
        if bridge.side.is_opening:
            raise KeyboardInterrupt

    before = {number: signal.signal(number, stop) for number in _ENDING}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


_LOG_SECONDS = 10.0
"""How often the line is printed where it cannot be replaced."""

_WAY_LOSSES = ("lost", "held back")
"""What counts messages on the way from a board. Anything else says why some were lost."""

_GRAPH_SIGNS = ("overwritten",)
"""What readers may have got all the same."""

_LINK_SIGNS = ("late", "cut", "stray", "malformed")
"""The same of a board's link, which counts the messages as lost when the next one comes."""


class StatusPrinter:
    """Print what happens, and a line of figures.

    On a terminal, the line is replaced each second. Elsewhere, it is printed every 10 s.

    Parameters
    ----------
    stream : text file
    quiet : bool
        Print no line of figures.
    """

    def __init__(self, stream: TextIO, *, quiet: bool = False) -> None:
        self._stream, self._quiet = stream, quiet
        self._replaces = stream.isatty()
        self._width = 0
        self._before: tuple[float, int, int] | None = None
        self._next: float | None = None

    def report(self, text: str) -> None:
        """Print a line that stays."""
        self._print(text, "\n")

    def show(self, bridge: Bridge) -> None:
        """Print the line of figures if it is due."""
        # The start is over, and this line is in place of that of the command.
        stage("")
        now = time.monotonic()
        if self._next is None:
            # Only now: a board that is compiled takes longer to start than a line is apart.
            self._next = now if self._replaces else now + _LOG_SECONDS
        if self._quiet or now < self._next:
            return
        self._next = now + (0.0 if self._replaces else _LOG_SECONDS)
        sums = (bridge.counters.to_board.total(), bridge.counters.to_graph.total())
        before = self._before or (now, *sums)
        self._before = (now, *sums)
        seconds = max(now - before[0], 1e-9)
        rates = tuple((sums[n] - before[n + 1]) / seconds for n in (0, 1))
        self._print(status_line(bridge, rates), "" if self._replaces else "\n")

    def _print(self, text: str, end: str) -> None:
        head = "\r" if self._width else ""
        print(f"{head}{text.ljust(self._width)}", end=end, file=self._stream, flush=True)
        self._width = 0 if end else len(text)


def status_line(bridge: Bridge, rates: tuple[float, ...]) -> str:
    """Return the line of figures.

    * `rates`: messages per second to the board, and to the graph.
    """
    dropped = bridge.counters.dropped.total()
    parts = [
        f"{bridge.description.node}",
        "ready" if bridge.side.is_ready else "waits for the board",
        f"to board {rates[0]:.0f}/s",
        f"to graph {rates[1]:.0f}/s",
        f"dropped {dropped + sum(value for _, value in _drops(bridge))}",
    ]
    session = bridge.side.session
    if session is not None and session.latency is not None:
        parts.append(f"round trip {1000 * session.latency:.2f} ms")
    if session is not None and session.offset_ns is not None:
        parts.append(f"clock {session.offset_ns / 1000:+.0f} us")
    return ", ".join(parts)


def account(bridge: Bridge) -> Iterator[str]:
    """Yield lines about all that was passed, lost and dropped, for the end of a bridge."""
    yield from _table(bridge.description, bridge.counters)
    for name, value in _drops(bridge):
        yield f"dropped: {value} {name}"
    for name, value in _signs(bridge):
        yield f"seen: {value} {name}"
    if not bridge.side.was_ready:
        yield "the board has never answered"
    elif bridge.side.restarts:
        yield f"the board was started again or lost {bridge.side.restarts} times"
    if bridge.side.was_ready and not bridge.side.has_read_last:
        yield "not all counters on the board could be read at the end"


def _table(description: Description, counters: BridgeCounters) -> Iterator[str]:
    """Yield a table of what passed, a line per topic, and lines of what was dropped."""
    rows = [
        [topic.name, topic.kind, counters.to_board[topic.name], counters.to_graph[topic.name]]
        for topic in description.topics
    ]
    head: list[object] = ["topic", "", "to board", "to graph"]
    table = [[str(cell) for cell in row] for row in (head, *rows)]
    widths = [max(len(row[column]) for row in table) for column in range(len(head))]
    for row in table:
        cells = [row[0].ljust(widths[0]), row[1].ljust(widths[1])]
        cells += [row[n].rjust(widths[n]) for n in (2, 3)]
        yield "  ".join(cells)
    for (name, cause), count in sorted(counters.dropped.items()):
        yield f"dropped: {count} of {name}: {cause}"


def _drops(bridge: Bridge) -> Iterator[tuple[str, int]]:
    """Yield the losses that the bridge did not cause, with where they happened."""
    for name, value in _way(bridge):
        if name in _WAY_LOSSES:
            yield f"on the way from the board: {name}", value
    for name, value in sorted(bridge.graph.counters.items()):
        if value and name not in _GRAPH_SIGNS:
            yield f"in the graph: {name}", value
    for register, value in bridge.side.drops():
        if not _is_sign(register):
            yield f"on the board, {register.owner} {register.part}: {register.name}", value


def _signs(bridge: Bridge) -> Iterator[tuple[str, int]]:
    """Yield why messages were lost on the way, which are counted as lost, and what came again."""
    for name, value in _way(bridge):
        if name not in _WAY_LOSSES:
            yield f"on the way from the board: {name}", value
    for name in _GRAPH_SIGNS:
        if value := bridge.graph.counters[name]:
            yield f"in the graph: {name}", value
    for register, value in bridge.side.drops():
        if _is_sign(register):
            yield f"on the board, {register.owner} {register.part}: {register.name}", value


def _way(bridge: Bridge) -> list[tuple[str, int]]:
    return sorted(bridge.side.on_the_way.items())


def _is_sign(register: Register) -> bool:
    return register.part == "link" and register.name in (*_LINK_SIGNS, *ETHERNET_COUNTERS)
