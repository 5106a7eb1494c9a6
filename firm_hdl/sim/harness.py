"""Converters on a bench: circuits that are elaborated once and run many times.

Stalls and errors use these names of streams: ``packets_in``, ``packets_out``, ``status`` (of the
deserializer, or of a serializer alone), ``sent_status`` (of a serializer after a deserializer),
and ``message.`` with the path of a leaf.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from amaranth.hdl import Cat, Elaboratable, Module, Signal, Value
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.gateware.signatures import leaf_streams
from firm_hdl.model import Message
from firm_hdl.plan import Payload, Plan
from firm_hdl.sim.bench import Bench, Job, Ports, RunOptions, in_chunks
from firm_hdl.sim.payloads import all_beats, as_packets, beats_of, encoder_of
from firm_hdl.sim.record import Recorder, RunResult, leaf_name
from firm_hdl.sim.stalls import StallPlan, stalls_of
from firm_hdl.sim.transfers import checked_transfers, join_transfers, transfer_table
from firm_hdl.wire import lay_out

__all__ = ["Harness"]

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
