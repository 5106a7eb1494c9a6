"""A bridge in a time of its own."""

from __future__ import annotations

import select
from types import SimpleNamespace

import pytest

from firm_hdl.node.bridge import boardside, bridge
from tests.node.bridge.fakes import FakeBoard, FakeGraph, bridge_of

__all__ = ["Sleeper"]


class Sleeper:
    """A bridge whose clock stands still, with what it waits for in seconds.

    If `passes` is set, time passes while the bridge waits and nothing comes.
    """

    def __init__(self, monkeypatch):
        self.now, self.slept, self.passes = 100.0, [], False
        clock = SimpleNamespace(monotonic=lambda: self.now, time_ns=self._time_ns)
        for module in (bridge, boardside):
            monkeypatch.setattr(module, "time", clock)
        monkeypatch.setattr(bridge, "select", SimpleNamespace(select=self._select))
        self.board, self.graph = FakeBoard(), FakeGraph()
        # Nothing else is due of the board for seconds.
        self.board.sample_seconds = 100.0
        self.bridge, self.said = bridge_of(self.board, self.graph)

    def _time_ns(self):
        # A time of today: one of before 1973 is that of a node that has just started.
        return int((1_800_000_000 + self.now) * 1e9)

    def _select(self, reads, writes, errors, seconds):
        self.slept.append(seconds)
        found = select.select(reads, writes, errors, 0)
        if self.passes and not any(found):
            self.now += max(seconds, 1e-6)
        return found

    def sleep(self, after=0.0, end=float("inf")):
        """Let time pass; return how long the bridge then sleeps, once nothing is left to do."""
        self.now += after
        for _ in range(200):
            self.bridge.step(end)
            if self.slept[-1] > 1e-9:
                return pytest.approx(self.slept[-1])
            # Something is due, if need be after an error of rounding.
            self.now += self.slept[-1]
        raise AssertionError("it never sleeps")
