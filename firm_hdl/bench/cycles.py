"""Cycles that a converter takes, counted in a simulation of its circuit.

Messages are random, with short strings and sequences, from a seed.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import islice
from typing import Any, TypeAlias

from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.model import Array, FieldType, Message, Primitive, Sequence, String
from firm_hdl.plan import Payload, Plan, encode
from firm_hdl.sim import Harness, RunResult, to_transfers

__all__ = ["STATED", "Converter", "Cycles", "Stated", "count_cycles", "stated_messages", "values"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Stated:
    """Parameters of the messages."""

    count: int = 16  # Number of messages that are measured, after a first one that is not.
    # Fewest and most characters of a string; both are limited by the string's bound.
    characters: tuple[int, int] = (4, 10)
    elements: tuple[int, int] = (3, 8)  # Fewest and most elements of a sequence, limited likewise.
    seed: int = 0

    def __str__(self) -> str:
        return (
            f"{self.count} messages, strings of {self.characters[0]} to {self.characters[1]} "
            f"characters, sequences of {self.elements[0]} to {self.elements[1]} elements, "
            f"seed {self.seed}"
        )


STATED = Stated()


def values(message: Message, stated: Stated = STATED) -> Iterator[dict[str, Any]]:
    """Yield values of a message without end; a seed always gives the same values."""
    chance = random.Random(f"{stated.seed} {message.name}")
    while True:
        yield _of_message(message, stated, chance)


def _of_message(message: Message, stated: Stated, chance: random.Random) -> dict[str, Any]:
    return {field.name: _value(field.type, stated, chance) for field in message.fields}


def _value(kind: FieldType, stated: Stated, chance: random.Random) -> Any:
    match kind:
        case Primitive():
            return _number(kind, chance)
        case String():
            length = _length(stated.characters, kind.bound, chance)
            return "".join(chance.choices("abcdefghijklmnopqrstuvwxyz_", k=length))
        case Array():
            return [_value(kind.element, stated, chance) for _ in range(kind.count)]
        case Sequence():
            length = _length(stated.elements, kind.bound, chance)
            return [_value(kind.element, stated, chance) for _ in range(length)]
        case Message():
            return _of_message(kind, stated, chance)


def _length(between: tuple[int, int], bound: int | None, chance: random.Random) -> int:
    least, most = between
    return chance.randint(*(between if bound is None else (min(least, bound), min(most, bound))))


def _number(kind: Primitive, chance: random.Random) -> float:
    if kind.kind == "bool":
        return chance.random() < 0.5
    if kind.kind == "float":
        return chance.random()
    return chance.getrandbits(8 * kind.bytes - kind.signed)


MOST_BEATS = 10_000
"""Number of beats after which no message is added: a nested sequence may have thousands."""

Converter: TypeAlias = "Deserializer | Serializer"


@dataclass(frozen=True, slots=True, kw_only=True)
class Cycles:
    """The cycles of messages that come back to back, without stalls."""

    messages: Stated  # The messages; `count` is the number of messages that were measured.
    # Size of the packets of the measured messages.
    bytes: int
    beats: int
    # Cycles from the end of the first message, which is not measured, to the end of the last. A
    # message ends with its last transfer out: that of a leaf or beat, or a later status.
    cycles: int
    # Cycles of the first message alone, from its last transfer in to its last transfer out.
    # Transfers are those of leaves or beats.
    latency: int

    @property
    def per_beat(self) -> float:
        """Cycles per beat; the best possible value is 1."""
        return self.cycles / self.beats

    @property
    def bits_per_cycle(self) -> float:
        """Bits of packets per cycle."""
        return 8 * self.bytes / self.cycles


def count_cycles(converter: Converter, message: Message, stated: Stated = STATED) -> Cycles:
    """Run a converter with the stated messages, or with fewer if they reach `MOST_BEATS`.

    * `converter`: the converter, not yet elaborated.
    * `message`: the message type of the converter.
    """
    sent, packets = stated_messages(converter.plan, message, stated)

    def run(count: int) -> RunResult:
        if isinstance(converter, Deserializer):
            return harness.run_packets(packets[:count])
        return harness.run_messages(sent[:count])

    if isinstance(converter, Deserializer):
        harness = Harness(converter, None, message=message)
    else:
        harness = Harness(None, converter, message=message)
    alone, together = run(1), run(len(packets))
    return Cycles(
        messages=replace(stated, count=len(packets) - 1),
        bytes=sum(map(len, packets[1:])),
        beats=sum(_beats(converter.plan, packet) for packet in packets[1:]),
        cycles=together.end_cycle - alone.end_cycle,
        latency=alone.latency,
    )


def stated_messages(
    plan: Plan, message: Message, stated: Stated = STATED
) -> tuple[list[dict[int, list[Payload]]], list[bytes]]:
    """Return the transfers of the stated messages, and their packets; the first is not measured.

    The list ends early with the message at which the measured messages reach `MOST_BEATS`.
    """
    sent: list[dict[int, list[Payload]]] = []
    packets: list[bytes] = []
    beats = 0
    for value in islice(values(message, stated), 1 + stated.count):
        sent.append(to_transfers(plan, message, value))
        packets.append(encode(plan, sent[-1])[0])
        beats += _beats(plan, packets[-1]) if len(packets) > 1 else 0
        if beats >= MOST_BEATS:
            break
    return sent, packets


def _beats(plan: Plan, packet: bytes) -> int:
    return max(1, -(-len(packet) // plan.bus_bytes))
