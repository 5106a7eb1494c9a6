"""A client library against ROS's own serializer, on one message type."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from firm_hdl.cases.values import Plain, shown
from firm_hdl.model import Message
from firm_hdl.verify.clients.divergences import Finding, known_keys
from firm_hdl.verify.clients.unusual import plain_packet, unusual_packets, unusual_values
from firm_hdl.verify.references.client import (
    Client,
    ClientDiedError,
    Codec,
    Refusal,
    UnsupportedError,
    each_answered,
)
from firm_hdl.verify.references.objects import full_text
from firm_hdl.verify.results.verdict import NotJudged, clipped
from firm_hdl.verify.systems.system import Trial
from firm_hdl.wire import Wire

__all__ = ["compare", "described"]

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

    Returns
    -------
    bool
        Whether both libraries have the type.
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
