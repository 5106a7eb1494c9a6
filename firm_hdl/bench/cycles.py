"""Cycles that a converter takes, counted in a simulation of its circuit."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import islice
from typing import Literal, TypeAlias

from firm_hdl.bench.messages import STATED, Stated, values
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.model import Message
from firm_hdl.plan import Payload, Plan, encode
from firm_hdl.sim import Harness, RunResult, to_transfers

__all__ = ["DIRECTIONS", "Converter", "Cycles", "Direction", "count_cycles", "stated_messages"]

Direction: TypeAlias = Literal["deserializer", "serializer"]
DIRECTIONS: tuple[Direction, ...] = ("deserializer", "serializer")

MOST_BEATS = 10_000
"""Beats after which no further message is added: nested sequences have thousands in each."""

Converter: TypeAlias = "Deserializer | Serializer"


@dataclass(frozen=True, slots=True, kw_only=True)
class Cycles:
    """The cycles of messages that come back to back, without stalls.

    Attributes
    ----------
    messages : Stated
        The messages, with how many of them there were.
    bytes, beats : int
        Of their packets.
    cycles : int
        From the end of the first message, which is not counted, to the end of the last. A message
        ends with the last transfer of a leaf or beat, or with its status if that is later.
    latency : int
        Of the first message, alone: cycles from its last transfer in, a beat or that of a leaf, to
        its last transfer out.
    """

    messages: Stated
    bytes: int
    beats: int
    cycles: int
    latency: int

    @property
    def per_beat(self) -> float:
        """Cycles per beat; 1 is the best that there is."""
        return self.cycles / self.beats

    @property
    def bits_per_cycle(self) -> float:
        """Bits of packets per cycle."""
        return 8 * self.bytes / self.cycles


def count_cycles(converter: Converter, message: Message, stated: Stated = STATED) -> Cycles:
    """Run a converter with the stated messages, or with as many as have `MOST_BEATS`.

    Parameters
    ----------
    converter : Deserializer or Serializer
        Not yet elaborated.
    message : Message
        Its type.
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

    They end with the one that makes `MOST_BEATS` of those that are measured.
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
