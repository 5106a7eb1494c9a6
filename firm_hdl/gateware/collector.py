"""The collector: turn the leaves of a message into words, one state of the program per cycle."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from amaranth.hdl import Const, Module, Mux, Signal, Value
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import Out

from firm_hdl.gateware.flow import Flow, exceeds, last_word
from firm_hdl.gateware.positions import Ring, any_of, named, pick
from firm_hdl.gateware.signatures import Status, StatusSignature
from firm_hdl.gateware.words import words_layout, write_bytes
from firm_hdl.plan import Plan
from firm_hdl.program import (
    LENGTH_BITS,
    Length,
    SerializerProgram,
    SerializerState,
    Transfer,
    align_addend,
    leaf_names,
    unique,
)

__all__ = ["Collector"]


@dataclass(frozen=True, slots=True, kw_only=True)
class OfferedLength:
    """The length that a producer offers, decoded. Registers, valid from a cycle after the offer."""

    known: Signal  # The fields belong to the length that is offered now. High until the transfer.
    # The length is 0, or above its limit.
    zero: Signal
    over: Signal
    skips: Signal  # The body is skipped: the length is 0, or all items are in the rest.
    at_most_one_pass: Signal  # Of the body: one element, or one word.
    rest: Signal  # Number of items in the rest; always 0 for a loop.


@dataclass(frozen=True, slots=True, kw_only=True)
class _Reader:
    """A transfer that a state takes."""

    transfer: Transfer
    left: Signal  # The state has not taken the transfer.
    lacks: Signal  # The state has not taken the transfer, and it is not offered.
    go: Signal  # The transfer is taken in this cycle.


class Collector(wiring.Component):
    """Take the leaves of each state of a program, and put them into two words.

    Leaves are taken in wire order, each as soon as it is offered. A length is decoded in the cycle
    before it is taken, so it is taken one cycle after it is offered at the earliest. Latency 1
    cycle from the last leaf of a state to the state's words. Throughput one state per cycle::

        cycle              | 0        | 1         | 2
        length.valid       | 1        | 1         |
        known              |          | 1         |
        length.ready       |          | 1         |
        complete           |          | 1         |
        words.valid        |          |           | 1

    Parameters
    ----------
    program : SerializerProgram
    leaves : mapping of int to stream.Interface
        By leaf: streams of `leaf_shape(leaf)`, which the collector takes. `ready` depends
        combinationally on the `valid` of this leaf and of earlier leaves of the same state.

    Members
    -------
    words : Out(stream.Signature(words_layout(plan)))
        One transfer per state.
    status : Out(StatusSignature())
        One transfer per packet; `OK`, `LENGTH` or `ITEMS`.
    """

    def __init__(self, program: SerializerProgram, leaves: Mapping[int, stream.Interface]):
        self.program, self.leaves = program, leaves
        words = stream.Signature(words_layout(program.plan))
        super().__init__({"words": Out(words), "status": Out(StatusSignature())})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        program, plan, leaves, status = self.program, self.program.plan, self.leaves, self.status
        flow = Flow(m, program)
        begins_nothing = flow.register("begins_nothing", 1, lambda s: s.begins_nothing)
        begins_run = flow.register("begins_run", 1, lambda s: s.begins_run)
        begins_string = flow.register("begins_string", 1, lambda s: s.begins_string)
        begins_loop = flow.register("begins_loop", 1, lambda s: s.begins_loop)
        is_words = flow.register("is_words", 1, lambda s: s.is_words)
        takes_rest = flow.register("takes_rest", 1, lambda s: s.takes_rest)
        # Items in the rest of the last run, and whether a NUL follows them, until a state takes
        # them.
        rest = Signal(plan.max_run_lanes.bit_length())
        has_nul = Signal()
        # By number of a transfer in its state: it was taken in an earlier cycle.
        most = max(len(each.transfers) for each in program.states)
        served = [Signal(name=f"served_{k}") for k in range(most)]
        # A length was taken, but its state is not complete.
        names = leaf_names(plan)
        held = {
            each.leaf: Signal(name=f"held_{names[each.leaf]}") for each in program.lengths.values()
        }
        lengths = {
            each.leaf: _offered(m, names[each.leaf], each, leaves[each.leaf], held[each.leaf])
            for each in program.lengths.values()
        }

        def of_length(
            name: str, width: int = 1, test: Callable[[Length], bool] = lambda _: True
        ) -> Value:
            """Return a field of the state's length; 0 if it has none, or the test fails."""
            cases = [
                (flow.step[number], getattr(lengths[each.leaf], name))
                for number, each in program.lengths.items()
                if test(each)
            ]
            value = Signal(width, name=f"length_{name}")
            m.d.comb += value.eq(pick(cases, width))
            return value

        # What follows the state: an exit (`done`), and the end of the message. A last state that
        # only takes a rest is skipped if there is no rest. A CDR string has one in any case: its
        # NUL.
        done = Signal()
        ends = Signal()
        is_begin = begins_run | begins_loop
        tails = {each.number for each in program.states if each.is_final_tail}
        to_tail = named(
            m, "to_tail", any_of([each.taken for each in flow.exits if each.way.to in tails])
        )
        no_rest = is_begin & of_length("zero") & ~begins_string & to_tail
        m.d.comb += [
            done.eq(
                begins_nothing | (is_begin & of_length("skips")) | (is_words & flow.words.last)
            ),
            ends.eq(done & (flow.exit_ends | no_rest)),
        ]

        # Take the leaves of the state in wire order, each as soon as it is offered. A producer may
        # offer a leaf only after an earlier one was taken. So a state must not wait until all its
        # leaves are offered; `served` records which of them were taken.
        free = Signal()
        complete = Signal()
        has_rest = named(m, "has_rest", rest.any())
        readers: dict[int, list[_Reader]] = {}
        transfer_names = iter(
            unique(
                names[each.leaf] + "_rest" * each.is_rest
                for state in program.states
                for each in state.transfers
            )
        )
        for state in program.states:
            readers[state.number] = []
            for slot, transfer in enumerate(state.transfers):
                name = next(transfer_names)
                left, lacks, go = (
                    Signal(name=f"{what}_{name}") for what in ("left", "lacks", "go")
                )
                valid: Value = leaves[transfer.leaf].valid
                if transfer.leaf in lengths:
                    valid = valid & lengths[transfer.leaf].known
                # A rest may be empty.
                wanted = has_rest if transfer.is_rest else Const(1, 1)
                earlier = any_of([each.lacks for each in readers[state.number]])
                m.d.comb += [
                    left.eq(flow.step[state.number] & wanted & ~served[slot]),
                    lacks.eq(left & ~valid),
                    go.eq(left & valid & free & ~earlier),
                ]
                reader = _Reader(transfer=transfer, left=left, lacks=lacks, go=go)
                readers[state.number].append(reader)
        every = [reader for found in readers.values() for reader in found]
        for leaf in sorted({reader.transfer.leaf for reader in every}):
            ready = [reader.go for reader in every if reader.transfer.leaf == leaf]
            m.d.comb += leaves[leaf].ready.eq(any_of(ready))
        missing = [reader.lacks for reader in every]
        # A transfer that continues in a later state is taken in that state.
        missing += [
            flow.step[state.number] & ~leaves[state.cut.leaf].valid
            for state in program.states
            if state.cut is not None
        ]
        # The last state also waits for room for the status: so a status is never lost, and `status`
        # needs only one register.
        lacks_any = named(m, "lacks_any", any_of(missing))
        m.d.comb += [
            free.eq(~self.words.valid | self.words.ready),
            complete.eq(free & ~lacks_any & (~ends | ~status.valid | status.ready)),
        ]
        for slot, flag in enumerate(served):
            taken = [found[slot].go for found in readers.values() if slot < len(found)]
            serves = named(m, f"serves_{slot}", any_of(taken))
            m.d.sync += flag.eq((flag | serves) & ~complete)
        for leaf, hold in held.items():
            # Only a state that waits for `status` keeps a length that it has taken.
            m.d.comb += hold.eq(
                any_of(
                    [
                        (reader.go | (flow.step[state.number] & served[slot])) & ~complete
                        for state in program.states
                        if state.may_wait_for_status
                        for slot, reader in enumerate(readers[state.number])
                        if reader.transfer.leaf == leaf
                    ]
                )
            )

        # The packet's first error. Items of a state come before its length in wire order, so their
        # error counts.
        error = Signal(Status)
        found = Signal(Status)
        wrong_items = named(
            m,
            "wrong_items",
            any_of(
                [
                    reader.go & (leaves[reader.transfer.leaf].payload.last != _last(flow, reader))
                    for reader in every
                    if plan.leaves[reader.transfer.leaf].kind == "items"
                ]
            ),
        )
        is_taken = named(m, "takes_length", any_of([leaves[leaf].ready for leaf in lengths]))
        over = named(m, "takes_wrong_length", is_taken & of_length("over"))
        m.d.comb += found.eq(error)
        with m.If((error == Status.OK) & wrong_items):
            m.d.comb += found.eq(Status.ITEMS)
        with m.Elif((error == Status.OK) & over):
            m.d.comb += found.eq(Status.LENGTH)
        m.d.sync += error.eq(found)
        with m.If(status.ready):
            m.d.sync += status.valid.eq(0)
        with m.If(complete & ends):
            m.d.sync += [status.valid.eq(1), status.payload.eq(found), error.eq(Status.OK)]

        # The words.
        write_bytes(m, program, flow.step, leaves, served, free, self.words.payload)
        nul = has_nul & takes_rest
        items_align = _items_align(m, plan, program, flow, lengths)
        self._write_sizes(m, flow, rest, nul, takes_rest, items_align, ends, complete, free)
        with m.If(free):
            m.d.sync += [
                self.words.valid.eq(complete),
                self.words.payload.last.eq(ends),
                self.words.payload.waits.eq(flow.on(lambda state: state.precedes_leaves)),
                self.words.payload.error.eq(found != Status.OK),
            ]

        # The next state.
        next_rest = of_length("rest", len(rest), lambda each: each.level is None)
        count = [(flow.step[k], leaves[each.leaf].payload) for k, each in program.lengths.items()]
        flow.advance(
            moves=complete,
            ends=ends,
            done=done,
            count=named(m, "count", pick(count, LENGTH_BITS)),
            single=of_length("at_most_one_pass"),
            nul=False,
        )
        # The rest waits for the state that takes it; in between are only words of its own run.
        with m.If(complete):
            with m.If(ends):
                m.d.sync += [rest.eq(0), has_nul.eq(0)]
            with m.Elif(begins_run):
                m.d.sync += [rest.eq(next_rest), has_nul.eq(begins_string)]
            with m.Elif(takes_rest):
                m.d.sync += [rest.eq(0), has_nul.eq(0)]
        return m

    def _write_sizes(
        self,
        m: Module,
        flow: Flow[SerializerState],
        rest: Value,
        nul: Value,
        takes_rest: Value,
        items_align: tuple[Value, Value],
        ends: Value,
        complete: Value,
        free: Value,
    ) -> None:
        """Write the sizes of the words, and the distances between their positions, while `free`."""
        bus, words, ring = self.program.plan.bus_bytes, self.words.payload, Ring(self.program.plan)
        bits = bus.bit_length()
        map_bytes = flow.register("map_bytes", bits, lambda s: s.word_bytes)
        item_word = flow.register("items_bytes", bits, lambda s: s.item_word_bytes)
        map_mask = flow.register("map_mask", 3, lambda s: s.map_mask)
        map_addend = flow.register("map_addend", 3, lambda s: s.map_addend)
        two_word_map = flow.register("two_word_map", 1, lambda s: s.two_word_map)
        items = Signal(range(bus + 1), name="items_size")
        map_size = Signal(range(2 * bus + 1))
        to_map = Signal.like(words.to_map)
        to_end = Signal.like(words.to_end)
        end_mask = Signal(max(3, ring.lane_bits))
        # Whether the packet has a byte before this state, and whether it has one after the state.
        begun = Signal()
        begins = Signal()
        m.d.comb += [
            items.eq(Mux(takes_rest, flow.rest_bytes(rest), item_word)),
            map_size.eq(map_bytes + Mux(two_word_map, bus, 0)),
            begins.eq(begun | items.any() | nul | map_bytes.any()),
            # If the map has two words, the word of items is the first of them: nothing precedes it.
            to_map.eq(Mux(two_word_map, 0, items) + nul + map_addend),
            to_end.eq(map_size + items_align[0]),
            end_mask.eq(items_align[1]),
        ]
        # The next packet starts with a beat (rule 7 of docs/reference/streams.md), so the end is
        # rounded up. An empty packet has a beat as well (rule 6).
        with m.If(ends):
            m.d.comb += [to_end.eq(Mux(begins, map_size + (bus - 1), bus)), end_mask.eq(bus - 1)]
        # The state may start in the last lane of a beat.
        most_bytes = named(m, "most_bytes", to_map + to_end + (bus - 1))
        with m.If(complete):
            m.d.sync += begun.eq(begins & ~ends)
        with m.If(free):
            m.d.sync += [
                words.items_bytes.eq(items),
                words.map_bytes.eq(map_bytes),
                words.two_word_map.eq(two_word_map),
                words.to_map.eq(to_map),
                words.max_beats.eq(most_bytes >> ring.lane_bits),
                words.map_mask.eq(map_mask),
                words.to_end.eq(to_end),
                words.end_mask.eq(end_mask),
                words.empty.eq(~begins),
            ]


