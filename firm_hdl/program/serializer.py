"""The program of a serializer: the states of its collector."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from firm_hdl.plan.tree import Fixed, Part, Plan, Run, Step
from firm_hdl.program.control import Control, control_of, start_of
from firm_hdl.program.lanes import start_lanes, word_lanes
from firm_hdl.program.names import state_names
from firm_hdl.program.state import Program, State, common_fields
from firm_hdl.timing.rings import ends_in_tail, first_step, may_end_empty, most_beats

__all__ = [
    "LENGTH_BITS",
    "SerializerProgram",
    "SerializerState",
    "WireByte",
    "serializer_program",
]

LENGTH_BITS = 32
"""Width of lengths. Counters have this width, because the items of any length are taken."""


@dataclass(frozen=True, slots=True)
class WireByte:
    """A byte of a state's words."""

    leaf: int | None  # The leaf that the byte belongs to; `None` for a constant.
    at: int  # Number of the byte in the transfer, or the value of the constant.
    # Number of the byte's transfer in the state; -1 for a constant, or if a later state takes the
    # transfer.
    slot: int


@dataclass(frozen=True, slots=True, kw_only=True)
class SerializerState(State):
    """A state of the collector."""

    # Bytes in the word of the map and in that of items. The rest, whose size varies, is not
    # counted.
    word_bytes: int
    item_word_bytes: int
    # To align the map: the low bits to clear, and the addend of the rounding, if alignment counts
    # from a constant.
    map_mask: int
    map_addend: int
    is_final_tail: bool  # The state always ends the packet, and takes nothing but a rest.
    # The state may take its length, and then wait until `status` is free. A length is the last
    # transfer of its state; so nothing else can delay the state after it.
    may_wait_for_status: bool
    precedes_leaves: bool  # Only constants come before the end of the state.
    # Lanes and bytes of the two words.
    items: tuple[tuple[int, WireByte], ...]
    map: tuple[tuple[int, WireByte], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class SerializerProgram(Program[SerializerState]):
    """The program of a serializer."""

    most_beats: int  # Largest number of beats that a state touches, its padding included.
    # A packet may end in a state without bytes. Then its last beat may be full before it is known
    # to be the last one.
    may_end_without_bytes: bool


def serializer_program(plan: Plan) -> SerializerProgram:
    """Return the program of a serializer."""
    start, control = start_of(plan), control_of(plan)
    items, map_ = word_lanes(plan, start_lanes(plan))
    return SerializerProgram(
        plan=plan,
        states=tuple(
            _state(plan, number, name, each)
            for number, (name, each) in enumerate(zip(state_names(plan), control, strict=True))
        ),
        start=start,
        most_counted=(1 << LENGTH_BITS) - 1,
        items=items,
        map=map_,
        most_beats=most_beats(plan),
        may_end_without_bytes=may_end_empty(plan),
    )


def _state(plan: Plan, number: int, name: str, control: Control) -> SerializerState:
    bus, fields = plan.bus_bytes, common_fields(plan, number, name, control)
    align, two_words, counted = fields["align"], fields["two_word_map"], fields["is_counted"]
    tail = len(plan.steps) - 1 if ends_in_tail(plan) else None
    may_end = any(each.to in (None, tail) for each in control.exits)
    words: dict[str, list[tuple[int, WireByte]]] = {"items": [], "map": []}
    for name, lane, byte in _bytes(plan, control.item):
        words[name].append((lane, byte))
    takes_word = fields["is_words"] and not counted
    return SerializerState(
        **fields,
        word_bytes=bus if takes_word else fields["map_bytes"] - bus * two_words,
        item_word_bytes=bus if two_words or counted else 0,
        map_mask=align - 1,
        map_addend=align - 1 - plan.header_bytes % align if bus >= 8 else 0,
        is_final_tail=number == tail,
        may_wait_for_status=control.begin is not None and may_end,
        precedes_leaves=number < first_step(plan),
        items=tuple(words["items"]),
        map=tuple(words["map"]),
    )


def _bytes(plan: Plan, step: Step | Run) -> Iterator[tuple[str, int, WireByte]]:
    """Yield the bytes of a step's words: the word, the lane, and the byte."""
    if isinstance(step, Run):
        name = "items" if step.counted else "map"
        yield from ((name, *each) for each in _run_word(plan, step.leaf))
        return
    bus, slot = plan.bus_bytes, 0
    if step.rest is not None:
        yield from (("items", *each) for each in _run_word(plan, step.rest))
        slot += 1
    for at, item in step.places:
        found = [WireByte(None, 0, -1)] * item.bytes
        if isinstance(item, Fixed):
            found = [WireByte(None, value, -1) for value in item.data]
        elif isinstance(item, Part):
            number = slot if item.completes else -1
            found = [WireByte(item.leaf, item.first + k, number) for k in range(item.bytes)]
            slot += item.completes
        for k, byte in enumerate(found, at):
            name = "items" if step.bytes > bus > k else "map"
            yield name, k % bus if step.bytes > bus else k, byte


def _run_word(plan: Plan, leaf: int) -> Iterator[tuple[int, WireByte]]:
    """Yield the bytes of a transfer of items, with their lanes."""
    items = plan.leaves[leaf]
    return ((k, WireByte(leaf, k, 0)) for k in range(items.lanes * items.item_bytes))
