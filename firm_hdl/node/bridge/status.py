"""The line that says how a bridge does, and the account at its end."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import TextIO

from firm_hdl.node.bridge.bridge import Bridge
from firm_hdl.node.bridge.counters import summary_lines
from firm_hdl.node.control import Register
from firm_hdl.terminal import stage

__all__ = ["Status", "account", "status_line"]

_LOG_SECONDS = 10.0
"""How often the line is printed where it cannot be replaced."""

_WAY_LOSSES = ("lost", "held back")
"""What counts messages on the way from a board. Anything else says why some were lost."""

_GRAPH_SIGNS = ("overwritten",)
"""What readers may have got all the same."""

_LINK_SIGNS = ("late", "cut", "stray", "malformed")
"""The same of a board's link, which counts the messages as lost when the next one comes."""


class Status:
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
        self._next = 0.0 if self._replaces else time.monotonic() + _LOG_SECONDS

    def report(self, text: str) -> None:
        """Print a line that stays."""
        self._print(text, "\n")

    def show(self, bridge: Bridge) -> None:
        """Print the line of figures if it is due."""
        # The start is over, and this line is in place of that of the command.
        stage("")
        now = time.monotonic()
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

    Parameters
    ----------
    rates : pair of float
        Messages per second to the board, and to the graph.
    """
    dropped = bridge.counters.dropped.total()
    parts = [
        f"{bridge.description.node}",
        "ready" if bridge.is_ready else "no board",
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
    yield from summary_lines(bridge.description, bridge.counters)
    for name, value in _drops(bridge):
        yield f"dropped: {value} {name}"
    for name, value in _signs(bridge):
        yield f"seen: {value} {name}"
    if not bridge.was_ready:
        yield "the board has never answered"
    elif bridge.restarts:
        yield f"the board was started again or lost {bridge.restarts} times"
    if bridge.was_ready and not bridge.side.has_read_last:
        yield "not all counters on the board could be read at the end"


def _drops(bridge: Bridge) -> Iterator[tuple[str, int]]:
    """Yield the losses that the bridge did not cause, with where they happened."""
    for name, value in _way(bridge):
        if name in _WAY_LOSSES:
            yield f"on the way from the board: {name}", value
    for name, value in sorted(bridge.graph.counters.items()):
        if value and name not in _GRAPH_SIGNS:
            yield f"in the graph: {name}", value
    for register, value in bridge.last_drops:
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
    for register, value in bridge.last_drops:
        if _is_sign(register):
            yield f"on the board, {register.owner} {register.part}: {register.name}", value


def _way(bridge: Bridge) -> list[tuple[str, int]]:
    return sorted(bridge.on_the_way.items())


def _is_sign(register: Register) -> bool:
    return register.part == "link" and register.name in _LINK_SIGNS
