"""The result of one test as data that outlives the run.

A `Test` says what is tested. Its key is the same in every run of every version. A `Record` is the
result of a test. :mod:`firm_hdl.verify.results.file` writes both as JSON and reads them back.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import MISSING, dataclass, field, fields
from types import NoneType, UnionType
from typing import Any, TypeVar, get_args, get_origin, get_type_hints

from firm_hdl.verify.results.verdict import Failed, NotJudged, NotRun, Verdict, clipped

__all__ = [
    "STAGES",
    "OracleVerdict",
    "PlanCoverage",
    "Record",
    "Seconds",
    "Test",
    "clipped_verdict",
    "from_json",
    "settled",
    "to_json",
]

T = TypeVar("T")

MOST_FAILURES = 20
MOST_CHARACTERS = 4000

MOST_COUNTED = 10**100
"""Largest number of a record: types have no more leaves, and reports can square it."""

STAGES = ("generation", "simulation", "testing")
"""The stages of a test, in order; `Seconds` has them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Test:
    """One test of one type by one test system."""

    # Pytest takes classes of this name for tests.
    __test__ = False

    system: str  # `ts1`, `ts2`, `ts3`, `bench` or `board`.
    # The type is a message. For `ts1`, the type is what a file defines, such as a service. `distro`
    # is empty for what concerns all of them.
    distro: str
    type: str
    # All distributions that the result counts for, `distro` included: those with an equal
    # definition of the type.
    same: tuple[str, ...] = ()
    simulator: str = ""  # Empty if nothing is simulated.
    wire: str = ""  # `ros1` or `cdr`; empty if only the definition is tested.
    bus_bytes: int = 0  # 0 if no circuit is tested.
    options: str = ""  # Everything else that results depend on, such as `seed=0`.

    @property
    def key(self) -> str:
        """The key that identifies the test."""
        circuit = f"{self.wire}/{self.bus_bytes}" if self.bus_bytes else self.wire
        parts = (self.system, self.simulator, self.distro, self.type, circuit, self.options)
        return " ".join(part for part in parts if part)

    @property
    def title(self) -> str:
        """The name of the test for people."""
        distros = f" ({', '.join(self.distros)})" if self.distro else ""
        bus = f", {self.bus_bytes}-byte bus" if self.bus_bytes else ""
        return f"{self.type}{distros}, {self.system}{bus}"

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
    """The duration of each stage of a test."""

    # From the definition to the object under test: the model, the plan, or a circuit that is ready
    # to run, with its cases.
    generation: float = 0.0
    simulation: float = 0.0
    # Asking oracles and comparing. TS3 compares the output with the oracle and the golden model,
    # TS2 the plan with its layout, and TS1 the model with the readings of oracles.
    testing: float = 0.0

    @property
    def total(self) -> float:
        """The sum of all stages."""
        return self.generation + self.simulation + self.testing


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanCoverage:
    """The decisions of a plan that the packets of a test took."""

    taken: int
    possible: int
    missing: tuple[str, ...] = ()  # Names of the decisions that were not taken.


@dataclass(frozen=True, slots=True, kw_only=True)
class OracleVerdict:
    """The verdict on a type by one oracle of definitions."""

    oracle: str
    verdict: Verdict  # Its cases are the facts that were compared.
    is_refused: bool = False  # Whether both refuse the definition.


@dataclass(slots=True, kw_only=True)
class Record:
    """The result of a test. While the test runs, its figures are added."""

    test: Test
    # The verdict of this test alone. For a test that relies on the circuit of another test, see
    # `settled`.
    verdict: Verdict
    note: str = ""  # A remark about the oracle.
    seconds: Seconds = field(default_factory=Seconds)  # Wall-clock time.
    cpu_seconds: float = 0.0
    # Cases of the type; packets and cycles of all runs; beats of one run of all cases.
    cases: int = 0
    packets: int = 0
    cycles: int = 0
    beats: int = 0
    coverage: PlanCoverage | None = None
    metrics: dict[str, float] = field(default_factory=dict)  # Figures of the type and of its plan.
    # Digest of the plan without names. Types with equal digests have the same circuit.
    shape: str = ""
    # Key of the test that simulated the same circuit for another type; empty if the circuit of this
    # type was simulated.
    same_as: str = ""
    # The verdicts of all oracles that read the definition.
    verdicts: tuple[OracleVerdict, ...] = ()
    written_by: tuple[str, ...] = ()  # Libraries that wrote the packets, all from the same values.
    command: str = ""  # The command that repeats the test.
    # The command that repeats the test and writes a waveform; empty if there is none.
    waveform_command: str = ""

    @property
    def failures(self) -> tuple[str, ...]:
        """The failures; none if the test did not fail."""
        return self.verdict.failures if isinstance(self.verdict, Failed) else ()

    def add_note(self, what: str) -> None:
        """Add to the note."""
        self.note = "; ".join(filter(None, [self.note, what]))

    def __post_init__(self) -> None:
        if not isinstance(self.verdict, Verdict):
            raise ValueError(f"What became of a test must be a verdict, not {self.verdict!r}")


