"""The collector: turn the leaves of a message into words, step by step of the plan."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import chain

from amaranth.hdl import Const, Module, Signal, Value
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import Out

from firm_hdl.gateware.collect.fill import Filler
from firm_hdl.gateware.collect.state import CollectState
from firm_hdl.gateware.collect.words import words_layout
from firm_hdl.gateware.positions import any_of, pick
from firm_hdl.gateware.signatures import Status, StatusSignature
from firm_hdl.plan import LoopEnd
from firm_hdl.program import LENGTH_BITS, SerializerProgram, SerializerState, Transfer

__all__ = ["Collector"]


class Collector(wiring.Component):
    """Take the leaves of each step of a plan, and put them into two words.

    Leaves are taken in wire order, each as soon as it is offered. A length is decoded in the cycle
    before it is taken, so it is taken one cycle after it is offered at the earliest. Latency 1
    cycle from the last leaf of a step to the step's words. Throughput one step per cycle.

    Parameters
    ----------
    program : SerializerProgram
    leaves : mapping of int to stream.Interface
        By leaf: streams of `leaf_shape(leaf)`, which the collector takes. `ready` depends
        combinationally on the `valid` of this leaf and of earlier leaves of the same step.

    Members
    -------
    words : Out(stream.Signature(words_layout(plan)))
        One transfer per step.
    status : Out(StatusSignature)
        One transfer per packet; `OK`, `LENGTH` or `ITEMS`.
    """

    def __init__(self, program: SerializerProgram, leaves: Mapping[int, stream.Interface]):
        self.program, self.plan, self.leaves = program, program.plan, leaves
        plan = self.plan
        super().__init__(
            {"words": Out(stream.Signature(words_layout(plan))), "status": Out(StatusSignature)}
        )

    def elaborate(self, platform: object) -> Module:
        return _CollectorLogic(self).m


@dataclass(frozen=True, slots=True, kw_only=True)
class _Reader:
    """A transfer that a step takes.

    Attributes
    ----------
    leaf : int
        Index of the leaf.
    last : Value(1)
        The value that `items.last` must have.
    optional : bool
        The transfer is the rest of a run, which may be empty.
    left : Signal(1)
        The step has not taken the transfer.
    lacks : Signal(1)
        The step has not taken the transfer, and it is not offered.
    go : Signal(1)
        The transfer is taken in this cycle.
    """

    leaf: int
    last: Value
    optional: bool
    left: Signal
    lacks: Signal
    go: Signal


class _CollectorLogic:
    """The collector's logic, built by one method for each part of it."""

    def __init__(self, collector: Collector):
        self.c = collector
        self.m, self.plan = m, plan = Module(), collector.plan
        self.program = collector.program
        streams = [collector.leaves[k] for k in range(len(plan.leaves))]
        self.state = state = CollectState(m, self.program, streams)
        self._decide()
        self.readers = [self._readers(each) for each in self.program.states]
        self._serve()
        self._hold_lengths()
        self._judge()
        Filler(state, collector.words)
        self._advance()

    # The step.

    def _decide(self) -> None:
        m, state, states = self.m, self.state, self.program.states
        traits, flow = state.traits, state.flow
        is_begin = traits.begins_run | traits.begins_loop
        skips = state.of_length(lambda length: length.skips)
        # A last step that only takes a rest is skipped if there is no rest.
        rests = {each.number for each in states if each.is_final_tail}
        to_rest = any_of([each.taken for each in flow.exits if each.way.to in rests])
        no_rest = is_begin & state.zero & ~traits.begins_string & to_rest
        m.d.comb += [
            state.done.eq(
                traits.begins_nothing | (is_begin & skips) | (traits.is_words & flow.words.last)
            ),
            state.ends.eq(state.done & (flow.exit_ends | no_rest)),
        ]

    def _readers(self, state: SerializerState) -> list[_Reader]:
        """Return the transfers of a state, in wire order."""
        readers = []
        for slot, transfer in enumerate(state.transfers):
            left, lacks, go = (
                Signal(name=f"{name}_{state.number}_{slot}") for name in ("left", "lacks", "go")
            )
            readers.append(
                _Reader(
                    leaf=transfer.leaf,
                    last=self._last(transfer),
                    optional=transfer.is_rest,
                    left=left,
                    lacks=lacks,
                    go=go,
                )
            )
        return readers

    def _last(self, transfer: Transfer) -> Value:
        """Return the value that `items.last` must have in a transfer."""
        flow, part, run = self.state.flow, transfer.part, transfer.run
        if part is not None:
            if isinstance(part.end, LoopEnd):
                return flow.levels[part.end.level].last
            return Const(part.end is not None, 1)
        if run is None or transfer.is_rest:
            return Const(1, 1)
        return Const(0, 1) if run.counted else flow.words.last & run.last

    def _serve(self) -> None:
        """Take the leaves of a step in wire order, each as soon as it is offered.

        A producer may offer a leaf only after an earlier one was taken. So a step must not wait
        until all its leaves are offered. `served` records which of them were taken.
        """
        m, c, state, streams = self.m, self.c, self.state, self.state.streams
        ready: dict[int, list[Value]] = {}
        missing: list[Value] = []
        for each, readers in zip(self.program.states, self.readers, strict=True):
            for slot, reader in enumerate(readers):
                self._take(each.number, slot)
                ready.setdefault(reader.leaf, []).append(reader.go)
            missing += [reader.lacks for reader in readers]
            # A transfer that continues in the next step is taken in that step.
            if each.cut is not None:
                missing.append(state.step[each.number] & ~streams[each.cut.leaf].valid)
        for leaf, cases in ready.items():
            m.d.comb += streams[leaf].ready.eq(any_of(cases))
        status_free = ~c.status.valid | c.status.ready
        m.d.comb += [
            state.free.eq(~c.words.valid | c.words.ready),
            state.complete.eq(state.free & ~any_of(missing) & (~state.ends | status_free)),
        ]
        for slot, flag in enumerate(state.served):
            taken = [readers[slot].go for readers in self.readers if slot < len(readers)]
            m.d.sync += flag.eq((flag | any_of(taken)) & ~state.complete)

    def _take(self, index: int, slot: int) -> None:
        """Take a transfer of a step when it is offered, after the earlier ones of the step."""
        state, readers = self.state, self.readers[index]
        reader = readers[slot]
        valid = state.streams[reader.leaf].valid
        if reader.leaf in state.lengths:
            valid = valid & state.lengths[reader.leaf].known
        wanted = state.rest.any() if reader.optional else Const(1, 1)
        earlier = any_of([each.lacks for each in readers[:slot]])
        self.m.d.comb += [
            reader.left.eq(state.step[index] & wanted & ~state.served[slot]),
            reader.lacks.eq(reader.left & ~valid),
            reader.go.eq(reader.left & valid & state.free & ~earlier),
        ]

    def _hold_lengths(self) -> None:
        """Keep a length that is taken while its step waits until `status` is free."""
        state = self.state
        held: dict[int, list[Value]] = {leaf: [] for leaf in state.lengths}
        for each, readers in zip(self.program.states, self.readers, strict=True):
            for slot, reader in enumerate(readers):
                if reader.leaf in held and each.may_wait_for_status:
                    taken = reader.go | (state.step[each.number] & state.served[slot])
                    held[reader.leaf].append(taken & ~state.complete)
        for leaf, cases in held.items():
            self.m.d.comb += state.lengths[leaf].held.eq(any_of(cases))

    def _judge(self) -> None:
        """Keep the packet's first error, and report it with the last step."""
        m, c, state, streams = self.m, self.c, self.state, self.state.streams
        wrong_items = any_of(
            [
                reader.go & (streams[reader.leaf].payload.last != reader.last)
                for reader in chain.from_iterable(self.readers)
                if self.plan.leaves[reader.leaf].kind == "items"
            ]
        )
        error, found = Signal(Status, name="error"), Signal(Status, name="found")
        is_taken = any_of([streams[leaf].ready for leaf in state.lengths])
        over = is_taken & state.of_length(lambda length: length.over)
        # Items of a step come before its length in wire order, so their error counts.
        m.d.comb += found.eq(error)
        with m.If((error == Status.OK) & wrong_items):
            m.d.comb += found.eq(Status.ITEMS)
        with m.Elif((error == Status.OK) & over):
            m.d.comb += found.eq(Status.LENGTH)
        m.d.sync += error.eq(found)
        with m.If(c.status.ready):
            m.d.sync += c.status.valid.eq(0)
        with m.If(state.complete & state.ends):
            m.d.sync += [
                c.status.valid.eq(1),
                c.status.payload.eq(found),
                error.eq(Status.OK),
            ]
        with m.If(state.free):
            m.d.sync += c.words.payload.error.eq(found != Status.OK)

    # The next step.

    def _advance(self) -> None:
        m, state = self.m, self.state
        traits, flow = state.traits, state.flow
        next_rest = state.of_length(
            lambda length: length.rest, len(state.rest), lambda length: length.level is None
        )
        single = state.of_length(lambda length: length.single)
        count = self._count()
        flow.count(
            moves=state.complete,
            ends=state.ends,
            done=state.done,
            count=count,
            single=single,
            nul=False,
        )
        with m.If(state.complete):
            flow.go(ends=state.ends, done=state.done)
            with m.If(state.ends):
                m.d.sync += [state.rest.eq(0), state.has_nul.eq(0)]
            with m.Else():
                with m.If(traits.begins_run):
                    m.d.sync += [state.rest.eq(next_rest), state.has_nul.eq(traits.begins_string)]
                with m.Elif(traits.takes_rest):
                    m.d.sync += [state.rest.eq(0), state.has_nul.eq(0)]

    def _count(self) -> Value:
        """Return the payload of the step's length, 32 bits; 0 if the step has no length."""
        state = self.state
        cases = [
            (state.step[number], state.streams[length.leaf].payload)
            for number, length in self.program.lengths.items()
        ]
        return pick(cases, LENGTH_BITS)
