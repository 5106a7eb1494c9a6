"""What a test system found out about one type, as data that outlives the run.

A `Test` says what is tested, and its key is the same in every run of every version; a `Record` says
what became of it. Both are written as JSON and read back by :mod:`firm_hdl.verify.results.file`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import Any, get_args, get_origin, get_type_hints

from firm_hdl.verify.results.texts import clipped
from firm_hdl.verify.results.verdict import (
    Failed,
    KnownDifference,
    NotJudged,
    Passed,
    Verdict,
    verdict_from_json,
    verdict_to_json,
)

__all__ = [
    "STAGES",
    "OracleVerdict",
    "PlanCoverage",
    "Record",
    "Seconds",
    "Test",
    "clipped_verdict",
    "settled",
]

MOST_FAILURES = 20
MOST_CHARACTERS = 4000

STAGES = ("generation", "simulation", "testing")
"""The stages of a test, in order; `Seconds` has them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Test:
    """One test of one type by one test system.

    Attributes
    ----------
    system : str
        ``ts1``, ``ts2``, ``ts3`` or ``bench``.
    distro, type : str
        The type is a message; that of ``ts1`` is what a file defines, which may be a service.
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
    def title(self) -> str:
        """What people read it by."""
        bus = f", {self.bus_bytes}-byte bus" if self.bus_bytes else ""
        return f"{self.type} ({', '.join(self.distros)}), {self.system}{bus}"

    @classmethod
    def from_json(cls, given: object) -> Test:
        """Return a test that was written as an object of its attributes.

        Raises
        ------
        ValueError
            If it is none.
        """
        test: Test = _made(cls, given)
        return test

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
        From the definition to what is tested: the model, the plan, or a circuit that is ready to
        run, with its cases.
    simulation : float
    testing : float
        Asking oracles and comparing: what came out with the oracle and with the golden model, the
        plan with its layout, the model with what others read.
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
class OracleVerdict:
    """What an oracle of definitions says of a type.

    Attributes
    ----------
    oracle : str
    verdict : Verdict
        Cases are facts that were compared.
    is_refused : bool
        Whether both refuse the definition.
    """

    oracle: str
    verdict: Verdict
    is_refused: bool = False

    def as_json(self) -> dict[str, Any]:
        """Return what `from_json` reads."""
        found = {"oracle": self.oracle, **verdict_to_json(self.verdict)}
        if self.is_refused:
            found["is_refused"] = True
        return found

    @classmethod
    def from_json(cls, given: object) -> OracleVerdict:
        """Return what `as_json` wrote.

        Raises
        ------
        ValueError
            If it is none.
        """
        values = dict(_mapping(given, "What an oracle says"))
        own: dict[str, Any] = {n: values.pop(n) for n in ("oracle", "is_refused") if n in values}
        own["verdict"] = verdict_from_json(values)
        made: OracleVerdict = _made(cls, own)
        return made


@dataclass(frozen=True, slots=True, kw_only=True)
class Record:
    """What became of a test.

    Attributes
    ----------
    verdict : Verdict
        See `settled` for a test that rests on another one's circuit.
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
    verdicts : tuple of OracleVerdict
        Of all oracles that read the definition.
    written_by : tuple of str
        Libraries that wrote its packets, all from the same values.
    command : str
        Repeats the test.
    waveform_command : str
        Repeats it and writes a waveform; empty if there is none.
    """

    test: Test
    verdict: Verdict
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
    verdicts: tuple[OracleVerdict, ...] = ()
    written_by: tuple[str, ...] = ()
    command: str = ""
    waveform_command: str = ""

    def __post_init__(self) -> None:
        if not isinstance(self.verdict, Passed | Failed | NotJudged | KnownDifference):
            raise ValueError(f"What became of a test must be a verdict, not {self.verdict!r}")

    @property
    def without_times(self) -> Record:
        """The same but for how long it took, which differs from run to run."""
        return replace(self, seconds=Seconds(), cpu_seconds=0.0)

    def as_json(self) -> dict[str, Any]:
        """Return what `from_json` reads: without what is empty, and times in microseconds."""
        found = _without_empty(asdict(self))
        found["verdict"] = verdict_to_json(self.verdict)
        if self.verdicts:
            found["verdicts"] = [each.as_json() for each in self.verdicts]
        return found

    @classmethod
    def from_json(cls, given: object) -> Record:
        """Return a record that was written by `as_json`.

        Raises
        ------
        ValueError
            If it is none.
        """
        values = dict(_mapping(given, "A record"))
        values["test"] = Test.from_json(values.get("test"))
        values["verdict"] = verdict_from_json(values.get("verdict"))
        if "seconds" in values:
            values["seconds"] = _made(Seconds, values["seconds"])
        if "verdicts" in values:
            values["verdicts"] = tuple(map(OracleVerdict.from_json, values["verdicts"]))
        if "coverage" in values:
            values["coverage"] = _made(PlanCoverage, values["coverage"])
        record: Record = _made(cls, values)
        return record


def _clipped(failures: Sequence[str]) -> tuple[str, ...]:
    """Return failures as a record keeps them: not too many, and none too long."""
    found = [clipped(text, MOST_CHARACTERS) for text in failures[:MOST_FAILURES]]
    if len(failures) > MOST_FAILURES:
        found.append(f"and {len(failures) - MOST_FAILURES} more")
    return tuple(found)


def clipped_verdict(verdict: Verdict) -> Verdict:
    """Return a verdict as a record keeps it: without too many failures, and no long texts."""
    match verdict:
        case Failed(failures):
            return Failed(_clipped(failures))
        case NotJudged(reason):
            return NotJudged(_clipped([reason])[0])
        case _:
            return verdict


def settled(record: Record, records: Mapping[str, Record]) -> Verdict:
    """Return what a test is worth: one that rests on the circuit of another, that one's verdict.

    Parameters
    ----------
    records : mapping of str to Record
        By key.
    """
    if isinstance(record.verdict, Failed | NotJudged) or not record.same_as:
        return record.verdict
    other = records.get(record.same_as)
    if other is None:
        return NotJudged(f"has the circuit of '{record.same_as}', of which there is no result")
    if isinstance(other.verdict, NotJudged):
        return NotJudged(f"has the circuit of '{record.same_as}', which was not judged")
    if other.shape != record.shape:
        return Failed((f"not the circuit of '{record.same_as}', as its record says",))
    if isinstance(other.verdict, Failed):
        return Failed((f"has the circuit of '{record.same_as}', which failed",))
    return record.verdict


def _without_empty(values: dict[str, Any]) -> dict[str, Any]:
    found = {}
    for name, value in values.items():
        if isinstance(value, dict) and name != "coverage":
            value = _without_empty(value)
        if isinstance(value, float):
            value = round(value, 6)
        if value or name in ("verdict", "test"):
            found[name] = value
    return found


_JSON = {dict: "an object", list: "a list", str: "a text", bool: "a truth value"}
"""What values that JSON has are called; all others but null are numbers."""


def _mapping(given: object, what: str) -> dict[str, Any]:
    if not isinstance(given, dict):
        kind = "nothing" if given is None else _JSON.get(type(given), "a number")
        raise ValueError(f"{what} must be an object, not {kind}")
    return given


def _made(kind: type[Any], given: object) -> Any:
    """Make a dataclass of an object that JSON was read to, lists as tuples."""
    values = _mapping(given, kind.__name__)
    if unknown := sorted(values.keys() - kind.__dataclass_fields__.keys()):
        raise ValueError(f"{kind.__name__} has no {', '.join(unknown)}")
    for name, value in values.items():
        if not _fits(value, _HINTS[kind][name]):
            raise ValueError(f"{kind.__name__}: {name} must be of another type")
    try:
        return kind(**{n: tuple(v) if type(v) is list else v for n, v in values.items()})
    except TypeError as error:
        raise ValueError(f"{kind.__name__}: {error}") from None


_HINTS = {
    kind: get_type_hints(kind) for kind in (Test, Seconds, PlanCoverage, OracleVerdict, Record)
}


def _fits(value: object, hint: Any) -> bool:
    """Tell whether a value that JSON was read to can be that of an attribute."""
    origin, arguments = get_origin(hint), get_args(hint)
    if origin is tuple:
        return isinstance(value, list | tuple) and all(_fits(v, arguments[0]) for v in value)
    if origin is Mapping:
        return isinstance(value, dict) and all(_fits(v, arguments[1]) for v in value.values())
    if hint is float:
        return type(value) in (int, float)
    # A truth value is no number.
    return type(value) is hint if hint is int else isinstance(value, hint)
