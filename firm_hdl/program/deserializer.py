"""The program of a deserializer or parser: the states of its sequencer."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby, takewhile
from operator import itemgetter

from firm_hdl.plan.tree import Fixed, Plan, Run, Step
from firm_hdl.program.control import Control, control_of, start_of
from firm_hdl.program.lanes import StartLanes, start_lanes, word_lanes
from firm_hdl.program.lengths import Length, NextMap, length_of, with_columns
from firm_hdl.program.names import state_names, unique
from firm_hdl.program.state import Program, State, common_fields, repeated_leaves

__all__ = [
    "DeserializerProgram",
    "DeserializerState",
    "NextPosition",
    "align_addend",
    "deserializer_program",
    "distance_to",
]


@dataclass(frozen=True, slots=True, kw_only=True)
class NextPosition:
    """The way from a state's last byte to the last byte of the next state.

    To align a position, a circuit adds a distance, clears low bits, and sets them.
    """

    # The distance before alignment. It includes what the rounding and the next state's own bytes
    # need, if alignment counts from a constant; else it is 1.
    add: int
    mask: int  # The low bits that alignment clears.
    # Their new value; a distance after alignment, if alignment does not count from a constant.
    low: int
    # The rest of a run comes between: its distance, a register, replaces `add`.
    over_rest: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class DeserializerState(State):
    """A state of the sequencer."""

    at_end: bool = False  # The message is complete; the state waits for the end of the packet.
    # Distance from the first byte of the map or word to its last one; -1 if it has none.
    last_offset: int
    map_offset: int  # Distance from the last byte to the first one of the map's last word.
    # Lane and value of the bytes of the encapsulation header that are checked in the state.
    checks: tuple[tuple[int, int], ...] = ()
    is_leading: bool = False  # No byte of the packet comes before the end of the state.
    # Of the last exit, and of the body.
    exit: NextPosition | None = None
    body_start: NextPosition | None = None
    again: tuple[NextPosition | None, ...] = ()  # By loop: of the exit that repeats it.


@dataclass(frozen=True, slots=True, kw_only=True)
class DeserializerProgram(Program[DeserializerState]):
    """The program of a deserializer or parser."""

    # Whether the circuit writes leaves. A parser does not, and skips elements without bytes.
    has_leaves: bool
    # By lane, ascending: the states whose map may end in this lane and which begin a run or loop.
    length_lanes: Mapping[int, tuple[int, ...]]
    repeated_leaves: frozenset[int]  # The leaves that may transfer in two states in a row.
    carried_bytes: int  # Most bytes of a transfer that a state leaves to a later one.
    ends_at_once: bool  # A packet may end in the state in which it starts.

    @property
    def has_strings(self) -> bool:
        """Whether any run ends in a NUL."""
        return any(length.nul for length in self.plan.lengths.values())

    @property
    def may_have_no_bytes(self) -> bool:
        """Whether a state before the last one may have no bytes.

        Its leaves are empty messages, or it takes a rest that may be 0.
        """
        inner = (s for s in self.states if s.body or any(way.to is not None for way in s.exits))
        return any(each.last_offset < 0 for each in inner)

    @property
    def count_bits(self) -> int:
        """Bits of the largest legal length."""
        return max((each.max_count.bit_length() for each in self.lengths.values()), default=1)

    @property
    def rest_bits(self) -> int:
        """Bits of the number of items in a rest."""
        return self.plan.max_run_lanes.bit_length()


def align_addend(align: int, phase: int, shift: int = 0) -> int:
    """Return the addend after which clearing the low bits rounds a position up.

    * `align`: a power of two, at most 8. Aligned positions are `phase` plus a multiple of `align`.
    * `shift`: bytes that are added after the rounding.
    """
    return align - 1 - phase % align + (phase % align + shift) // align * align


def deserializer_program(plan: Plan, *, has_leaves: bool = True) -> DeserializerProgram:
    """Return the program of a deserializer, or of a parser if there are no leaves."""
    start, control = start_of(plan), control_of(plan)
    starts = start_lanes(plan)
    items, map_ = word_lanes(plan, starts)
    number = len(plan.steps)
    *names, end_name = unique([*state_names(plan), "packet_end"])
    end = DeserializerState(number=number, name=end_name, at_end=True, last_offset=-1, map_offset=1)
    leading = len(list(takewhile(lambda s: isinstance(s, Step) and not s.bytes, plan.steps)))
    states = tuple(
        _state(plan, index, name, control, is_leading=index < leading, has_leaves=has_leaves)
        for index, name in enumerate(names)
    )
    lengths = with_columns({s.number: s.length for s in states if s.length is not None})
    states = tuple(replace(each, length=lengths.get(each.number)) for each in states)
    parts = [part for step in plan.steps if isinstance(step, Step) for part in step.parts]
    return DeserializerProgram(
        plan=plan,
        states=(*states, end),
        start=start,
        end=number,
        items=items,
        map=map_,
        has_leaves=has_leaves,
        length_lanes=_length_lanes(plan, control, starts),
        repeated_leaves=repeated_leaves(states, start),
        carried_bytes=max((part.first for part in parts), default=0),
        ends_at_once=states[start.to or 0].exits[-1].to is None,
    )


def _state(
    plan: Plan,
    number: int,
    name: str,
    control: Sequence[Control],
    *,
    is_leading: bool,
    has_leaves: bool,
) -> DeserializerState:
    mine, bus = control[number], plan.bus_bytes
    step, exits = mine.item, mine.exits
    is_counted = isinstance(step, Run) and step.counted
    again: list[NextPosition | None] = [None] * plan.levels
    for each in exits[:-1]:
        assert each.level is not None
        again[each.level] = _next(plan, _next_map(plan, each.to), over_rest=is_counted)
    body_start = None
    if mine.begin is not None and mine.body is not None:
        # The body of a run starts with its first item, and is aligned like that.
        body = _next_map(plan, mine.body.to)
        align = mine.begin.align if isinstance(mine.begin, Run) else body.align
        body_start = _next(plan, replace(body, align=align))
    elif mine.body is not None:
        body_start = _next(plan, NextMap(1, bus - 1))
    own = _next_map(plan, number)
    fields = common_fields(plan, number, name, mine)
    if mine.begin is not None:
        fields["length"] = _length(plan, control, number, has_leaves=has_leaves)
    places = step.places if isinstance(step, Step) else ()
    fixed = [(at, item) for at, item in places if isinstance(item, Fixed) and item.check]
    return DeserializerState(
        **fields,
        last_offset=own.last_offset,
        map_offset=(own.last_offset >= bus) * bus - own.last_offset,
        checks=tuple((at + k, byte) for at, item in fixed for k, byte in enumerate(item.data)),
        is_leading=is_leading,
        exit=_next(plan, _next_map(plan, exits[-1].to), over_rest=is_counted),
        body_start=body_start,
        again=tuple(again),
    )


def _next_map(plan: Plan, number: int | None) -> NextMap:
    """Return the map or word of a step; `None` is the end of the packet."""
    if number is None:
        return NextMap(1, -1)
    step = plan.steps[number]
    if isinstance(step, Run):
        # The state before has aligned the items that a length counts.
        return NextMap(1 if step.counted else step.align, plan.bus_bytes - 1)
    return NextMap(step.align, step.bytes - 1)


def _next(plan: Plan, to: NextMap, *, over_rest: bool = False) -> NextPosition:
    """Return the way to the last byte of a map or word that follows."""
    # On a narrow bus, packets start at any offset modulo 8: alignment counts from a register.
    low = (plan.header_bytes + to.last_offset) % to.align if plan.bus_bytes >= 8 else to.last_offset
    return NextPosition(add=distance_to(plan, to), mask=to.align - 1, low=low, over_rest=over_rest)


def distance_to(plan: Plan, to: NextMap) -> int:
    """Return the distance from a state's last byte to that of the next one, before alignment."""
    if plan.bus_bytes < 8:
        return 1
    if to.align == 1:
        return 1 + to.last_offset
    return 1 + align_addend(to.align, plan.header_bytes, to.last_offset)


def _length(plan: Plan, control: Sequence[Control], number: int, *, has_leaves: bool) -> Length:
    """Return the length of a step that begins a loop or a run."""
    mine = control[number]
    length = length_of(plan, mine)
    assert length is not None
    assert mine.body is not None
    if length.level is None:
        nexts = tuple(_next_map(plan, each.to) for each in mine.exits if each.to is not None)
        return replace(length, nexts=nexts)
    to = control[mine.body.to or 0]
    is_empty = isinstance(to.item, Step) and not to.item.bytes and to.begin is None
    return replace(length, counts_nothing=is_empty and not has_leaves)


def _length_lanes(
    plan: Plan, control: Sequence[Control], starts: Sequence[StartLanes]
) -> dict[int, tuple[int, ...]]:
    ends = {
        ((lane + mine.item.bytes - 1) % plan.bus_bytes, number)
        for number, (mine, start) in enumerate(zip(control, starts, strict=True))
        if mine.begin is not None and isinstance(mine.item, Step)
        for lane in start.map
    }
    by_lane = groupby(sorted(ends), key=itemgetter(0))
    return {lane: tuple(number for _, number in group) for lane, group in by_lane}
