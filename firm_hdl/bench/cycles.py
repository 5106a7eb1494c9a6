"""Cycles that a converter takes, counted in a simulation of its circuit."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import islice
from typing import TypeAlias

from firm_hdl.bench.messages import STATED, Stated, values
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.model import Message
from firm_hdl.plan import Payload, Plan, encode
from firm_hdl.sim import Harness, RunResult, to_transfers

__all__ = ["Converter", "Cycles", "count_cycles", "stated_messages"]

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

    Parameters
    ----------
    converter : Deserializer or Serializer
        The converter, not yet elaborated.
    message : Message
        The message type of the converter.
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
