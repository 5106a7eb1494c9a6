"""Client libraries under test as a test system: each is compared with ROS's own serializers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from firm_hdl.cases import NotJudgedError
from firm_hdl.cases.effort import all_cases
from firm_hdl.cases.user_oracle import judge_of
from firm_hdl.cases.values import Plain, from_objects, shown
from firm_hdl.errors import DefinitionError
from firm_hdl.model import Message
from firm_hdl.plan import build_plan
from firm_hdl.verify.clients.divergences import Finding, known_keys
from firm_hdl.verify.clients.unusual import plain_packet, unusual_packets, unusual_values
from firm_hdl.verify.references.client import (
    Client,
    ClientDiedError,
    ClientMissingError,
    Codec,
    Refusal,
    UnsupportedError,
    each_answered,
)
from firm_hdl.verify.references.clients import (
    CLIENTS,
    REFERENCES,
    client,
    close_clients,
    find_clients,
)
from firm_hdl.verify.references.objects import full_text
from firm_hdl.verify.results.file import ResultsWriter
from firm_hdl.verify.results.records import Record, Test
from firm_hdl.verify.results.verdict import NotJudged, clipped
from firm_hdl.verify.systems.options import Request, command_again
from firm_hdl.verify.systems.system import (
    Trial,
    TypesSystem,
    as_test,
    failure_of,
    run_and_record,
    run_tests,
    summary_of,
    wire_of,
)
from firm_hdl.verify.systems.tasks import library_of
from firm_hdl.wire import Wire, lay_out

__all__ = ["Libraries", "compare", "judge_library", "reference_of"]


MOST_CHARACTERS = 400
"""A definition, a value or an answer is shown with so many characters at most."""


@dataclass(frozen=True, slots=True)
class _Asked:
    """A question to both libraries: to read `packet` or, if it is `None`, to write `value`."""

    what: str
    value: Plain
    packet: bytes | None = None


def compare(
    library: Client,
    reference: Client,
    message: Message,
    wire: Wire,
    values: Sequence[Plain],
    trial: Trial,
) -> bool:
    """Compare how two libraries write values and read packets of these values; add to the trial.

    Its cases are the questions that both were asked. Of the unknown differences of each kind, the
    one with the smallest value is a failure. An obstacle is that a library lacks the type, or that
    the reference has no answer.

    Returns whether both libraries have the type.
    """
    try:
        for each in (library, reference):
            if wire not in each.wires:
                raise UnsupportedError(f"{each.name} does not speak {wire}")
        codecs = library.open(message, wire), reference.open(message, wire)
        _compare(library, reference, codecs, message, wire, values, trial)
    except ClientDiedError as error:
        trial.failures.append(str(error))
    except UnsupportedError as error:
        trial.obstacle = NotJudged(str(error) or "the type is not supported")
        return False
    return True


def _compare(
    library: Client,
    reference: Client,
    codecs: tuple[Codec, Codec],
    message: Message,
    wire: Wire,
    values: Sequence[Plain],
    trial: Trial,
) -> None:
    written = each_answered(reference.name, values, codecs[1].encode_all(values))
    pairs = [(v, p) for v, p in zip(values, written, strict=True) if isinstance(p, bytes)]
    asked = [_Asked("encode", value) for value in values]
    asked += [_Asked("decode", value, packet) for value, packet in pairs]
    asked += [_Asked(f"encode {case}", value) for case, value in unusual_values(message, values)]
    usable = [v for v, p in pairs if plain_packet(message, wire, v) == p]
    reads_both_orders = all("big" in each.byte_orders for each in (library, reference))
    asked += [
        _Asked(case, value, packet)
        for case, value, packet in unusual_packets(message, wire, usable)
        if case != "big-endian" or reads_both_orders
    ]
    answers = [
        _answers(each.name, codec, asked)
        for each, codec in zip((library, reference), codecs, strict=True)
    ]
    known: set[str] = set()
    unknown: dict[str, Finding] = {}
    for each, got, expected in zip(asked, *answers, strict=True):
        if expected == got:
            continue
        finding = Finding(
            library=library.name,
            reference=reference.name,
            wire=wire,
            what=each.what,
            message=message,
            value=each.value,
            packet=each.packet or b"",
            expected=expected,
            got=got,
        )
        if keys := known_keys(finding, *codecs):
            known.update(keys)
        elif each.what not in unknown or finding.size < unknown[each.what].size:
            unknown[each.what] = finding
    trial.record.cases = trial.judged = len(asked)
    trial.record.metrics["comparisons"] = float(len(asked))
    trial.known = tuple(sorted(known))
    trial.failures += map(described, unknown.values())
    if all(isinstance(expected, Refusal) for expected in answers[1]):
        trial.obstacle = NotJudged(f"{reference.name} had no answer to anything")


def _answers(name: str, codec: Codec, asked: Sequence[_Asked]) -> list[Any]:
    """Ask a library about all values at once, and about all packets at once."""
    values = [each.value for each in asked if each.packet is None]
    packets = [each.packet for each in asked if each.packet is not None]
    written = iter(each_answered(name, values, codec.encode_all(values)) if values else ())
    read = iter(each_answered(name, packets, codec.decode_all(packets)) if packets else ())
    return [next(written) if each.packet is None else next(read) for each in asked]


def described(finding: Finding) -> str:
    """Describe a difference: definition, value, packet, and both answers."""
    answers = {finding.reference: finding.expected, finding.library: finding.got}
    lines = {"value": shown(finding.message, finding.value)}
    if not finding.what.startswith("encode"):
        lines["packet"] = finding.packet.hex() or "no bytes"
    lines |= {name: _answer(finding, answer) for name, answer in answers.items()}
    shortened = [f"{name}: {clipped(text, MOST_CHARACTERS)}" for name, text in lines.items()]
    definition = clipped(full_text(finding.message).rstrip(), MOST_CHARACTERS)
    return "\n".join([f"{finding.what} differs from {finding.reference}", definition, *shortened])


def _answer(finding: Finding, answer: Any) -> str:
    if isinstance(answer, Refusal):
        return f"refuses: {answer}"
    if isinstance(answer, bytes):
        return answer.hex() or "no bytes"
    try:
        return shown(finding.message, answer) or "a message without fields"
    # A library may give values that do not fit the type, such as a text in place of a float.
    except Exception:
        return repr(answer)


BUS_BYTES = 8
"""Lengths of sequences and texts are chosen as for a bus of this width."""


def reference_of(library: str, wire: Wire, installed: Sequence[str]) -> str | None:
    """Return the first reference for a library on a wire; `None` if none is installed."""
    return next(iter(_references(library, wire, installed)), None)


def _references(library: str, wire: Wire, installed: Sequence[str]) -> list[str]:
    own, *others = REFERENCES[wire]
    # ROS's own serializer is judged by rosbags first, and only then by other releases of itself.
    names = reversed(others) if library == own else (own, *others)
    return [name for name in names if name in installed and name != library]


class Libraries(TypesSystem):
    """The test system of ``--sut``. A test is one library on one type.

    A type has no test of a library that does not speak its wire, unless the user named wires or
    distributions.

    Raises `ClientMissingError`: when the system is entered, if a library under test is not
    installed.
    """

    name = "sut"
    passes = "types agree"

    def __enter__(self) -> Libraries:
        request = self._request
        wires = {wire_of(task.distro, request.wire) for task in self._tasks}
        self._wires: list[Wire] = [wire for wire in REFERENCES if wire in wires]
        references = {name for wire in self._wires for name in REFERENCES[wire]}
        asked = [*request.libraries, *(name for name in CLIENTS if name in references)]
        self._versions, missing = find_clients(list(dict.fromkeys(asked)))
        for name in request.libraries:
            if name in missing:
                raise ClientMissingError(missing[name])
        self._installed = tuple(n for n in CLIENTS if n in references and n in self._versions)
        for wire in self._wires:
            ros = REFERENCES[wire][0]
            if ros in missing:
                print(f"{ros}, which is ROS's own on {wire}, is not installed: {missing[ros]}")
            for name in request.libraries:
                if wire in CLIENTS[name].wires:
                    by = self._by(name, wire)
                    print(f"{name} {self._versions[name]} on {wire}: judged by {by}")
        return self

    def __exit__(self, *error: object) -> None:
        close_clients()

    def _by(self, library: str, wire: Wire) -> str:
        judge = reference_of(library, wire, self._installed)
        return f"{judge} {self._versions[judge]}" if judge else "no reference"

    @property
    def tests(self) -> Sequence[Test]:
        """The tests of all libraries: type by type, so that a process makes its values once."""
        request = self._request
        words = [f"seed={request.seed}"]
        words += [] if request.most_cases is None else [f"cases={request.most_cases}"]
        return [
            as_test(f"sut {library}", task, request, *words, bus_bytes=0)
            for task in self._tasks
            for wire in [wire_of(task.distro, request.wire)]
            for library in request.libraries
            if request.names_wires or wire in CLIENTS[library].wires
        ]

    @property
    def options(self) -> Mapping[str, Any]:
        """The libraries and references with their versions."""
        return {"libraries": [f"{name} {version}" for name, version in self._versions.items()]}

    def records(self, writer: ResultsWriter | None) -> list[Record]:
        """Judge the libraries on all types."""
        request = self._request
        return run_and_record(
            self.tests,
            writer,
            lambda left: run_tests(
                judge_library,
                (request, self._installed),
                left,
                self._again,
                most=len(request.libraries),
                jobs=request.jobs,
            ),
            lambda record: failure_of(record.test.title, record),
            label="client libraries",
        )

    def summary(self, records: Sequence[Record], seconds: float) -> Iterator[str]:
        """Yield lines about each library."""
        for name in self._request.libraries:
            own = [each for each in records if each.test.system == f"sut {name}"]
            compared = round(sum(each.metrics.get("comparisons", 0) for each in own))
            yield f"{name} {self._versions[name]}: {compared} comparisons"
            yield from summary_of(own, self.passes, seconds)

    def _again(self, test: Test) -> str:
        request = self._request
        return command_again(
            test.type,
            sut=test.system.removeprefix("sut "),
            distro=test.distro,
            path=request.paths,
            depends=request.depends,
            wire=request.wire,
            seed=request.seed or None,
            cases=request.most_cases,
        )


def judge_library(given: tuple[Request, Sequence[str]], test: Test) -> Record:
    """Judge a library on a type, by the first of some references that has the type."""
    request, installed = given
    library = test.system.removeprefix("sut ")
    with Trial.of(test) as trial:
        try:
            message = library_of(test.distro, request).message(test.type)
            wire = request.wire or message.wire
            values = _values(test.distro, message, wire, request)
        except (DefinitionError, ValueError) as error:
            raise NotJudgedError(str(error)) from None
        trial.watch.enter("testing")
        first = None
        for reference in _references(library, wire, installed):
            trial.obstacle = None
            if compare(client(library), client(reference), message, wire, values, trial):
                break
            first = first or trial.obstacle
        else:
            trial.obstacle = first or NotJudged(f"no reference for {wire} is installed")
    return trial.end()


@lru_cache(maxsize=1)
def _values(distro: str, message: Message, wire: Wire, request: Request) -> list[Plain]:
    """Choose values as TS3 does: all lengths and extremes, and values for a plan's decisions."""
    judge = judge_of(message, None if request.paths else distro, stand_in=True)
    plan = build_plan(lay_out(message, wire), bus_bytes=BUS_BYTES)
    seed, most = request.seed, request.most_cases
    cases = all_cases(judge.oracle, judge.name, plan, seed=seed, most=most)
    return [from_objects(message, case.value) for case in cases]
