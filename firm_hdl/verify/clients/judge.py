"""A client library against ROS's own serializer, on one message type."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from firm_hdl.cases.values import Plain, shown
from firm_hdl.model import Message
from firm_hdl.verify.clients.divergences import Finding, known_keys
from firm_hdl.verify.clients.unusual import (
    plain_packet,
    unusual_packet,
    unusual_packets,
    unusual_value,
    unusual_values,
)
from firm_hdl.verify.references.client import (
    Client,
    ClientDiedError,
    Codec,
    Refusal,
    UnsupportedError,
    each_answered,
)
from firm_hdl.verify.references.objects import full_text
from firm_hdl.verify.results.verdict import (
    Failed,
    KnownDifference,
    NotJudged,
    Passed,
    Verdict,
    clipped,
)
from firm_hdl.wire import Wire

__all__ = ["LibraryComparison", "LibraryResult", "described"]


MOST_CHARACTERS = 400
"""A definition, a value or an answer is shown with so many characters at most."""


@dataclass(slots=True, kw_only=True)
class LibraryResult:
    """The result of one library on one type.

    Attributes
    ----------
    comparisons : int
        Number of questions that both libraries were asked.
    answers : int
        Number of questions that the reference answered and did not refuse.
    known : counter of str
        Keys of known differences.
    findings : list of Finding
        The unknown difference of each kind whose value is the smallest.
    unknown : int
        Number of unknown differences.
    obstacle : NotJudged, Failed or None
        Why there is no result: a library lacks the type, or died.
    """

    library: str
    reference: str
    type: str
    comparisons: int = 0
    answers: int = 0
    known: Counter[str] = field(default_factory=Counter)
    findings: list[Finding] = field(default_factory=list)
    unknown: int = 0
    obstacle: NotJudged | Failed | None = None

    @property
    def verdict(self) -> Verdict:
        """The verdict; its cases are comparisons."""
        if self.unknown:
            return Failed(tuple(map(described, self.findings)) or (f"{self.unknown} differences",))
        if self.obstacle is not None:
            return self.obstacle
        if not self.answers:
            return NotJudged(f"{self.reference or 'the reference'} had no answer to anything")
        if self.known:
            return KnownDifference(tuple(sorted(self.known)), self.comparisons)
        return Passed(self.comparisons)

    def add(self, finding: Finding, codecs: tuple[Codec, Codec]) -> None:
        """Count a difference."""
        if keys := known_keys(finding, *codecs):
            self.known.update(keys)
            return
        self.unknown += 1
        same = [each for each in self.findings if each.what == finding.what]
        if not same or finding.size < same[0].size:
            self.findings = [each for each in self.findings if each not in same] + [finding]


class LibraryComparison:
    """A library and its reference."""

    def __init__(self, library: Client, reference: Client, wire: Wire):
        self.library, self.reference, self.wire = library, reference, wire

    def judge(self, message: Message, values: Sequence[Plain]) -> LibraryResult:
        """Compare how both write values, and how both read packets of these values."""
        result = LibraryResult(
            library=self.library.name, reference=self.reference.name, type=message.name
        )
        try:
            self._judge(result, message, values, *self._open(message))
        except ClientDiedError as error:
            result.obstacle = Failed((str(error),))
        except UnsupportedError as error:
            result.obstacle = NotJudged(str(error) or "the type is not supported")
        return result

    def _open(self, message: Message) -> tuple[Codec, Codec]:
        for client in (self.library, self.reference):
            if self.wire not in client.wires:
                raise UnsupportedError(f"{client.name} does not speak {self.wire}")
        return self.library.open(message, self.wire), self.reference.open(message, self.wire)

    def _judge(
        self,
        result: LibraryResult,
        message: Message,
        values: Sequence[Plain],
        library_codec: Codec,
        reference_codec: Codec,
    ) -> None:
        name = self.reference.name
        packets = each_answered(name, values, reference_codec.encode_all(values))
        asked = [_Asked("encode", value, None) for value in values]
        pairs = [(v, p) for v, p in zip(values, packets, strict=True) if isinstance(p, bytes)]
        asked += [_Asked("decode", value, packet) for value, packet in pairs]
        asked += [
            _Asked(f"encode {name}", value, None) for name, value in unusual_values(message, values)
        ]
        usable = [v for v, p in pairs if plain_packet(message, self.wire, v) == p]
        asked += [
            _Asked(case, value, packet)
            for case, value, packet in unusual_packets(message, self.wire, usable)
            if self._reads(case)
        ]
        expectations = _answers(name, reference_codec, asked)
        answers = zip(
            asked, expectations, _answers(self.library.name, library_codec, asked), strict=True
        )
        for each, expected, got in answers:
            result.comparisons += 1
            result.answers += not isinstance(expected, Refusal)
            if expected != got:
                result.add(
                    self._finding(message, each, expected, got), (library_codec, reference_codec)
                )

    def _reads(self, case: str) -> bool:
        both = (self.library, self.reference)
        return case != "big-endian" or all("big" in each.byte_orders for each in both)

    def _finding(self, message: Message, asked: _Asked, expected: Any, got: Any) -> Finding:
        return Finding(
            library=self.library.name,
            reference=self.reference.name,
            wire=self.wire,
            what=asked.what,
            message=message,
            value=asked.value,
            packet=asked.packet or b"",
            expected=expected,
            got=got,
        )

    def ask(
        self, message: Message, what: str, value: Plain
    ) -> tuple[Finding, Sequence[str]] | None:
        """Ask one question; return a difference and the keys that explain it; `None` without one.

        Parameters
        ----------
        what : str
            See `Finding`. An unusual case is put into `value`, or into its packet.
        """
        try:
            library_codec, reference_codec = self._open(message)
            asked = self._asked(message, what, value, reference_codec)
            if asked is None:
                return None
            (expected,) = _answers(self.reference.name, reference_codec, [asked])
            (got,) = _answers(self.library.name, library_codec, [asked])
        except UnsupportedError:
            return None
        finding = self._finding(message, asked, expected, got)
        return (
            None
            if expected == got
            else (finding, known_keys(finding, library_codec, reference_codec))
        )

    def _asked(
        self, message: Message, what: str, value: Plain, reference_codec: Codec
    ) -> _Asked | None:
        if what.startswith("encode"):
            case = what.removeprefix("encode").strip()
            given = unusual_value(message, value, case) if case else value
            return None if given is None else _Asked(what, given, None)
        (plain,) = reference_codec.encode_all([value])
        if isinstance(plain, Refusal):
            return None
        if what == "decode":
            return _Asked(what, value, plain)
        if plain != plain_packet(message, self.wire, value):
            return None
        packet = unusual_packet(message, self.wire, value, what)
        return None if packet is None else _Asked(what, value, packet)


@dataclass(frozen=True, slots=True)
class _Asked:
    """A question to both libraries: to read `packet` or, if it is `None`, to write `value`."""

    what: str
    value: Plain
    packet: bytes | None


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
