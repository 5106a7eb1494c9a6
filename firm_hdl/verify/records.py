"""What a test system found out about one type, as data that outlives the run.

A `Test` says what is tested, and its key is the same in every run of every version; a `Record` says
what became of it. Both are written as JSON and read back by :mod:`firm_hdl.verify.results`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from typing import Any, Literal, get_args

__all__ = ["STAGES", "STATUSES", "PlanCoverage", "Record", "Seconds", "Status", "Test"]

Status = Literal["pass", "fail", "skipped"]
STATUSES: tuple[Status, ...] = get_args(Status)

STAGES = ("generation", "simulation", "testing")
"""The stages of a test, in order; `Seconds` has them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Test:
    """One test of one type by one test system.

    Attributes
    ----------
    system : str
        ``ts1``, ``ts2`` or ``ts3``.
    distro, type : str
    same : tuple of str
        All distributions that the result counts for, `distro` included: those that have the type
        just so.
    simulator : str
        Empty if nothing is simulated.
    wire : str
        ``ros1`` or ``cdr``; empty if the definition alone is looked at.
    bus_bytes : int
        0 if there is no circuit.
    options : str
        What else makes results differ, such as ``seed=0``.
    """

    # Pytest takes classes of this name for tests.
    __test__ = False

    system: str
    distro: str
    type: str
    same: tuple[str, ...] = ()
    simulator: str = ""
    wire: str = ""
    bus_bytes: int = 0
    options: str = ""

    @property
    def key(self) -> str:
        """What tells tests apart."""
        circuit = f"{self.wire}/{self.bus_bytes}" if self.bus_bytes else self.wire
        parts = (self.system, self.simulator, self.distro, self.type, circuit, self.options)
        return " ".join(part for part in parts if part)

    @property
    def distros(self) -> tuple[str, ...]:
        """The distributions that the result counts for."""
        return self.same or (self.distro,)

    @property
    def package(self) -> str:
        """The ROS package that the type is in."""
        return self.type.partition("/")[0]


@dataclass(frozen=True, slots=True, kw_only=True)
class Seconds:
    """How long the stages of a test took.

    Attributes
    ----------
    generation : float
        From the definition to cases and to a circuit that is ready to run.
    simulation : float
    testing : float
        Comparing what came out with the oracle and with the golden model.
    """

    generation: float = 0.0
    simulation: float = 0.0
    testing: float = 0.0

    @property
    def total(self) -> float:
        """All stages together."""
        return self.generation + self.simulation + self.testing


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanCoverage:
    """Which decisions of a plan the packets of a test took.

    Attributes
    ----------
    taken, possible : int
    missing : tuple of str
        Names of those that were not taken.
    """

    taken: int
    possible: int
    missing: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Record:
    """What became of a test.

    Attributes
    ----------
    status : "pass", "fail" or "skipped"
    reason : str
        Why it was skipped.
    failures : tuple of str
    note : str
        What is to be known about the oracle.
    seconds : Seconds
        By the clock on the wall.
    cpu_seconds : float
    cases, packets, cycles, beats : int
        Cases of the type; packets and cycles of all runs; beats of one run of all cases.
    coverage : PlanCoverage or None
    metrics : mapping of str to float
        Figures of the type and of its plan.
    shape : str
        Digest of the plan without names: types with the same one have the same circuit.
    same_as : str
        Name of the type whose circuit, tested by the same test, is this one's; empty if this one's
        own was simulated.
    command : str
        Repeats the test.
    waveform_command : str
        Repeats it and writes a waveform; empty if there is none.
    """

    test: Test
    status: Status
    reason: str = ""
    failures: tuple[str, ...] = ()
    note: str = ""
    seconds: Seconds = field(default_factory=Seconds)
    cpu_seconds: float = 0.0
    cases: int = 0
    packets: int = 0
    cycles: int = 0
    beats: int = 0
    coverage: PlanCoverage | None = None
    metrics: Mapping[str, float] = field(default_factory=dict)
    shape: str = ""
    same_as: str = ""
    command: str = ""
    waveform_command: str = ""

    def __post_init__(self) -> None:
        if self.status not in STATUSES:
            raise ValueError(f"Status must be one of {', '.join(STATUSES)}, not {self.status!r}")
        if (self.status == "fail") != bool(self.failures):
            raise ValueError(
                f"A test with status {self.status!r} has {len(self.failures)} failures"
            )
        if self.status == "skipped" and not self.reason:
            raise ValueError("A test that was skipped must have a reason")

    @property
    def without_times(self) -> Record:
        """The same but for how long it took, which differs from run to run."""
        return replace(self, seconds=Seconds(), cpu_seconds=0.0)

    def as_json(self) -> dict[str, Any]:
        """Return what `from_json` reads; what is empty is left out."""
        return _without_empty(asdict(self))

    @classmethod
    def from_json(cls, given: object) -> Record:
        """Return a record that was written by `as_json`.

        Raises
        ------
        ValueError
            If it is none.
        """
        values = dict(_mapping(given, "A record"))
        values["test"] = _made(Test, values.get("test"))
        if "seconds" in values:
            values["seconds"] = _made(Seconds, values["seconds"])
        if "coverage" in values:
            values["coverage"] = _made(PlanCoverage, values["coverage"])
        record: Record = _made(cls, values)
        return record


def _without_empty(values: dict[str, Any]) -> dict[str, Any]:
    found = {}
    for name, value in values.items():
        if isinstance(value, dict) and name != "coverage":
            value = _without_empty(value)
        if value or name in ("status", "test"):
            found[name] = value
    return found


def _mapping(given: object, what: str) -> dict[str, Any]:
    if not isinstance(given, dict):
        raise ValueError(f"{what} must be an object, not {type(given).__name__}")
    return given


def _made(kind: type[Any], given: object) -> Any:
    """Make a dataclass of an object that JSON was read to, lists as tuples."""
    values = _mapping(given, kind.__name__)
    known = {item.name for item in fields(kind)}
    if unknown := sorted(set(values) - known):
        raise ValueError(f"{kind.__name__} has no {', '.join(unknown)}")
    try:
        return kind(
            **{n: tuple(v) if isinstance(v, list) else v for n, v in values.items()},
        )
    except TypeError as error:
        raise ValueError(f"{kind.__name__}: {error}") from None