def _offered(
    m: Module, name: str, length: Length, port: stream.Interface, held: Value
) -> OfferedLength:
    """Decode the length that is offered, unless it is `held`."""
    value, known = port.payload, Signal(name=f"known_{name}")
    fields = ("zero", "over", "skips", "at_most_one_pass")
    zero, over, skips, one = (Signal(name=f"{each}_{name}", reset_less=True) for each in fields)
    rest = Signal(length.lanes.bit_length(), name=f"rest_{name}", reset_less=True)
    is_zero = named(m, f"offered_{name}_is_0", ~value.any())
    m.d.sync += known.eq(port.valid & ~port.ready & ~held)
    with m.If(~held):
        m.d.sync += [zero.eq(is_zero), over.eq(exceeds(value, length.limit))]
        if length.level is not None:
            m.d.sync += [skips.eq(is_zero), one.eq(value == 1), rest.eq(0)]
        else:
            m.d.sync += [
                skips.eq(~exceeds(value, length.lanes)),
                one.eq(~exceeds(value, 2 * length.lanes)),
                rest.eq(Mux(is_zero, 0, last_word(value, length.lanes))),
            ]
    return OfferedLength(
        known=known, zero=zero, over=over, skips=skips, at_most_one_pass=one, rest=rest
    )


def _last(flow: Flow[SerializerState], reader: _Reader) -> Value:
    """Return the value that `items.last` must have in a transfer."""
    part, run = reader.transfer.part, reader.transfer.run
    if part is not None:
        if part.level is not None:
            return flow.levels[part.level].last
        return Const(part.last, 1)
    assert run is not None
    if run.counted:
        return Const(reader.transfer.is_rest, 1)
    return flow.words.last & (not run.has_tail)


def _items_align(
    m: Module,
    plan: Plan,
    program: SerializerProgram,
    flow: Flow[SerializerState],
    lengths: Mapping[int, OfferedLength],
) -> tuple[Value, Value]:
    """Return the addend and the mask that align the first item of the run that the state begins.

    Both are 3 bits, and 0 for an empty run, which has no padding.
    """
    addends, masks = [], []
    for number, length in program.lengths.items():
        if length.align > 1:
            not_empty = flow.step[number] & ~lengths[length.leaf].zero
            # On a narrow bus, the packer aligns without an addend.
            wide = plan.bus_bytes >= 8
            addends.append(
                (not_empty, align_addend(length.align, plan.header_bytes) if wide else 0)
            )
            masks.append((not_empty, length.align - 1))
    addend = named(m, "items_align_addend", pick(addends, 3))
    return addend, named(m, "items_align_mask", pick(masks, 3))
