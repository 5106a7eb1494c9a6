"""Programs as text: one line for each state, with all that differs from an empty state."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from textwrap import shorten

from firm_hdl.plan import Plan
from firm_hdl.program.deserializer import (
    DeserializerProgram,
    DeserializerState,
    NextPosition,
    deserializer_program,
)
from firm_hdl.program.lengths import Length
from firm_hdl.program.serializer import (
    SerializerProgram,
    SerializerState,
    WireByte,
    serializer_program,
)
from firm_hdl.program.state import AnyState, Program, State, Transfer

__all__ = ["LEGEND", "MANY_STATES", "lane_remark", "program_lines", "program_text", "state_remark"]

MANY_STATES = 64
"""Most states that comments in a circuit's text describe in full."""

_END = "end of the packet"

LEGEND = """\
# One line a step: its number and name, what it takes, and where it leads. A step is one cycle.
# "map": bytes at fixed places, at most two bus words. "items": a bus word of a string or an
# array, which is a run of them. "rest": the last items of a run, which the next step takes
# before its map; "rest x 8": of 8 bytes each. "lanes": the bytes of the bus, from 0 on. "unit
# 4": bytes start and end at multiples of 4. "body": the step after a length that more than a
# rest follows. "level 0": the outermost sequence of elements; "while level 0": while it has
# elements left. "to 2 (+8)": the last byte of step 2 is 8 bytes after that of this step; with
# "align 4 | 3", then down to a multiple of 4, and 3 more: from byte 21, "+6, align 4 | 3" leads
# to byte 27. "a.length:0..3": bytes 0 to 3 of a leaf, from the first lane on.
"""


def program_text(plan: Plan) -> str:
    """Return the programs of the deserializer and the serializer of a plan."""
    lines = [f"{LEGEND}{plan.message} on {plan.wire}, bus of {plan.bus_bytes} bytes"]
    lines += program_lines(deserializer_program(plan))
    lines += program_lines(serializer_program(plan))
    return "\n".join(lines) + "\n"


def program_lines(program: DeserializerProgram | SerializerProgram) -> list[str]:
    """Return a line for the program, and one for each of its states."""
    plan = program.plan
    if isinstance(program, DeserializerProgram):
        ends = f", lengths end in {_lanes(program.length_lanes)}" if program.lengths else ""
        lines = [f"deserializer: {_head(program)}{ends}"]
        rows = ((each, _deserializer(plan, each)) for each in program.states)
        return lines + [_line(*row) for row in rows]
    lines = [f"serializer: {_head(program)}, at most {program.most_beats} beats a state"]
    return lines + [_line(each, _serializer(plan, each)) for each in program.states]


def _line(state: State, texts: Iterator[str]) -> str:
    return f"  {state.number} {state.name}: {'; '.join(texts)}"


def state_remark(program: Program[AnyState], state: AnyState) -> str:
    """Return what a state takes: the comment beside its signal, short if there are many states."""
    takes = "; ".join(_common(program.plan, state)) or _without_bytes(state)
    width = 200 if len(program.states) <= MANY_STATES else 60
    return shorten(f"step {state.number}: {takes}", width, placeholder=" ...")


def lane_remark(program: DeserializerProgram, lane: int) -> str:
    """Return which lengths may end in a lane, and what the kinds in the names of columns count."""
    ends = [program.lengths[k] for k in program.length_lanes[lane] if k in program.lengths]
    leaves = " ".join(str(program.plan.leaves[each.leaf]) for each in ends) or "none"
    kinds = {
        each.kind: f"{_counted(each)} up to {each.max_count}" for each in program.lengths.values()
    }
    texts = [f"lengths that may end in lane {lane}: {leaves}"]
    texts += [f"{kind}: {counted}" for kind, counted in kinds.items()]
    return shorten("; ".join(texts), 300, placeholder=" ...")


def _without_bytes(state: State) -> str:
    return _END if isinstance(state, DeserializerState) and state.at_end else "no bytes"


