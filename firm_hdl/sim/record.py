"""Record a run of converters: packets, statuses and payloads, joined from single transfers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from firm_hdl.gateware.signatures import Status
from firm_hdl.plan import Payload, Plan
from firm_hdl.sim.payloads import PacketCollector, decoder_of
from firm_hdl.sim.transfers import TransferTable, split_transfers
from firm_hdl.sim.watch import PacketRules

__all__ = ["Recorder", "RunResult", "leaf_name"]


@dataclass(slots=True, kw_only=True)
class RunResult:
    """The observations of one run of a harness.

    If the serializer is alone, `statuses` are those of the serializer, and `sent_statuses` is
    empty.

    Attributes
    ----------
    packets : list of bytes
        Packets of the serializer.
    packet_errors : list of bool
        For each of these packets, whether `packet_error` was set.
    statuses : list of Status
        Transfers of ``status``.
    sent_statuses : list of Status
        Transfers of ``sent_status``.
    transfers : dict of int to list
        Payloads by leaf, over all packets; every leaf has an entry.
    cycles : int
        Cycles from the first beat (or leaf transfer) in to the last one out, both included.
    not_taken : dict of int to int
        Transfers that were offered to a serializer and never taken, by leaf; other leaves are
        absent.
    beats_in, beats_out : int
        Beats of the packets in and out.
    """

    packets: list[bytes] = field(default_factory=list)
    packet_errors: list[bool] = field(default_factory=list)
    statuses: list[Status] = field(default_factory=list)
    sent_statuses: list[Status] = field(default_factory=list)
    transfers: dict[int, list[Payload]] = field(default_factory=dict)
    not_taken: dict[int, int] = field(default_factory=dict)
    beats_in: int = 0
    beats_out: int = 0
    first_cycle: int = -1
    last_cycle_in: int = -1
    last_cycle: int = -1
    last_status_cycle: int = -1

    @property
    def cycles(self) -> int:
        """Cycles from the first transfer in to the last one out, both included; 0 without any."""
        return self.last_cycle - self.first_cycle + 1 if self.last_cycle >= 0 else 0

    @property
    def latency(self) -> int:
        """Cycles from the last transfer in to the last one out; 0 without any."""
        return self.last_cycle - self.last_cycle_in if self.last_cycle >= 0 else 0

    @property
    def end_cycle(self) -> int:
        """Cycle of the last transfer out, statuses included; -1 without any."""
        return max(self.last_cycle, self.last_status_cycle)


def leaf_name(plan: Plan, leaf: int) -> str:
    """Return the name of a leaf's stream."""
    return f"message.{plan.leaves[leaf]}"


