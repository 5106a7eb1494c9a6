"""Reference libraries of TS3: libraries that have to write the same bytes as rosbags.

Cases and the transfers of their leaves come from rosbags. Every other installed library gets the
same value, and has to write the same packet. So a mistake of rosbags alone does not pass. Known
divergences (docs/reference/divergences.md) are reported by their keys.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from firm_hdl.cases.make import Case
from firm_hdl.cases.values import Plain, from_objects
from firm_hdl.model import Message
from firm_hdl.verify.clients.divergences import known_writing
from firm_hdl.verify.references.client import (
    ClientDiedError,
    Refusal,
    UnsupportedError,
    each_answered,
)
from firm_hdl.verify.references.clients import WRITERS, client, usable_references
from firm_hdl.wire import Wire

__all__ = ["confirm"]

MOST_BYTES = 1 << 18
"""The most bytes of all packets that a library writes for a type; the first is always written."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Confirmation:
    """The packets of other libraries, compared with those of rosbags."""

    # Libraries that could be asked to write the cases, with or without differences.
    by: tuple[str, ...]
    failures: tuple[str, ...] = ()  # Unknown differences.
    known: tuple[str, ...] = ()  # Keys of the known divergences.
    # Libraries that lack the wire format or the type, and why.
    unable: Mapping[str, str] = field(default_factory=dict)


def confirm(
    message: Message, wire: Wire, cases: Sequence[Case], wanted: Sequence[str] | None = None
) -> Confirmation:
    """Have other libraries write cases, and compare their packets with those of rosbags.

    * `wanted`: names of libraries; `None`: all that are installed.
    """
    usable = usable_references(wanted)
    unable = {name: f"{name} has no wire '{wire}'" for name in usable if wire not in WRITERS[name]}
    names = [name for name in usable if name not in unable]
    sample = _sample(cases)
    values = [from_objects(message, case.value) for case in sample] if names else []
    by: list[str] = []
    failures: list[str] = []
    known: dict[str, None] = {}
    for name in names:
        try:
            found, keys = _differences(message, wire, sample, values, name)
        except ClientDiedError as error:
            failures.append(f"{name} broke down: {error}")
            continue
        except UnsupportedError as error:
            unable[name] = str(error) or f"{name} has no such type"
            continue
        by.append(name)
        failures += found
        known.update(dict.fromkeys(keys))
    return Confirmation(by=tuple(by), failures=tuple(failures), known=tuple(known), unable=unable)


def _sample(cases: Sequence[Case]) -> list[Case]:
    """Return the first case, and each further one that `MOST_BYTES` have room for."""
    found: list[Case] = []
    size = 0
    for case in cases:
        if not found or size + len(case.packet) <= MOST_BYTES:
            found.append(case)
            size += len(case.packet)
    return found


def _differences(
    message: Message, wire: Wire, cases: Sequence[Case], values: Sequence[Plain], name: str
) -> tuple[list[str], list[str]]:
    """Return unknown differences, and the keys of known ones."""
    codec = client(name).open(message, wire)
    found: list[str] = []
    known: list[str] = []
    answers = each_answered(name, values, codec.encode_all(values))
    for case, value, answer in zip(cases, values, answers, strict=True):
        if answer == case.packet:
            continue
        if keys := known_writing(message, wire, value, name, codec):
            known += keys
            continue
        text = f"refuses: {answer}" if isinstance(answer, Refusal) else f"writes {answer.hex()}"
        found.append(f"{case.what}: {name} {text}, rosbags writes {case.packet.hex()}")
    return found, known
