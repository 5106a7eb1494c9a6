"""One run of a bench: what is sent and observed, and under which conditions."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from firm_hdl.gateware.limits import check_integer
from firm_hdl.sim.stalls import StallPlan, check_stalls

__all__ = ["Job", "RunOptions"]


@dataclass(frozen=True, slots=True, kw_only=True)
class RunOptions:
    """The conditions of a run.

    Attributes
    ----------
    stalls : Stalls, mapping or None
        Stalls of all streams, or of streams by name.
    deadline : int
        Most cycles in a row without any transfer, in addition to the longest stall.
    limit : int or None
        Most cycles in total. `None`: 1,000,000; for a :class:`.Harness`, many more than any valid
        packets take.
    settle : int
        Cycles without any transfer after which a finished run ends.
    vcd : path or None
        File for a waveform, which makes the run slow.
    observe : callable or None
        Called with the values of the bench's probes, before the first clock edge and then in each
        cycle after all signals have settled.
    """

    stalls: StallPlan = None
    deadline: int = 1000
    limit: int | None = None
    settle: int = 4
    vcd: str | os.PathLike[str] | None = None
    observe: Callable[[list[int]], None] | None = None

    def __post_init__(self) -> None:
        check_stalls(self.stalls)
        check_integer("deadline=", self.deadline)
        check_integer("settle=", self.settle)
        if self.limit is not None:
            check_integer("limit=", self.limit)


@dataclass(frozen=True, slots=True, kw_only=True)
class Job:
    """One run of a bench.

    Attributes
    ----------
    sources : dict of str to iterable of int
        Payloads to send, as bits, by the name of the stream.
    takes : dict of str to callable
        Functions by the name of a stream. They are called at each transfer of the stream, with the
        cycle and the payload's bits.
    finished : callable
        Returns whether everything expected has come; called after each cycle with a transfer.
    outstanding : callable
        Returns a text of what has not come yet, for the error.
    options : RunOptions
    """

    sources: dict[str, Iterable[int]]
    takes: dict[str, Callable[[int, int], None]]
    finished: Callable[[], bool]
    outstanding: Callable[[], str]
    options: RunOptions = RunOptions()
