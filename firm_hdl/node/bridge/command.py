"""The work of ``firm-hdl node run``."""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING, Any

from firm_hdl.errors import UserError
from firm_hdl.node.boards import board_of
from firm_hdl.node.bridge.bridge import Bridge
from firm_hdl.node.bridge.session import WrongBoardError
from firm_hdl.node.bridge.status import Status, account
from firm_hdl.node.capacity import rate_problems
from firm_hdl.node.description import Description
from firm_hdl.node.graphs import graph_of

if TYPE_CHECKING:
    from firm_hdl.sim.fast import EngineName

__all__ = ["run_bridge"]

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
) -> None:
    """Run a bridge until Ctrl-C (SIGINT) or SIGTERM; print to standard error.

    Parameters
    ----------
    board : str
        See :func:`firm_hdl.node.boards.board_of`.
    graph, domain, interface
        See :func:`firm_hdl.node.graphs.graph_of`.
    seconds : float or None
        End after so long.
    engine : str
        Of a simulated board; see :class:`.SimulatedBoard`.
    quiet : bool
        Print no figures, only what happens.

    Raises
    ------
    UserError, DefinitionError
        If board or graph cannot be used, if the board has another description, or if it has not
        answered in `seconds`, or until the graph has ended.
    """
    joined = graph_of(graph, description, domain=domain, interface=interface)
    status = Status(sys.stderr, quiet=quiet)
    simulation: dict[str, Any] = {"engine": engine}
    if board == "sim":
        status.report(f"board sim: starts; {_engine(engine)}")
        simulation["report"] = lambda stage: status.report(f"board sim: {stage}")
    way = board_of(board, description, **simulation)
    bridge = Bridge(
        description,
        way,
        joined,
        report=status.report,
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
    if not (bridge.was_ready or bridge.was_stopped):
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
