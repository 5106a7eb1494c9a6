"""Converters on a bench: circuits that are elaborated once and run many times.

Stalls and errors use these names of streams: ``packets_in``, ``packets_out``, ``status`` (of the
deserializer, or of a serializer alone), ``sent_status`` (of a serializer after a deserializer),
and ``message.`` with the path of a leaf.

A recorder joins single transfers to packets, statuses and payloads.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from amaranth.hdl import Cat, Elaboratable, Module, Signal, Value
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.gateware.signatures import Status, leaf_streams
from firm_hdl.model import Message
from firm_hdl.plan import Payload, Plan
from firm_hdl.sim.bench import Bench, Job, Ports, RunOptions, in_chunks
from firm_hdl.sim.payloads import (
    PacketCollector,
    all_beats,
    as_packets,
    beats_of,
    decoder_of,
    encoder_of,
)
from firm_hdl.sim.stalls import StallPlan, stalls_of
from firm_hdl.sim.transfers import (
    TransferTable,
    checked_transfers,
    join_transfers,
    split_transfers,
    transfer_table,
)
from firm_hdl.sim.watch import PacketRules
from firm_hdl.wire import lay_out

__all__ = ["Harness", "Recorder", "RunResult", "leaf_name"]


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

    * `expected`: number of packets and of statuses that are expected.
    * `decodes`, `encodes`: whether the harness has a deserializer, and whether it has a serializer.
    * `table`: transfers that messages require, to name missing leaves.
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


DEFAULTS = RunOptions()


class Harness:
    """A deserializer, a serializer, or both connected, on a bench.

    Parameters
    ----------
    deserializer : Deserializer or None
    serializer : Serializer or None
        If both are given, their messages are connected.
    message : Message or None
        Their message type, so that errors can name missing leaves.
    gated : bool
        Whether leaf streams between the two converters can be stalled.
    probes : sequence of Value
        Values that a run may observe.
    keeps_state : bool
        Between runs, only reset the converters, as in hardware: memories and registers without a
        reset keep their values. Otherwise each run starts with all initial values.

    Raises
    ------
    TypeError, ValueError
        If a converter is none, or the two are of different messages or parameters.
    """

    def __init__(
        self,
        deserializer: Deserializer | None,
        serializer: Serializer | None,
        *,
        message: Message | None = None,
        gated: bool = False,
        probes: Sequence[Value] = (),
        keeps_state: bool = False,
    ):
        component = deserializer if deserializer is not None else serializer
        if component is None:
            raise ValueError("A harness needs a deserializer or a serializer")
        _check_converter(deserializer, "deserializer", In)
        _check_converter(serializer, "serializer", Out)
        if deserializer is not None and serializer is not None:
            _check_pair(deserializer.plan, serializer.plan)
        self.plan: Plan = component.plan
        if message is not None and lay_out(message).message.name != self.plan.message:
            raise ValueError(f"The converter is for {self.plan.message}, not for {message.name}")
        self.table = None if message is None else transfer_table(self.plan, message)
        self.deserializer, self.serializer = deserializer, serializer
        names = [leaf_name(self.plan, leaf) for leaf in range(len(self.plan.leaves))]
        leaves = leaf_streams(component.message, component.tree)
        self.leaf_ports = {names[leaf]: port for leaf, port in leaves.items()}
        self.gated = gated and deserializer is not None and serializer is not None
        circuit = _Circuit(deserializer, serializer, self.gated)
        ports = self._ports(circuit.gates)
        self.bench = Bench(circuit, ports, probes=probes, keeps_state=keeps_state)

    def run_packets(self, packets: Sequence[bytes], options: RunOptions = DEFAULTS) -> RunResult:
        """Send packets to the deserializer, back to back, and record the results.

        Bytes of lanes that are not valid, and `count` in beats that are not the last, are random.

        Raises
        ------
        DeadlineError
            If expected transfers do not come; the text names them.
        StreamRuleError
            If a stream breaks its rules.
        ValueError
            If the harness has no deserializer.
        """
        if self.deserializer is None:
            raise ValueError("Packets need a harness with a deserializer")
        packets = list(as_packets(packets))
        sources: dict[str, Iterable[int]] = {
            "packets_in": all_beats(packets, self.plan.bus_bytes, counts=True)
        }
        result = self._run(sources, len(packets), sum(map(len, packets)), options)
        result.beats_in = sum(beats_of(len(packet), self.plan.bus_bytes) for packet in packets)
        return result

    def run_messages(
        self, messages: Sequence[Mapping[int, Sequence[Payload]]], options: RunOptions = DEFAULTS
    ) -> RunResult:
        """Send messages to a serializer alone, and record the results.

        Each message is given as payloads by the index of the leaf. All leaves move independently: a
        leaf offers its payloads of all messages back to back.

        Errors are those of :meth:`run_packets`, and `ValueError` if the harness has a deserializer.
        """
        if self.deserializer is not None:
            raise ValueError("Messages need a harness without a deserializer")
        if isinstance(messages, Mapping) or not isinstance(messages, Iterable):
            raise TypeError(f"Messages must be a list of dicts, not {messages!r}")
        transfers = join_transfers(checked_transfers(self.plan, each) for each in messages)
        sources: dict[str, Iterable[int]] = {
            leaf_name(self.plan, leaf): map(encoder_of(self.plan.leaves[leaf]), payloads)
            for leaf, payloads in transfers.items()
        }
        size = sum(map(len, transfers.values()))
        result = self._run(sources, len(messages), size, options)
        for leaf, offered in transfers.items():
            if left := len(offered) - len(result.transfers[leaf]):
                result.not_taken[leaf] = left
        return result

    def _run(
        self, sources: dict[str, Iterable[int]], messages: int, size: int, options: RunOptions
    ) -> RunResult:
        """Run until `messages` messages have come; `size` is the number of bytes or transfers."""
        if not isinstance(options, RunOptions):
            raise TypeError(f"Options must be RunOptions, not {options!r}")
        if self.deserializer is not None and self.serializer is not None and not self.gated:
            self._refuse_leaf_stalls(options.stalls)
        if options.limit is None:
            options = replace(options, limit=self._limit(messages, size, options.stalls))
        recorder = Recorder(
            self.plan,
            messages,
            decodes=self.deserializer is not None,
            encodes=self.serializer is not None,
            table=self.table,
        )
        self.bench.run(
            Job(
                sources=sources,
                takes=recorder.takes(),
                finished=recorder.finished,
                outstanding=recorder.outstanding,
                options=options,
            )
        )
        return recorder.finish()

    def _limit(self, messages: int, size: int, stalls: StallPlan) -> int:
        """Return a number of cycles that valid packets never reach."""
        longest = max(stalls_of(stalls, name).longest for name in self.bench.names)
        return 10_000 + 50 * (size + 8 * messages) * (1 + longest)

    def _refuse_leaf_stalls(self, stalls: StallPlan) -> None:
        if isinstance(stalls, Mapping):
            for name in self.leaf_ports:
                if stalls_of(stalls, name):
                    raise ValueError(f"Stream {name!r} can be stalled in a gated harness only")

    def _ports(self, gates: Signal | None) -> Ports:
        rx, tx = self.deserializer, self.serializer
        sources: dict[str, stream.Interface] = {}
        sinks: dict[str, stream.Interface] = {}
        taps: dict[str, stream.Interface] = {}
        payloads: dict[str, Value] = {}
        if rx is not None:
            sources["packets_in"] = rx.packets
            sinks["status"] = rx.status
        if tx is not None:
            sinks["packets_out"] = tx.packets
            sinks["status" if rx is None else "sent_status"] = tx.status
            payloads["packets_out"] = Cat(Value.cast(tx.packets.payload), tx.packet_error)
        target = sources if rx is None else sinks if tx is None else taps
        target.update(self.leaf_ports)
        return Ports(sources=sources, sinks=sinks, taps=taps, gates=gates, payloads=payloads)


def _check_converter(converter: Any, name: str, flow: wiring.Flow) -> None:
    """Check that a user's converter, if there is one, has packets in this direction."""
    if converter is None:
        return
    members = converter.signature.members if isinstance(converter, wiring.Component) else {}
    has_all = all(member in members for member in ("packets", "message", "status"))
    if not has_all or members["packets"].flow != flow:
        raise TypeError(f"The {name} of a harness must be a {name.title()}, not {converter!r}")