def _head(program: Program[AnyState]) -> str:
    texts = [f"start {program.start}"]
    for name, word in (("items", program.items), ("map", program.map)):
        if word.used:
            texts.append(f"{name} from {_lanes(word.lanes)}, unit {word.unit}")
    return ", ".join(texts)


def _lanes(lanes: Collection[int]) -> str:
    return f"lane{'s' * (len(lanes) > 1)} {' '.join(map(str, lanes))}"


def _common(plan: Plan, state: State) -> Iterator[str]:
    """Yield what a state takes."""
    if state.takes_rest:
        yield f"rest x {state.rest_unit}"
    if state.map_bytes:
        align = f" at multiple of {state.align}" if state.align > 1 else ""
        yield f"map of {state.map_bytes}{align}{' in two words' * state.two_word_map}"
    if state.transfers:
        yield " ".join(_transfer(plan, each) for each in state.transfers)
    if state.cut is not None:
        yield f"begins {plan.leaves[state.cut.leaf]}"


def _transfer(plan: Plan, transfer: Transfer) -> str:
    kind = "" if transfer.run is None else "(rest)" if transfer.is_rest else "(word)"
    return f"{plan.leaves[transfer.leaf]}{kind}"


def _counted(length: Length) -> str:
    if length.level is not None:
        return "elements without bytes" if length.counts_nothing else "elements"
    nul = " and a NUL" if length.has_nul else ""
    return f"items of {length.item_bytes} byte{'s' * (length.item_bytes > 1)}{nul}"


def _length(length: Length) -> str:
    texts = [f"counts {_counted(length)} up to {length.max_count}"]
    if length.align > 1:
        texts.append(f"at multiple of {length.align}")
    if length.charge is not None:
        texts.append(f"claims {length.charge.bytes} each from {length.charge.charged_from} on")
    return ", ".join(texts)


def _deserializer(plan: Plan, state: DeserializerState) -> Iterator[str]:
    if state.at_end:
        yield _END
        return
    yield from _common(plan, state)
    if state.checks:
        yield f"checks {' '.join(f'{lane}={byte:02x}' for lane, byte in state.checks)}"
    if state.is_leading:
        yield "waits for the packet"
    if state.length is not None:
        yield _length(state.length)
    if state.body is not None:
        yield f"body {state.body}{_position(state.body_start)}"
    begins_run = state.length is not None and state.length.level is None
    for way in state.exits:
        position = state.exit if way.level is None else state.again[way.level]
        # Decoded from the length, if no word of the run comes before its rest.
        yield f"to {way}{' (+all items)' if begins_run else _position(position)}"


def _position(position: NextPosition | None) -> str:
    """Return the way to the next last byte: what is added, and what alignment makes of it."""
    if position is None:
        return ""
    add = "+rest" if position.over_rest else f"+{position.add}"
    return f" ({add}, align {position.mask + 1} | {position.low})" if position.mask else f" ({add})"


def _serializer(plan: Plan, state: SerializerState) -> Iterator[str]:
    yield from _common(plan, state)
    for name, word in (("items", state.items), ("map", state.map)):
        if word:
            yield f"{name} = {_word(plan, word)}"
    if state.length is not None:
        yield _length(state.length)
    if state.precedes_leaves:
        yield "constants only"
    if state.is_final_tail:
        yield "skipped if there is no rest"
    if state.may_wait_for_status:
        yield "may wait until a status is taken"
    if state.body is not None:
        yield f"body {state.body}"
    for way in state.exits:
        yield f"to {way}"


def _word(plan: Plan, word: tuple[tuple[int, WireByte], ...]) -> str:
    """Return the bytes of a word: constants, and stretches of leaves as ``leaf:first..last``."""
    texts: list[str] = []
    previous: tuple[int, WireByte] | None = None
    for lane, byte in word:
        if byte.leaf is None:
            texts.append(f"{byte.at:02x}")
        elif previous == (lane - 1, WireByte(byte.leaf, byte.at - 1, byte.slot)):
            texts[-1] = f"{texts[-1].partition('..')[0]}..{byte.at}"
        else:
            texts.append(f"{plan.leaves[byte.leaf]}:{byte.at}")
        previous = lane, byte
    return " ".join(texts)