def _clipped(failures: Sequence[str]) -> tuple[str, ...]:
    """Return at most `MOST_FAILURES` failures, of at most `MOST_CHARACTERS` each."""
    found = [clipped(text, MOST_CHARACTERS) for text in failures[:MOST_FAILURES]]
    if len(failures) > MOST_FAILURES:
        found.append(f"and {len(failures) - MOST_FAILURES} more")
    return tuple(found)


def clipped_verdict(verdict: Verdict) -> Verdict:
    """Return a verdict for a record: the number and the length of its texts are limited."""
    match verdict:
        case Failed(failures):
            return Failed(_clipped(failures))
        case NotJudged(reason):
            return NotJudged(_clipped([reason])[0])
        case _:
            return verdict


def settled(record: Record, records: Mapping[str, Record]) -> Verdict | NotRun:
    """Return the verdict that counts. It depends on the test that simulated the circuit, too.

    * `records`: records of all tests, by key.
    """
    if isinstance(record.verdict, Failed | NotJudged) or not record.same_as:
        return record.verdict
    other = records.get(record.same_as)
    if other is None:
        return NotRun(f"has the circuit of '{record.same_as}', which was not run")
    if isinstance(other.verdict, NotJudged):
        return NotJudged(f"has the circuit of '{record.same_as}', which was not judged")
    if other.shape != record.shape:
        return Failed((f"not the circuit of '{record.same_as}', as its record says",))
    if isinstance(other.verdict, Failed):
        return Failed((f"has the circuit of '{record.same_as}', which failed",))
    return record.verdict


def to_json(value: Any) -> Any:
    """Return a record, or a part of one, in values that JSON can represent.

    A dataclass becomes an object. Empty values are left out unless they are required. Floats are
    rounded to 6 decimal places; so times are rounded to microseconds.
    """
    match value:
        case float():
            return round(value, 6)
        case tuple():
            return list(map(to_json, value))
        case Mapping():
            found = {name: to_json(each) for name, each in value.items()}
            return {name: each for name, each in found.items() if each}
        case _ if type(value) in _HINTS:
            found = {each.name: to_json(getattr(value, each.name)) for each in fields(value)}
            required = _REQUIRED[type(value)]
            found = {name: each for name, each in found.items() if each or name in required}
            if isinstance(value, Verdict):
                return {"verdict": value.name, **found}
            # The object of an `OracleVerdict` has the names of its verdict beside its own.
            verdict = found.pop("verdict") if isinstance(value, OracleVerdict) else {}
            return found | verdict
        case _:
            return value


def from_json(kind: type[T], given: Any) -> T:
    """Return a record, or a part of one, from an object that `to_json` wrote.

    Raises `ValueError` or `TypeError` if the object has unknown names, or lacks one, or has a value
    of another type, or a number that nothing that is counted or measured can have.
    """
    hints = _HINTS[kind]
    if kind is OracleVerdict:
        own = {name: given[name] for name in ("oracle", "is_refused") if name in given}
        given = {**own, "verdict": {n: each for n, each in given.items() if n not in own}}
    if not isinstance(given, dict) or not given.keys() <= hints.keys():
        raise ValueError(f"{kind.__name__} has other attributes")
    return kind(**{name: _read(hints[name], each) for name, each in given.items()})


def _read(hint: Any, given: Any) -> Any:
    """Return the value of an attribute. One that is `None` is not in the JSON."""
    if hint == Verdict:
        name = given["verdict"]
        return from_json(_VERDICTS[name], {n: each for n, each in given.items() if n != "verdict"})
    kinds = [each for each in get_args(hint) if each not in (NoneType, Ellipsis)]
    if get_origin(hint) is tuple and type(given) is list:
        return tuple(_read(kinds[0], each) for each in given)
    if get_origin(hint) is dict and type(given) is dict:
        return {name: _read(kinds[1], each) for name, each in given.items()}
    hint = kinds[0] if get_origin(hint) is UnionType else hint
    if hint in _HINTS:
        return from_json(hint, given)
    # Compare types exactly, because a bool of Python is an int as well.
    if type(given) is not hint and (hint, type(given)) != (float, int):
        raise TypeError(f"{given!r} is no {hint}")
    if isinstance(given, int | float) and not 0 <= given <= MOST_COUNTED:
        raise ValueError(f"{given!r} is out of range")
    # As it would have been written: a logarithmic axis has no room for the smallest floats.
    return to_json(given)


_VERDICTS: dict[str, Any] = {each.name: each for each in get_args(Verdict)}
_KINDS = (Test, Seconds, PlanCoverage, OracleVerdict, Record, *_VERDICTS.values())
_HINTS: dict[Any, dict[str, Any]] = {
    kind: {f.name: get_type_hints(kind)[f.name] for f in fields(kind)} for kind in _KINDS
}
_REQUIRED: dict[Any, set[str]] = {
    kind: {f.name for f in fields(kind) if f.default is MISSING and f.default_factory is MISSING}
    for kind in _KINDS
}
