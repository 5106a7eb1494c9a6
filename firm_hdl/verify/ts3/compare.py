"""Compares the output of converters with the expected output; yields a line for a first difference.

`names` are the names of the messages, in order. A line then names the message that differs. Without
names, a line has the message's number only.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from firm_hdl.cases.oracle import Transfers
from firm_hdl.plan import Payload, Plan
from firm_hdl.sim.harness import RunResult
from firm_hdl.verify.results.verdict import first_difference

__all__ = ["Expected", "packet_differences", "run_differences", "transfer_differences"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Expected:
    """The expected output of a run of both converters."""

    # Packets that come out. They are marked as errors if the serializer's status is not `OK`.
    packets: Sequence[bytes]
    transfers: Sequence[Transfers]  # Payloads by path of the leaf, a mapping for each message.
    # Statuses of the deserializer, and of the serializer.
    statuses: Sequence[str]
    sent_statuses: Sequence[str]


def run_differences(
    where: str, plan: Plan, seen: RunResult, wanted: Expected, names: Sequence[str] = ()
) -> Iterator[str]:
    """Yield the first difference of packets, of each leaf, of statuses, and of error marks."""
    yield from packet_differences(where, seen.packets, wanted.packets, names)
    yield from transfer_differences(where, plan, seen.transfers, wanted.transfers, names)
    for what, statuses, expected in (
        ("status", seen.statuses, wanted.statuses),
        ("sent_status", seen.sent_statuses, wanted.sent_statuses),
    ):
        got = [status.name for status in statuses]
        yield from _status_differences(f"{where}: {what}", got, expected, names)
    marked = [status != "OK" for status in wanted.sent_statuses]
    if seen.packet_errors != marked:
        yield f"{where}: packet_error is {seen.packet_errors} instead of {marked}"


def _status_differences(
    what: str, got: Sequence[str], wanted: Sequence[str], names: Sequence[str] = ()
) -> Iterator[str]:
    """Yield the first status that differs, if one does."""
    number = first_difference(got, wanted)
    if number < min(len(got), len(wanted)):
        statuses = f"{got[number]} instead of {wanted[number]}"
        yield f"{what} of packet {number} is {statuses}{_name(names, number)}"
    elif len(got) != len(wanted):
        yield f"{what}: {len(got)} instead of {len(wanted)}"


def packet_differences(
    where: str, got: Sequence[bytes], wanted: Sequence[bytes], names: Sequence[str] = ()
) -> Iterator[str]:
    """Yield the first packet that differs, if one does, and the byte at which it does."""
    number = first_difference(got, wanted)
    if number < min(len(got), len(wanted)):
        one, other = got[number], wanted[number]
        yield (
            f"{where}: packet {number} of {len(wanted)} differs at byte "
            f"{first_difference(one, other)}: "
            f"{one.hex()} instead of {other.hex()}{_name(names, number)}"
        )
    elif len(got) != len(wanted):
        yield f"{where}: {len(got)} packets instead of {len(wanted)}"


def transfer_differences(
    where: str,
    plan: Plan,
    got: Mapping[int, Sequence[Payload]],
    wanted: Sequence[Transfers],
    names: Sequence[str] = (),
) -> Iterator[str]:
    """Yield the first transfer of each leaf that differs.

    * `got`: payloads by index of the leaf, over all messages.
    * `wanted`: payloads by path of the leaf, a mapping for each message.
    """
    joined: dict[tuple[str, ...], list[Payload]] = {}
    for each in wanted:
        for path, payloads in each.items():
            joined.setdefault(path, []).extend(payloads)
    for number, leaf in enumerate(plan.leaves):
        received, expected = list(got.get(number, [])), joined.pop(leaf.path, [])
        if received == expected:
            continue
        at = first_difference(received, expected)
        yield (
            f"{where}: leaf {leaf}, transfer {at} of {len(expected)}: "
            f"{received[at : at + 1]} instead of {expected[at : at + 1]}"
            f"{_name(names, _message_of(leaf.path, at, wanted))}"
        )
    if joined:
        yield f"{where}: no leaves {', '.join('.'.join(path) for path in joined)}"


def _name(names: Sequence[str], number: int) -> str:
    return f" ({names[number]})" if number < len(names) else ""


def _message_of(path: tuple[str, ...], transfer: int, messages: Sequence[Transfers]) -> int:
    """Return the index of the message that a transfer of a leaf belongs to."""
    for number, message in enumerate(messages):
        transfer -= len(message.get(path, ()))
        if transfer < 0:
            return number
    return len(messages)
