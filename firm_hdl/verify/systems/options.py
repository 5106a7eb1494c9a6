"""The request of a user and the options of test systems: names, defaults, and commands.

This module imports next to nothing. So a call with a wrong argument or an unusable type fails
without waiting for slow imports. A test compares the names with the objects that they stand for.
"""

from __future__ import annotations

import shlex
from dataclasses import dataclass, fields, replace

from firm_hdl.wire import Wire

__all__ = [
    "CLIENT_NAMES",
    "LONGEST",
    "MOST_MESSAGES",
    "NO_REFERENCE",
    "ORACLE_NAMES",
    "SIMULATOR_NAMES",
    "SYSTEM_NAMES",
    "WRITER_NAMES",
    "CaseOptions",
    "Request",
    "command_again",
    "option_of",
]

SYSTEM_NAMES = ("ts1", "ts2", "ts3", "bench", "board")
"""Test systems: :data:`firm_hdl.verify.run.SYSTEMS`."""

ORACLE_NAMES = (
    "genmsg",
    "rosidl_adapter",
    "rosidl_parser",
    "rosidl_adapter-4.6",
    "rosidl_parser-4.6",
    "rosidl_adapter-4.9",
    "rosidl_parser-4.9",
    "rosbags",
    "ros2",
)
"""Oracles of TS1: :data:`firm_hdl.verify.ts1.oracles.ORACLES`."""

SIMULATOR_NAMES = ("ghdl", "iverilog", "verilator")
"""Simulators of exported text: :data:`firm_hdl.verify.simulators.programs.SIMULATORS`."""

CLIENT_NAMES = (
    "firm-hdl",
    "rosbags",
    "genpy",
    "fastcdr",
    "fastcdr-2.2",
    "fastcdr-2.3",
    "cyclonedds",
    "mcap-ros1",
    "mcap-ros2",
)
"""Client libraries: :data:`firm_hdl.verify.references.clients.CLIENTS`."""

WRITER_NAMES = ("genpy", "fastcdr", "fastcdr-2.2", "fastcdr-2.3", "cyclonedds")
"""Client libraries that can be references of TS3.

They are the keys of :data:`firm_hdl.verify.references.clients.WRITERS`.
"""

NO_REFERENCE = "none"
"""The value of ``--reference`` for which no library has to confirm rosbags' bytes."""

MOST_MESSAGES = 100
"""Default limit for the messages of each type that are replayed from recordings."""