class Recorder:
    """Records the transfers of one run.

    Parameters
    ----------
    plan : Plan
    expected : int
        Number of packets and of statuses that are expected.
    decodes, encodes : bool
        Whether the harness has a deserializer, and whether it has a serializer.
    table : TransferTable or None
        Transfers that messages require, to name missing leaves.
    """

    def __init__(
        self,
        plan: Plan,
        expected: int,
        *,
        decodes: bool,
        encodes: bool,
        table: TransferTable | None = None,
    ):
        self.plan = plan
        self.table = table
        self.expected = expected
        self.encodes = encodes
        self.decodes = decodes
        self.bits: dict[int, list[int]] = {leaf: [] for leaf in range(len(plan.leaves))}
        self.out = PacketCollector(plan.bus_bytes)
        self.rules = PacketRules("packets_out", plan.bus_bytes)
        self.result = RunResult(packets=self.out.packets)
        self.error_at = 8 * plan.bus_bytes + plan.bus_bytes.bit_length() + 1
        # Streams with one transfer or packet for each packet that goes in.
        self.per_message: dict[str, list[Status] | list[bytes]] = {"status": self.result.statuses}
        if encodes:
            self.per_message["packets_out"] = self.out.packets
        if encodes and decodes:
            self.per_message["sent_status"] = self.result.sent_statuses

    def takes(self) -> dict[str, Callable[[int, int], None]]:
        """Return the functions to call at each transfer, by the stream's name."""
        takes: dict[str, Callable[[int, int], None]] = {
            leaf_name(self.plan, leaf): self._leaf(bits) for leaf, bits in self.bits.items()
        }
        takes["packets_in"] = self._packet_in
        takes["packets_out"] = self._packet_out
        takes["status"] = self._status("status", self.result.statuses)
        takes["sent_status"] = self._status("sent_status", self.result.sent_statuses)
        return takes

    def _status(self, name: str, statuses: list[Status]) -> Callable[[int, int], None]:
        def take(cycle: int, bits: int) -> None:
            statuses.append(Status(bits))
            self.result.last_status_cycle = cycle
            self._limit(name, cycle)

        return take

    def _limit(self, name: str, cycle: int) -> None:
        if len(self.per_message[name]) > self.expected:
            raise AssertionError(
                f"Stream {name!r} has more than the {self.expected} expected, in cycle {cycle}"
            )

    def _leaf(self, values: list[int]) -> Callable[[int, int], None]:
        if self.encodes and self.decodes:
            return lambda cycle, bits: values.append(bits)
        if self.encodes:

            def take(cycle: int, bits: int) -> None:
                values.append(bits)
                self._time_in(cycle)
        else:

            def take(cycle: int, bits: int) -> None:
                values.append(bits)
                self.result.last_cycle = cycle

        return take

    def _time_in(self, cycle: int) -> None:
        self.result.last_cycle_in = cycle
        if self.result.first_cycle < 0:
            self.result.first_cycle = cycle

    def _packet_in(self, cycle: int, bits: int) -> None:
        self._time_in(cycle)

    def _packet_out(self, cycle: int, bits: int) -> None:
        beat = bits & ((1 << self.error_at) - 1)
        self.rules.check(cycle, beat)
        self.result.last_cycle = cycle
        has_error = bool(bits >> self.error_at)
        if self.out.take(beat):
            self.result.packet_errors.append(has_error)
            self._limit("packets_out", cycle)
        elif has_error:
            raise AssertionError(
                f"packet_error is high in cycle {cycle}, with a beat that is not the last"
            )

    def finished(self) -> bool:
        """Return whether every stream has had its expected transfers or packets."""
        return all(len(got) >= self.expected for got in self.per_message.values())

    def outstanding(self) -> str:
        """Describe the packets, statuses and leaves that have not come, for an error."""
        missing = [
            f"{name} ({len(got)} of {self.expected})"
            for name, got in self.per_message.items()
            if len(got) < self.expected
        ]
        if self.out.partial:
            missing.append(f"the rest of a packet after {len(self.out.partial)} bytes")
        return ", ".join(missing + self._missing_leaves()) or "nothing"

    def _missing_leaves(self) -> list[str]:
        """Return the leaves that an incomplete message still requires, as text."""
        if self.table is None:
            return []
        messages, pending = split_transfers(self.table, self._transfers())
        if len(messages) >= self.expected:
            return []
        counts = sorted(pending.counts.items())
        return [f"{leaf_name(self.plan, leaf)} ({count})" for leaf, count in counts]

    def _transfers(self) -> dict[int, list[Payload]]:
        decoders = [decoder_of(leaf) for leaf in self.plan.leaves]
        return {leaf: [decoders[leaf](each) for each in bits] for leaf, bits in self.bits.items()}

    def finish(self) -> RunResult:
        """Return the observations after the run; an incomplete packet at the end is an error."""
        if self.out.partial:
            raise AssertionError(
                f"Stream 'packets_out' starts an unexpected packet: {self.out.partial.hex()}"
            )
        self.result.transfers = self._transfers()
        self.result.beats_out = self.out.beats
        return self.result
