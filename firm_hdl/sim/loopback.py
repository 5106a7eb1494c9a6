"""Run converters as functions: packets in, packets out; every stream in between is checked.

`loopback` runs a deserializer connected to a serializer. `decode` and `encode` run one of the two
alone. Each function builds its circuit and runs it once. The results are those of a harness, and
unpack as what matters most. To run one circuit many times, use :class:`firm_hdl.sim.Harness`.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import fields
from typing import TypeVar

from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.gateware.signatures import Status
from firm_hdl.model import Message
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES, Payload, Plan
from firm_hdl.sim.bench import RunOptions
from firm_hdl.sim.harness import Harness, RunResult, leaf_name
from firm_hdl.sim.payloads import as_packets
from firm_hdl.sim.stalls import StallPlan, stalls_of
from firm_hdl.sim.values import to_transfers
from firm_hdl.wire import Wire

__all__ = ["Decoding", "Encoding", "Loopback", "decode", "encode", "loopback"]

T = TypeVar("T", "Loopback", "Decoding", "Encoding")


class Loopback(RunResult):
    """The result of a loopback. Unpacks as ``packets, statuses``.

    `cycles` are those from the first beat in to the last beat out.
    """

    def __iter__(self) -> Iterator[list[bytes] | list[Status]]:
        return iter((self.packets, self.statuses))


class Decoding(RunResult):
    """The result of a deserializer. Unpacks as ``transfers, statuses``.

    `cycles` end with the last transfer of a leaf. There are no packets.
    """

    def __iter__(self) -> Iterator[dict[int, list[Payload]] | list[Status]]:
        return iter((self.transfers, self.statuses))


class Encoding(RunResult):
    """The result of a serializer. Unpacks as ``packets, statuses``.

    `cycles` start with the first transfer of a leaf.
    """

    def __iter__(self) -> Iterator[list[bytes] | list[Status]]:
        return iter((self.packets, self.statuses))


def loopback(
    message: Message,
    packets: Iterable[bytes],
    *,
    wire: Wire | None = None,
    bus_bytes: int = 8,
    max_message_bytes: int = DEFAULT_MAX_MESSAGE_BYTES,
    stalls: StallPlan = None,
    deadline: int = 1000,
    limit: int | None = None,
    vcd: str | os.PathLike[str] | None = None,
) -> Loopback:
    """Send packets through a deserializer and a serializer.

    Parameters
    ----------
    message : Message
    packets : iterable of bytes
        Sent back to back.
    wire, bus_bytes, max_message_bytes
        As for the converters.
    stalls : Stalls, mapping or None
        Stalls of ``packets_in``, ``packets_out``, ``status``, ``sent_status``, ``message``, and
        streams below ``message`` (``message.header.frame_id.items``). A single record applies to
        all of them.
    deadline : int
        Most cycles without a transfer on any stream, in addition to the longest stall.
    limit : int or None
        Most cycles in total; `None`: many more than any valid packets take.
    vcd : path or None
        File for a waveform, which makes the run slow.

    Raises
    ------
    TypeError, ValueError
        If an argument is not what it has to be.
    DeadlineError
        If expected transfers do not come; the text names them.
    StreamRuleError
        If a stream breaks a rule.
    """
    options = RunOptions(stalls=stalls, deadline=deadline, limit=limit, vcd=vcd)
    packets = list(as_packets(packets))
    rx = Deserializer(message, wire=wire, bus_bytes=bus_bytes, max_message_bytes=max_message_bytes)
    tx = Serializer(message, wire=wire, bus_bytes=bus_bytes, max_message_bytes=max_message_bytes)
    names = [leaf_name(rx.plan, leaf) for leaf in range(len(rx.plan.leaves))]
    gated = any(stalls_of(stalls, name) for name in names)
    harness = Harness(rx, tx, message=message, gated=gated)
    return _as(Loopback, harness.run_packets(packets, options))


def decode(
    message: Message,
    packets: Iterable[bytes],
    *,
    wire: Wire | None = None,
    bus_bytes: int = 8,
    max_message_bytes: int = DEFAULT_MAX_MESSAGE_BYTES,
    stalls: StallPlan = None,
    deadline: int = 1000,
    limit: int | None = None,
    vcd: str | os.PathLike[str] | None = None,
) -> Decoding:
    """Send packets through a deserializer, and record all transfers of its leaves.

    Parameters and errors are those of :func:`loopback`.
    """
    options = RunOptions(stalls=stalls, deadline=deadline, limit=limit, vcd=vcd)
    packets = list(as_packets(packets))
    rx = Deserializer(message, wire=wire, bus_bytes=bus_bytes, max_message_bytes=max_message_bytes)
    harness = Harness(rx, None, message=message)
    return _as(Decoding, harness.run_packets(packets, options))


def encode(
    message: Message,
    values: Iterable[object],
    *,
    wire: Wire | None = None,
    bus_bytes: int = 8,
    max_message_bytes: int = DEFAULT_MAX_MESSAGE_BYTES,
    stalls: StallPlan = None,
    deadline: int = 1000,
    limit: int | None = None,
    vcd: str | os.PathLike[str] | None = None,
) -> Encoding:
    """Send messages through a serializer; each leaf moves independently.

    Other parameters and errors are those of :func:`loopback`.

    Parameters
    ----------
    values : iterable
        Messages as dicts, as objects (such as those of rosbags), or as transfers (dicts of lists by
        the index of the leaf). Transfers may be invalid on purpose.
    """
    options = RunOptions(stalls=stalls, deadline=deadline, limit=limit, vcd=vcd)
    if isinstance(values, Mapping | str | bytes) or not isinstance(values, Iterable):
        raise TypeError(f"Values must be a list of messages, such as [{{...}}], not {values!r}")
    values = list(values)
    tx = Serializer(message, wire=wire, bus_bytes=bus_bytes, max_message_bytes=max_message_bytes)
    harness = Harness(None, tx, message=message)
    messages = [_as_transfers(tx.plan, message, value) for value in values]
    return _as(Encoding, harness.run_messages(messages, options))


def _as(kind: type[T], result: RunResult) -> T:
    return kind(**{item.name: getattr(result, item.name) for item in fields(result)})


def _as_transfers(plan: Plan, message: Message, value: object) -> Mapping[int, list[Payload]]:
    """Return the transfers of a message that is given as transfers or as a value."""
    if isinstance(value, Mapping) and value and all(isinstance(key, int) for key in value):
        return value
    return to_transfers(plan, message, value)