LONGEST = 1 << 18
"""Default size in bytes of the longest recorded message to replay, which takes about a minute."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CaseOptions:
    """How a type is tested."""

    bus_bytes: int = 8
    wire: Wire | None = None  # `None`: that of the distribution.
    seed: int = 0
    # Whether to run with stalls, and with broken packets, as well.
    stalled: bool = True
    broken: bool = True
    most_cases: int | None = None
    # `python`, or the simulator of exported text in which every run is replayed: a key of
    # `firm_hdl.verify.simulators.programs.SIMULATORS`.
    simulator: str = "python"
    # Folders with ROS packages. They are searched before the distribution's own types.
    paths: tuple[str, ...] = ()
    # Folders with packages that others depend on, searched after `paths`. Their types are not
    # tested if no type is named.
    depends: tuple[str, ...] = ()
    # Recordings whose messages are replayed. All definitions come from the recordings then.
    bags: tuple[str, ...] = ()
    longest: int = LONGEST  # Size of the longest recorded message to replay, in bytes.
    # Libraries that have to write the same bytes as rosbags; `None`: all that are installed.
    references: tuple[str, ...] | None = None
    vcd: str | None = None  # Folder for a waveform of each run.
    # Whether the circuit is simulated, and not only the golden model. It need not be if the same
    # circuit is simulated for another type.
    simulated: bool = True

    @property
    def folders(self) -> list[str]:
        """The folders that are searched, as options of a test."""
        return [f"path={path}" for path in self.paths] + [
            f"depends={path}" for path in self.depends
        ]


@dataclass(frozen=True, slots=True, kw_only=True)
class Request(CaseOptions):
    """The checked arguments of ``firm-hdl verify``."""

    types: tuple[str, ...] = ()  # Empty: all types.
    distros: tuple[str, ...] = ()  # Empty: the default of `--distro`.
    systems: tuple[str, ...] = ("ts3",)  # Names of test systems, in the order in which they run.
    # Client libraries under test. If there are any, no test system runs.
    libraries: tuple[str, ...] = ()
    widths: tuple[int, ...] = (8,)  # Buses, in bytes; see `each_width`.
    jobs: int | None = None  # Processes; `None`: one per processor.
    oracles: tuple[str, ...] = ()  # Oracles of TS1; empty: all that are installed.
    golden: str | None = None  # Folder of golden plans.
    # Whether one type is simulated for all that have the same circuit. `None`: only if all types
    # are tested, and no recording.
    share_circuits: bool | None = None
    # Board for the test system `board`, as `firm_hdl.node.boards.board_of` takes it.
    board: str | None = None
    # File with the description of the board's node; `None`: one that loops the named types.
    node: str | None = None
    engine: str = "auto"  # Engine of a simulated board.
    # How long a board may be silent; `None`: the default of its kind.
    silent_seconds: float | None = None
    # Files to write.
    results: str | None = None
    report: str | None = None

    @property
    def is_ts1_alone(self) -> bool:
        """Whether only TS1 runs, which looks up types by itself."""
        return self.systems == ("ts1",) and not self.libraries

    @property
    def is_named(self) -> bool:
        """Whether the user named what is tested. The types of a description are named, too."""
        return bool(self.types or self.node)

    @property
    def names_wires(self) -> bool:
        """Whether the user chose the wire formats, by name or by distributions."""
        return bool(self.distros or self.wire)

    @property
    def shares_circuits(self) -> bool:
        """Whether one type is simulated for all that have the same circuit."""
        if self.share_circuits is not None:
            return self.share_circuits
        # A user who names a type wants it simulated. A recording has messages for each type.
        return not self.types and not self.bags

    @property
    def kept(self) -> dict[str, object]:
        """The options that results depend on, as JSON values. Types are in the tests."""
        free = {"types", "jobs", "results", "report", "vcd", "silent_seconds"}
        names = [each.name for each in fields(self) if each.name not in free | {"simulated"}]
        found = {option_of(name): getattr(self, name) for name in names if option_of(name)}
        found["share_circuits"] = self.shares_circuits
        return {n: list(v) if isinstance(v, tuple) else v for n, v in found.items()}

    @property
    def each_width(self) -> list[CaseOptions]:
        """The options for each of the buses."""
        return [replace(self, bus_bytes=width) for width in self.widths]


_CALLED = {
    "distros": "distro",
    "paths": "path",
    "bags": "bag",
    "libraries": "sut",
    "widths": "bus_bytes",
    "oracles": "oracle",
    "references": "reference",
    "most_cases": "cases",
    "stalled": "stalls",
    "longest": "max_message_bytes",
}


def option_of(name: str) -> str:
    """Return the option of an attribute of `Request`, with underscores for dashes."""
    # `bus_bytes` is one of `widths`, which `each_width` sets.
    return "" if name == "bus_bytes" else _CALLED.get(name, name)


def command_again(*names: str, **options: object) -> str:
    """Return a call of ``firm-hdl verify``.

    * `*names`: the names of what is tested, which come last.
    * `**options`: options by their names, with underscores for dashes, in order. `None` and `False`
      leave an option out. `True` is an option without a value. A tuple repeats the option.
    """
    words = ["firm-hdl", "verify"]
    for option, value in options.items():
        for each in value if isinstance(value, tuple) else (value,):
            if each is not None and each is not False:
                words.append(f"--{option.replace('_', '-')}")
                words += [] if each is True else [str(each)]
    return shlex.join([*words, *names])
