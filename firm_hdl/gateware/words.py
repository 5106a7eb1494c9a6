"""Words: what the collector hands to the packer, one transfer per state."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from amaranth.hdl import Cat, Const, Module, Signal, Value
from amaranth.lib import data, stream

from firm_hdl.gateware.positions import Ring, any_of, named, pick
from firm_hdl.plan import Plan
from firm_hdl.program import LENGTH_BITS, SerializerProgram, WireByte, leaf_names

__all__ = ["words_layout", "write_bytes"]


def words_layout(plan: Plan) -> data.StructLayout:
    """Return the payload of the stream of words: the bytes of one state, in wire order.

    To round a position up, the packer adds a distance and clears low bits. Each distance includes
    the addend of the rounding, so one addition is enough.

    Members
    -------
    items, map : unsigned(8 * bus_bytes)
        The word of items, and that of the map. If `two_word_map`, `items` is the first word of the
        map.
    items_bytes, map_bytes : range(bus_bytes + 1)
        Number of bytes in these words, from lane 0 on.
    two_word_map : unsigned(1)
        The map has two words.
    to_map : range(bus_bytes + 9); map_mask : unsigned(3)
        Distance in bytes from the start of this state to the map, and the low bits that the map's
        alignment clears.
    to_end : range(3 * bus_bytes + 9); end_mask : unsigned(max(3, lane_bits))
        Distance in bytes from the start of the map to the start of the next state, and the low bits
        that its alignment clears. After the last state, the next packet starts with the next beat.
    max_beats : unsigned
        Upper bound of the beats from the start of this state to the start of the next one.
    last : unsigned(1)
        The packet ends with this state.
    empty : unsigned(1)
        The packet has no byte up to the end of this state.
    waits : unsigned(1)
        No leaf was taken so far, only constants: no beat of the packet may be sent yet.
    error : unsigned(1)
        The packet is marked with an error. Only used if `last`.
    """
    ring, bus = Ring(plan), plan.bus_bytes
    return data.StructLayout(
        {
            "items": 8 * bus,
            "map": 8 * bus,
            "items_bytes": range(bus + 1),
            "map_bytes": range(bus + 1),
            "two_word_map": 1,
            "to_map": range(bus + 9),
            "map_mask": 3,
            "to_end": range(3 * bus + 9),
            "end_mask": max(3, ring.lane_bits),
            "max_beats": range((bus - 1 + (bus + 8) + (3 * bus + 8)) // bus + 1),
            "last": 1,
            "empty": 1,
            "waits": 1,
            "error": 1,
        }
    )


def write_bytes(
    m: Module,
    program: SerializerProgram,
    step: Sequence[Value],
    leaves: Mapping[int, stream.Interface],
    served: Sequence[Value],
    free: Value,
    words: data.View,
) -> None:
    """Write the bytes of the state to its two words, while `free`, until their leaf is taken.

    The state alone selects the bytes, so no data path depends on `valid` of a leaf.

    * `served`: by number of a transfer in its state: it was taken in an earlier cycle.
    * `words`: `items` and `map` are written.
    """
    payloads = {k: _wire_bits(m, program, k, each.payload) for k, each in leaves.items()}
    for name in ("items", "map"):
        # By lane: the byte of each state.
        word: list[dict[int, WireByte]] = [{} for _ in range(program.plan.bus_bytes)]
        for state in program.states:
            for lane, byte in state.items if name == "items" else state.map:
                word[lane][state.number] = byte
        for lane, stretch in _stretches(word):
            cases = stretch[0]
            register = Signal(8 * len(stretch), name=f"{name}_{lane}", reset_less=True)
            taken = [
                any_of([step[k] for k, byte in cases.items() if byte.slot == slot]) & flag
                for slot, flag in enumerate(served)
                if any(byte.slot == slot for byte in cases.values())
            ]
            with m.If(named(m, f"{name}_{lane}_writes", free & ~any_of(taken))):
                m.d.sync += register.eq(_selected(step, payloads, stretch))
            bits = getattr(words, name)[8 * lane :]
            m.d.comb += bits[: len(register)].eq(register)


def _selected(
    step: Sequence[Value],
    payloads: Mapping[int, Value],
    stretch: list[dict[int, WireByte]],
) -> Value:
    """Return the bytes of a stretch that the state selects; don't care if there are none."""
    size = len(stretch)
    groups: dict[tuple[int, int], tuple[Value, list[Value]]] = {}
    for number, byte in stretch[0].items():
        if byte.leaf is None:
            constant = sum(lane[number].at << 8 * k for k, lane in enumerate(stretch))
            key, value = (-1, constant), Value.cast(Const(constant, 8 * size))
        else:
            key = (byte.leaf, byte.at)
            value = payloads[byte.leaf][8 * byte.at : 8 * (byte.at + size)]
        groups.setdefault(key, (value, []))[1].append(step[number])
    found = [(any_of(on), value) for value, on in groups.values()]
    return found[0][1] if len(found) == 1 else pick(found, 8 * size)


def _wire_bits(m: Module, program: SerializerProgram, leaf: int, payload: Any) -> Value:
    """Return the bits of a leaf's transfer on the wire."""
    match program.plan.leaves[leaf].kind:
        case "items":
            return Cat(_item_bits(item) for item in payload.data)
        case "length":
            counts_nul = any(
                each.has_nul and each.leaf == leaf for each in program.lengths.values()
            )
            if not counts_nul:
                return Value.cast(payload)
            name = f"{leaf_names(program.plan)[leaf]}_with_nul"
            return named(m, name, (payload + 1)[:LENGTH_BITS])
        case _:
            return _item_bits(payload)


def _stretches(word: list[dict[int, WireByte]]) -> Iterator[tuple[int, list[dict[int, WireByte]]]]:
    """Divide a word into stretches of lanes with common selects; yield first lane and stretch."""
    first = 0
    for lane in range(1, len(word) + 1):
        if lane < len(word) and _follows(word[lane - 1], word[lane]):
            continue
        if word[first]:
            yield first, word[first:lane]
        first = lane


def _follows(before: dict[int, WireByte], after: dict[int, WireByte]) -> bool:
    """Tell whether two lanes have consecutive bytes of the same leaves in the same states."""
    return before.keys() == after.keys() and all(
        after[index] == replace(byte, at=byte.at + 1)
        if byte.leaf is not None
        else after[index].leaf is None
        for index, byte in before.items()
    )


def _item_bits(item: Value) -> Value:
    """Return the bits of an item on the wire; a bool is extended to a byte."""
    value = Value.cast(item)
    return Cat(value, Const(0, -len(value) % 8))
