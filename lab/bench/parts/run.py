"""Parts, each measured in a process of its own."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from amaranth.back import rtlil

from firm_hdl.bench.devices import DEVICES
from firm_hdl.bench.flow import Measured
from firm_hdl.bench.run import measure_once
from firm_hdl.bench.tools import BenchError
from firm_hdl.jobs import run_each
from lab.bench.parts.standard import PARTS, Part

__all__ = ["PART_DEVICE", "PartResult", "run_parts"]

PART_DEVICE = "ecp5"
SEEDS = (1, 2, 3)


@dataclass(frozen=True, slots=True, kw_only=True)
class PartResult:
    """The figures of a part.

    Attributes
    ----------
    part : Part
    measured : Measured or None
        `None` if a tool failed.
    problem : str
        Why figures are missing; else empty.
    """

    part: Part
    measured: Measured | None = None
    problem: str = ""


def run_parts(
    *,
    parts: Sequence[int] = range(len(PARTS)),
    seeds: Sequence[int] = SEEDS,
    cache: str | None = None,
    jobs: int | None = None,
) -> Iterator[PartResult]:
    """Measure parts on ECP5-8 in `jobs` processes; yield results as they finish.

    Parameters
    ----------
    parts : sequence of int
        Places in `PARTS`.
    seeds : sequence of int
        Seeds of nextpnr, one run each.
    cache : str or None
        Folder with figures that were computed before.
    """
    work = [(index, (index, tuple(seeds), cache)) for index in parts]
    for index, found in run_each(measure_part, work, jobs=jobs):
        part = PARTS[index]
        if isinstance(found, Measured):
            yield PartResult(part=part, measured=found, problem=found.problem)
        else:
            yield PartResult(part=part, problem=str(found))


def measure_part(index: int, seeds: tuple[int, ...], cache: str | None) -> Measured | str:
    """Measure a part, given by its place in `PARTS`; return why it has no area if a tool fails.

    A place can be sent to another process; a part cannot, because it contains a function.
    """
    text = rtlil.convert(PARTS[index].make(), name="top", emit_src=False)
    try:
        return measure_once(
            text,
            DEVICES[PART_DEVICE],
            seeds,
            mapping="",
            folder=None if cache is None else Path(cache),
        )
    except BenchError as error:
        return str(error)
