"""Reference libraries of TS3: who else has to write the bytes that rosbags writes for a case.

Cases, and what their leaves transfer, come from rosbags. Every other library that is here is given
the same value and has to write the same packet, so that a mistake of rosbags alone does not pass.
Known divergences (docs/divergences.md) are told by their keys.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from firm_hdl.model import Message
from firm_hdl.verify.cases import Case
from firm_hdl.verify.sut.client import (
    ClientDiedError,
    ClientMissingError,
    Refusal,
    UnsupportedError,
    each_answered,
)
from firm_hdl.verify.sut.clients import client, close_clients
from firm_hdl.verify.sut.fastcdr import NEWER
from firm_hdl.verify.sut.known import known_writing
from firm_hdl.verify.sut.values import Plain, from_objects, messages_of
from firm_hdl.verify.wide_oracle import stand_ins
from firm_hdl.wire import Wire

__all__ = [
    "NO_REFERENCE",
    "WIDE_REFERENCES",
    "WRITERS",
    "Confirmation",
    "confirm",
    "find_references",
    "may_stand_in",
    "references_here",
]

WRITERS: dict[str, tuple[Wire, ...]] = {
    "genpy": ("ros1",),
    "fastcdr": ("cdr",),
    **{kind.name: ("cdr",) for kind in NEWER},
    "cyclonedds": ("cdr",),
}
"""Libraries that may confirm what rosbags writes, and on which wires."""

NO_REFERENCE = "none"

WIDE_REFERENCES = ("fastcdr", *(kind.name for kind in NEWER))
"""Who has wide text, which rosbags has not: one of them is enough."""

MOST_BYTES = 1 << 18
"""Of all packets of a type that are written again; the first one always is."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Confirmation:
    """What other libraries make of the cases of a type.

    Attributes
    ----------
    by : tuple of str
        Those that were given the cases and answered, in the same way or not.
    failures : tuple of str
        What they write in another way, and nobody knows why.
    known : tuple of str
        Keys of what explains the other differences.
    unable : dict of str to str
        Those that have no such wire or type, and why.
    """

    by: tuple[str, ...]
    failures: tuple[str, ...] = ()
    known: tuple[str, ...] = ()
    unable: Mapping[str, str] = field(default_factory=dict)


def references_here(wanted: Sequence[str] | None = None) -> tuple[str, ...]:
    """Return the libraries that can be asked in this process, `None`: of all."""
    names = WRITERS if wanted is None else [name for name in WRITERS if name in wanted]
    return tuple(name for name in names if client(name).missing() is None)


def may_stand_in(message: Message, wanted: Sequence[str] | None = None) -> bool:
    """Whether a type has wide text, and somebody is here who knows how it is written."""
    names = [name for name in WIDE_REFERENCES if wanted is None or name in wanted]
    return bool(stand_ins(messages_of(message))) and bool(references_here(names))


def find_references(wanted: Sequence[str] | None, wires: Sequence[str]) -> list[str]:
    """Say which libraries are not here; for a process that starts others.

    Raises
    ------
    ClientMissingError
        If one of those that are wanted by name is not.
    """
    said = []
    for name in WRITERS if wanted is None else wanted:
        if wanted is None and not set(wires) & set(WRITERS[name]):
            continue
        why = client(name).missing()
        if why is not None and wanted is not None:
            raise ClientMissingError(why)
        if why is not None:
            said.append(f"{name} does not confirm bytes: {why}")
    # Processes that are forked must not have ours.
    close_clients()
    return said


def confirm(
    message: Message, wire: Wire, cases: Sequence[Case], wanted: Sequence[str] | None = None
) -> Confirmation:
    """Have cases written by other libraries.

    Parameters
    ----------
    wanted : sequence of str or None
        `None`: all that are here.
    """
    here = references_here(wanted)
    unable = {name: f"{name} has no wire '{wire}'" for name in here if wire not in WRITERS[name]}
    names = [name for name in here if name not in unable]
    some = _some(cases)
    values = [from_objects(message, case.value) for case in some] if names else []
    by: list[str] = []
    failures: list[str] = []
    known: dict[str, None] = {}
    for name in names:
        try:
            found, keys = _differences(message, wire, some, values, name)
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


def _some(cases: Sequence[Case]) -> list[Case]:
    found: list[Case] = []
    size = 0
    for case in cases:
        size += len(case.packet)
        if not found or size <= MOST_BYTES:
            found.append(case)
    return found


def _differences(
    message: Message, wire: Wire, cases: Sequence[Case], values: Sequence[Plain], name: str
) -> tuple[list[str], list[str]]:
    """Return differences that nobody knows, and keys of those that are known."""
    codec = client(name).open(message, wire)
    found: list[str] = []
    known: list[str] = []
    answers = each_answered(name, values, codec.encode_all(values))
    for case, value, answer in zip(cases, values, answers, strict=True):
        if answer == case.packet:
            continue
        if keys := known_writing(message, wire, value, name, "rosbags", codec):
            known += keys
            continue
        said = f"refuses: {answer}" if isinstance(answer, Refusal) else f"writes {answer.hex()}"
        found.append(f"{case.what}: {name} {said}, rosbags writes {case.packet.hex()}")
    return found, known
