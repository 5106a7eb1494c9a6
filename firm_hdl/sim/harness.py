"""Converters on a bench: circuits that are elaborated once and run many times.

Stalls and errors use these names of streams: ``packets_in``, ``packets_out``, ``status`` (of the
deserializer, or of a serializer alone), ``sent_status`` (of a serializer behind a deserializer),
and ``message.`` with the path of a leaf.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence

from amaranth.hdl import Cat, Elaboratable, Module, Signal, Value
from amaranth.lib import stream, wiring

from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.gateware.signatures import leaf_streams
from firm_hdl.model import Message
from firm_hdl.plan import Payload, Plan
from firm_hdl.sim.bench import Bench, Job, in_chunks
from firm_hdl.sim.demand import demand_table
from firm_hdl.sim.payloads import all_beats, beats_of, encoder_of
from firm_hdl.sim.record import Recorder, Seen, leaf_name
from firm_hdl.sim.stalls import StallPlan, stalls_of

__all__ = ["Harness"]


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
        Leaf streams between the two can be stalled.
    probes : sequence of Value
        Values that a run may observe.
    """

    def __init__(
        self,
        deserializer: Deserializer | None,
        serializer: Serializer | None,
        *,
        message: Message | None = None,
        gated: bool = False,
        probes: Sequence[Value] = (),
    ):
        component = deserializer if deserializer is not None else serializer
        if component is None:
            raise ValueError("A harness needs a deserializer or a serializer")
        self.plan: Plan = component.plan
        self.table = None if message is None else demand_table(self.plan, message)
        self.deserializer, self.serializer = deserializer, serializer
        names = [leaf_name(self.plan, leaf) for leaf in range(len(self.plan.leaves))]
        leaves = leaf_streams(component.message, component.tree)
        self.leaf_ports = {names[leaf]: port for leaf, port in leaves.items()}
        self.gated = gated and deserializer is not None and serializer is not None
        circuit = _Circuit(deserializer, serializer, self.gated)
        self.bench = self._bench(circuit, probes)

    def run(
        self,
        *,
        packets: Sequence[bytes] | None = None,
        transfers: Mapping[int, Sequence[Payload]] | None = None,
        messages: int | None = None,
        stalls: StallPlan = None,
        deadline: int = 1000,
        limit: int | None = None,
        vcd: str | os.PathLike[str] | None = None,
        observe: Callable[[list[int]], None] | None = None,
    ) -> Seen:
        """Send packets (with a deserializer) or transfers (without), and record the results.

        Bytes of lanes that are not valid, and `count` in beats that are not the last, are random.

        Parameters
        ----------
        messages : int or None
            Number of messages in `transfers`; not needed with `packets`.
        deadline : int
            Most cycles without any transfer, in addition to the longest stall.
        limit : int or None
            Most cycles in total. `None`: many more than any valid packets take.
        observe : callable or None
            Called in each cycle with the values of the probes; see :class:`.bench.Job`.

        Raises
        ------
        DeadlineError
            If expected transfers do not come; the text names them.
        StreamRuleError
            If a stream breaks its rules.
        """
        if packets is None and messages is None:
            raise ValueError("Number of messages must be given with transfers")
        if self.deserializer is not None and self.serializer is not None and not self.gated:
            self._refuse_leaf_stalls(stalls)
        expected = len(packets) if packets is not None else messages or 0
        run = Recorder(
            self.plan,
            expected,
            decodes=self.deserializer is not None,
            encodes=self.serializer is not None,
            table=self.table,
        )
        job = Job(
            sources=self._sources(packets or (), transfers or {}),
            takes=run.takes(),
            finished=run.finished,
            outstanding=run.outstanding,
            stalls=stalls,
            deadline=deadline,
            limit=self._limit(packets, transfers, expected, stalls) if limit is None else limit,
            observe=observe,
        )
        run.seen.beats_in = sum(beats_of(len(p), self.plan.bus_bytes) for p in packets or ())
        self.bench.run(job, vcd=vcd)
        return _with_untaken(run.result(), transfers or {})

    def _limit(
        self,
        packets: Sequence[bytes] | None,
        transfers: Mapping[int, Sequence[Payload]] | None,
        messages: int,
        stalls: StallPlan,
    ) -> int:
        """Return a number of cycles that valid packets never reach."""
        size = sum(map(len, packets or ())) + sum(map(len, (transfers or {}).values()))
        longest = max(stalls_of(stalls, name).longest for name in self.bench.names)
        return 10_000 + 50 * (size + 8 * messages) * (1 + longest)

    def _refuse_leaf_stalls(self, stalls: StallPlan) -> None:
        if isinstance(stalls, Mapping):
            for name in self.leaf_ports:
                if stalls_of(stalls, name):
                    raise ValueError(f"Stream {name!r} can be stalled in a gated harness only")

    def _bench(self, circuit: _Circuit, probes: Sequence[Value]) -> Bench:
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
        return Bench(
            circuit,
            sources=sources,
            sinks=sinks,
            taps=taps,
            gates=circuit.gates,
            payloads=payloads,
            probes=probes,
        )

    def _sources(
        self, packets: Sequence[bytes], transfers: Mapping[int, Sequence[Payload]]
    ) -> dict[str, Iterable[int]]:
        if self.deserializer is not None:
            return {"packets_in": all_beats(packets, self.plan.bus_bytes, counts=True)}
        return {
            leaf_name(self.plan, leaf): map(encoder_of(self.plan.leaves[leaf]), payloads)
            for leaf, payloads in transfers.items()
        }


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


def _with_untaken(seen: Seen, transfers: Mapping[int, Sequence[Payload]]) -> Seen:
    """Record how many transfers of each leaf were offered and not taken."""
    for leaf, offered in transfers.items():
        if left := len(offered) - len(seen.transfers[leaf]):
            seen.left[leaf] = left
    return seen
