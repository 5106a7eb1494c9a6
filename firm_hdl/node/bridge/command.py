"""The work of ``firm-hdl node run``."""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from firm_hdl.errors import UserError
from firm_hdl.node.boards import board_of
from firm_hdl.node.bridge.bridge import Bridge
from firm_hdl.node.bridge.session import WrongBoardError
from firm_hdl.node.bridge.status import Status, account
from firm_hdl.node.description import Description
from firm_hdl.node.graphs import graph_of

__all__ = ["run_bridge"]


def run_bridge(
    description: Description,
    board: str,
    *,
    graph: str | None = None,
    domain: int | None = None,
    interface: str | None = None,
    seconds: float | None = None,
    engine: str = "auto",
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
        If board or graph cannot be used, or the board has another description.
    """
    status = Status(sys.stderr, quiet=quiet)
    bridge = Bridge(
        description,
        board_of(board, description, engine=engine),
        graph_of(graph, description, domain=domain, interface=interface),
        report=status.report,
    )
    if board == "sim":
        status.report("board sim: starts; to compile a new node takes up to a minute")
    with _signals(bridge):
        try:
            bridge.run(seconds=seconds, each_second=lambda: status.show(bridge))
        except WrongBoardError as error:
            raise UserError(str(error)) from None
    if not quiet:
        for line in account(bridge):
            status.report(line)


@contextmanager
def _signals(bridge: Bridge) -> Iterator[None]:
    """Let signals end the bridge; a second Ctrl-C interrupts whatever it does."""

    def stop(number: int, frame: FrameType | None) -> None:
        bridge.stop()
        signal.signal(signal.SIGINT, signal.default_int_handler)

    before = {number: signal.signal(number, stop) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
