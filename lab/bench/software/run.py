"""Compare libraries and converters with the same messages."""

from __future__ import annotations

import platform
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from firm_hdl.bench.cycles import STATED, stated_messages
from firm_hdl.bench.results import Result
from firm_hdl.bench.run import BenchTask
from firm_hdl.export.build import plan_of
from firm_hdl.frontend import open_library
from firm_hdl.jobs import ProgramMissingError
from lab.bench.software.fastcdr import fastcdr_versions, time_fastcdr
from lab.bench.software.python import (
    genpy_versions,
    rosbags_versions,
    time_genpy,
    time_rosbags,
)
from lab.bench.software.sample import NoFigureError, Sample, Timed

__all__ = ["CLOCK_MHZ", "LIBRARIES", "Compared", "compare_software", "library_versions", "machine"]

CLOCK_MHZ = 156.25
"""Clock rate for the time of a converter's cycles: 8 bytes per cycle are 10 Gbit/s."""

LIBRARIES: dict[str, Callable[[Sample], Timed]] = {
    "rosbags": time_rosbags,
    "genpy": time_genpy,
    "Fast CDR": time_fastcdr,
}
"""The libraries that are timed, in the order of tables."""

_VERSIONS: dict[str, Callable[[], dict[str, str]]] = {
    "rosbags": rosbags_versions,
    "genpy": genpy_versions,
    "Fast CDR": fastcdr_versions,
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Compared:
    """One type on one wire.

    Attributes
    ----------
    bytes : float
        Mean size of a packet.
    times : mapping
        Times by name of the library.
    missing : mapping
        Reasons for missing times, by name of the library.
    results : tuple of Result
        Results of the converters, with cycles.
    """

    bytes: float
    times: Mapping[str, Timed]
    missing: Mapping[str, str]
    results: tuple[Result, ...]


def compare_software(task: BenchTask, results: Sequence[Result]) -> Compared:
    """Time the libraries with the messages of a task, one after the other, in one thread each.

    Parameters
    ----------
    task : BenchTask
        A task of the type; its direction does not matter.
    results : sequence of Result
        Converters of the same type.

    Raises
    ------
    BenchError
        If a library fails, or does not write what it has read.
    """
    what = task.converter
    library = open_library(what.distro, task.paths, task.bags, depends=task.depends)
    message = library.message(what.type)
    plan = plan_of(message, what.wire, what.bus_bytes, what.max_message_bytes)
    packets = stated_messages(plan, message, task.stated or STATED)[1][1:]
    sample = Sample(message=message, wire=what.wire, packets=tuple(packets))
    times: dict[str, Timed] = {}
    missing: dict[str, str] = {}
    for name, time in LIBRARIES.items():
        try:
            times[name] = time(sample)
        except (ProgramMissingError, NoFigureError) as error:
            missing[name] = str(error)
    return Compared(
        bytes=sum(map(len, packets)) / len(packets),
        times=times,
        missing=missing,
        results=tuple(results),
    )


def library_versions() -> dict[str, dict[str, str]]:
    """Return the versions of each library and of its Python or compiler.

    Raises
    ------
    ProgramMissingError
        If a library is not installed.
    """
    return {name: found() for name, found in _VERSIONS.items()}


def machine() -> str:
    """Return the name of the processor, if the system gives one."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    numbers = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model\t")]
    if not names:
        return platform.processor() or platform.machine()
    return names[0] + (f", model {numbers[0]}" if numbers else "")
