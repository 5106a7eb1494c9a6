"""What the programs of both directions have in common: states, and the transfers of each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from firm_hdl.plan import tree
from firm_hdl.plan.tree import Plan, Run, Step
from firm_hdl.program.control import Control, Transition
from firm_hdl.program.lanes import WordLanes
from firm_hdl.program.lengths import Length, length_of

__all__ = ["AnyState", "Part", "Program", "State", "Transfer", "common_fields", "repeated_leaves"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """Bytes of a transfer in the map of a state.

    Attributes
    ----------
    at : int
        Offset of the part in the map.
    bytes, leaf, first, size : int
        As in the plan's part.
    last : bool
        Whether the transfer can be the last one of its leaf.
    level : int or None
        The transfer is the last one only in the last element of this loop.
    """

    at: int
    bytes: int
    leaf: int
    first: int
    size: int
    last: bool
    level: int | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Transfer:
    """A transfer that a state completes.

    Attributes
    ----------
    leaf : int
    part : Part or None
        Its bytes in the map; `None` for a word or the rest of a run.
    run : Run or None
        The run of the word or rest.
    is_rest : bool
    counts_nul : bool
        The transfer is a length, which on the wire counts a NUL as well.
    """

    leaf: int
    part: Part | None = None
    run: Run | None = None
    is_rest: bool = False
    counts_nul: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class State:
    """What a converter does in one cycle.

    A state takes the rest of a run, then a map: bytes whose places are static. The state of a run's
    words takes one word instead.
    """

    number: int
    name: str  # Identifier, unique in the program, after the leaves that the state handles.
    # Into the body of the run or loop that `length` counts, or to the next word of the same run.
    body: Transition | None = None
    exits: tuple[Transition, ...] = ()  # The other transitions; see `Control`.
    # The state takes a word of a run, and a length counts the items of this run.
    is_words: bool = False
    is_counted: bool = False
    takes_rest: bool = False  # The state takes the rest of a run before its map.
    rest_unit: int = 0  # Bytes of an item of this rest; 0 without.
    # Alignment and size of the map.
    align: int = 1
    map_bytes: int = 0
    two_word_map: bool = False  # The map has more bytes than a bus word.
    length: Length | None = None  # The length at the end of the map.
    transfers: tuple[Transfer, ...] = ()  # In wire order.
    cut: Part | None = None  # The bytes of a transfer that a later state completes.

    def successors(self) -> Iterator[Transition]:
        """Yield all transitions: the body, then the exits."""
        if self.body is not None:
            yield self.body
        yield from self.exits

    @property
    def begins_nothing(self) -> bool:
        """The state always takes an exit."""
        return self.length is None and not self.is_words

    @property
    def begins_run(self) -> bool:
        """A length of the state counts the items of a run."""
        return self.length is not None and self.length.level is None

    @property
    def begins_string(self) -> bool:
        """A length of the state counts the items of a run and a NUL."""
        return self.length is not None and self.length.has_nul

    @property
    def begins_loop(self) -> bool:
        """A length of the state counts the elements of a loop."""
        return self.length is not None and self.length.level is not None


AnyState = TypeVar("AnyState", bound=State)


@dataclass(frozen=True, slots=True, kw_only=True)
class Program(Generic[AnyState]):
    """A plan as a circuit of one direction needs it."""

    plan: Plan
    # By number; that of a state is also the index of its step in the plan.
    states: tuple[AnyState, ...]
    start: Transition  # To the first state of each packet.
    end: int | None = None  # The state that waits for the end of the packet; `None`: there is none.
    # Largest length that a counter is loaded with; `None`: the length's own limit.
    most_counted: int | None = None
    # Where the two words of a state may be: the rest, counted items or the first word of a map with
    # two, and the map or another word.
    items: WordLanes
    map: WordLanes

    @property
    def lengths(self) -> dict[int, Length]:
        """The lengths, by state."""
        return {each.number: each.length for each in self.states if each.length is not None}

    @property
    def aligns(self) -> bool:
        """Whether anything has padding of variable size before it."""
        runs = (length.align > 1 for length in self.lengths.values())
        return any(each.align > 1 for each in self.states) or any(runs)

    def most_loaded(self, level: int | None) -> int:
        """Return the largest number that is loaded into the counter of a loop, or of words."""
        ways = [self.start, *(way for each in self.states for way in each.successors())]
        most = [load.number for way in ways for load in way.loads if load.level == level]
        most += [
            (self.most_counted or length.max_count) // length.lanes
            for length in self.lengths.values()
            if length.level == level
        ]
        return max([1, *most])


def common_fields(plan: Plan, number: int, name: str, control: Control) -> dict[str, Any]:
    """Return the fields that states of both directions have."""
    step = control.item
    fields: dict[str, Any] = {
        "number": number,
        "name": name,
        "body": control.body,
        "exits": control.exits,
    }
    if isinstance(step, Run):
        word = Transfer(leaf=step.leaf, run=step)
        # The state before has aligned the items that a length counts.
        align = 1 if step.counted else step.align
        return fields | {
            "is_words": True,
            "is_counted": step.counted,
            "align": align,
            "map_bytes": 0,
            "two_word_map": False,
            "transfers": (word,),
        }
    length, parts = length_of(plan, control), parts_of(step, control.level)
    cut = [part for part in parts if part.first + part.bytes < part.size]
    transfers = []
    if step.rest is not None:
        transfers.append(Transfer(leaf=step.rest, run=plan.run_of[step.rest], is_rest=True))
    for part in parts:
        if part not in cut:
            counts_nul = length is not None and part.leaf == length.leaf and length.has_nul
            transfers.append(Transfer(leaf=part.leaf, part=part, counts_nul=counts_nul))
    return fields | {
        "is_words": False,
        "is_counted": False,
        "takes_rest": step.rest is not None,
        "rest_unit": 0 if step.rest is None else plan.leaves[step.rest].item_bytes,
        "align": step.align,
        "map_bytes": step.bytes,
        "two_word_map": step.bytes > plan.bus_bytes,
        "length": length,
        "transfers": tuple(transfers),
        "cut": cut[0] if cut else None,
    }


def parts_of(step: Step, level: int) -> list[Part]:
    """Return the parts of a step that is inside `level` loops."""
    return [
        Part(
            at=at,
            bytes=item.bytes,
            leaf=item.leaf,
            first=item.first,
            size=item.size,
            last=item.last is not None,
            level=level - 1 if item.last == "in loop" else None,
        )
        for at, item in step.places
        if isinstance(item, tree.Part)
    ]


def repeated_leaves(states: Sequence[State], start: Transition) -> frozenset[int]:
    """Return the leaves that may transfer in two states in a row."""
    leaves = [{transfer.leaf for transfer in state.transfers} for state in states]
    repeated: set[int] = set()
    for state in states:
        for way in state.successors():
            to = start.to if way.to is None else way.to
            repeated |= leaves[state.number] & leaves[to or 0]
    return frozenset(repeated)