def _check_pair(one: Plan, other: Plan) -> None:
    about = [f"{p.message} with bus_bytes={p.bus_bytes} and wire={p.wire!r}" for p in (one, other)]
    if about[0] != about[1] or [*one.leaves] != [*other.leaves]:
        raise ValueError(
            f"The deserializer is for {about[0]}, and the serializer for {about[1]}: "
            "a harness connects two of the same message"
        )


class _Circuit(Elaboratable):
    """The converters, with plain connections or gates between them."""

    def __init__(self, rx: Deserializer | None, tx: Serializer | None, gated: bool):
        self.rx, self.tx = rx, tx
        self.gates = Signal(len(tx.plan.leaves)) if gated and tx is not None else None

    def elaborate(self, platform: object) -> Module:
        m = Module()
        rx, tx = self.rx, self.tx
        if rx is not None:
            m.submodules.deserializer = rx
        if tx is not None:
            m.submodules.serializer = tx
        if rx is None or tx is None:
            return m
        inputs = leaf_streams(tx.message, tx.tree)
        outputs = leaf_streams(rx.message, rx.tree)
        for leaves in in_chunks(list(outputs)):
            m.submodules += (part := Module())
            for leaf in leaves:
                if self.gates is None:
                    wiring.connect(part, outputs[leaf], inputs[leaf])
                    continue
                part.d.comb += [
                    inputs[leaf].payload.eq(outputs[leaf].payload),
                    inputs[leaf].valid.eq(outputs[leaf].valid & self.gates[leaf]),
                    outputs[leaf].ready.eq(inputs[leaf].ready & self.gates[leaf]),
                ]
        return m
