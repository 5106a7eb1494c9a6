"""Waveforms of a short message, from simulated runs of both converters.

A message of small numbers and short strings goes through the serializer; the packet goes through
the deserializer. All streams move as soon as they can. A figure shows a few cycles, and the streams
that transfer in them.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import count
from typing import Any

from amaranth.hdl import Value

from firm_hdl.drawing.svg import Figure
from firm_hdl.export.datasheet.rows import clipped
from firm_hdl.export.top import DIRECTIONS, Direction, field_of
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.gateware.signatures import Status, leaf_streams
from firm_hdl.metrics import metrics_of
from firm_hdl.model import (
    Array,
    FieldType,
    Message,
    Primitive,
    String,
    element_of,
)
from firm_hdl.plan import Leaf, Plan
from firm_hdl.sim.bench import RunOptions
from firm_hdl.sim.harness import Harness
from firm_hdl.sim.payloads import decoder_of
from firm_hdl.sim.stalls import StallPlan
from firm_hdl.sim.values import to_transfers

__all__ = ["Wave", "sample_value", "waves_of"]

MOST_BYTES = 4096
"""Size of the longest packet that is simulated."""

MOST_LEAVES = 256

COLUMNS = 10
"""Cycles in a figure."""

MOST_FIGURES = 4
MOST_STREAMS = 24
"""Streams in a figure, besides packets and status."""

LEFT, TOP, COLUMN, ROW = 216, 20, 66, 24
_CHARACTERS, _NAME = 9, 30
"""Characters in a cycle, and in the name of a stream."""

_LAST = ", last"

Cycles = Sequence[Mapping[str, tuple[int, int, int]]]
"""Of each cycle: `valid`, `ready` and the bits of the payload of each stream, by its name."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Wave:
    """The waveforms of a converter."""

    direction: Direction
    packet: bytes
    cycles: int  # Cycles of the run.
    figures: tuple[tuple[str, Figure], ...]  # Each with the cycles that it shows.


def waves_of(
    message: Message, plan: Plan, *, stalls: StallPlan = None, columns: int = COLUMNS
) -> list[Wave]:
    """Simulate both converters.

    * `stalls`: stalls of the streams of the deserializer; see :mod:`firm_hdl.sim.harness`.
    * `columns`: cycles in a figure.

    Returns: empty if the shortest packet is long, or has many leaves.
    """
    shortest = metrics_of(message, plan.wire).min_bytes
    if shortest is None or shortest > MOST_BYTES or len(plan.leaves) > MOST_LEAVES:
        return []
    parameters: dict[str, Any] = {
        "wire": plan.wire,
        "bus_bytes": plan.bus_bytes,
        "max_message_bytes": plan.max_message_bytes,
    }
    # With empty strings and sequences if the limit has no room for others.
    items = 3 if shortest + 8 * len(plan.leaves) <= plan.max_message_bytes else 0
    transfers = to_transfers(plan, message, sample_value(message, items))
    sent = _Run(Serializer(message, **parameters), message, plan)
    [packet] = sent.harness.run_messages([transfers], sent.options).packets
    received = _Run(Deserializer(message, **parameters), message, plan)
    received.harness.run_packets([packet], replace(received.options, stalls=stalls))
    runs: dict[Direction, _Run] = {"deserializer": received, "serializer": sent}
    return [
        Wave(
            direction=way,
            packet=packet,
            cycles=len(runs[way].cycles),
            figures=tuple(_figures(way, message, plan, runs[way].cycles, columns)),
        )
        for way in DIRECTIONS
    ]


class _Run:
    """A converter on a bench, and what its streams did in each cycle."""

    def __init__(self, converter: Deserializer | Serializer, message: Message, plan: Plan):
        leaves = leaf_streams(converter.message, converter.tree)
        streams = {
            "packets": converter.packets,
            **{str(plan.leaves[number]): stream for number, stream in leaves.items()},
            "status": converter.status,
        }
        values = [
            Value.cast(each)
            for stream in streams.values()
            for each in (stream.valid, stream.ready, stream.payload)
        ]
        pair = (converter, None) if isinstance(converter, Deserializer) else (None, converter)
        self.harness = Harness(*pair, message=message, probes=values)
        self.cycles: list[dict[str, tuple[int, int, int]]] = []

        def observe(found: list[int]) -> None:
            triples = zip(found[::3], found[1::3], found[2::3], strict=True)
            self.cycles.append(dict(zip(streams, triples, strict=True)))

        self.options = RunOptions(settle=1, observe=observe)


# A short message.


def sample_value(message: Message, items: int) -> dict[str, Any]:
    """Return a message with numbers that differ.

    * `items`: characters of strings, and items of sequences of primitives; others have one element.
    """
    return _sample_message(message, items, count(1))


def _sample_message(message: Message, items: int, numbers: Iterator[int]) -> dict[str, Any]:
    return {item.name: _sample(item.type, items, numbers) for item in message.fields}


def _sample(kind: FieldType, items: int, numbers: Iterator[int]) -> Any:
    match kind:
        case Primitive(kind="bool"):
            return True
        case Primitive(kind="float"):
            return next(numbers) % 100 + 0.5
        case Primitive():
            return next(numbers) % 100
        case Message():
            return _sample_message(kind, items, numbers)
        case String(bound=bound):
            return "abcdefgh"[: items if bound is None else min(items, bound)]
    element = element_of(kind)
    if isinstance(kind, Array):
        size = kind.count
    else:
        size = items if isinstance(element, Primitive) else min(1, items)
        size = size if kind.bound is None else min(size, kind.bound)
    return [_sample(element, items, numbers) for _ in range(size)]


# Figures.


def _figures(
    way: Direction, message: Message, plan: Plan, cycles: Cycles, columns: int
) -> Iterator[tuple[str, Figure]]:
    starts = list(range(0, len(cycles), columns))
    if len(starts) > MOST_FIGURES:
        starts[MOST_FIGURES - 1 : -1] = []
    texts = {str(leaf): _text_of(message, leaf) for leaf in plan.leaves}
    end = 0
    for start in starts:
        left_out = f"; {end} to {start - 1} are left out" if start > end else ""
        end = min(start + columns, len(cycles))
        what = f"Cycles {start} to {end - 1}{left_out}"
        moving = [
            name for name in texts if any(all(cycle[name][:2]) for cycle in cycles[start:end])
        ]
        if len(moving) > MOST_STREAMS:
            what += f", and {MOST_STREAMS} of {len(moving)} fields that transfer in them"
        shown = {name: texts[name] for name in moving[:MOST_STREAMS]}
        yield what, _figure(way, plan.bus_bytes, cycles[start:end], start, shown)


def _figure(
    way: Direction,
    bus_bytes: int,
    cycles: Cycles,
    start: int,
    leaves: Mapping[str, Callable[[int], str]],
) -> Figure:
    last_at = 8 * bus_bytes + bus_bytes.bit_length()
    base = "s_axis" if way == "deserializer" else "m_axis"
    packets = [cycle["packets"] for cycle in cycles]
    packet_rows: list[_Stream | _Bits] = [
        _Stream(f"{base}_tdata", packets, _beat_text(bus_bytes)),
        _Bits(f"{base}_tvalid", [valid for valid, _, _ in packets]),
        _Bits(f"{base}_tready", [ready for _, ready, _ in packets]),
        _Bits(f"{base}_tlast", [valid & bits >> last_at for valid, _, bits in packets]),
    ]
    rows: list[_Stream | _Bits] = [
        _Stream(name, [cycle[name] for cycle in cycles], text) for name, text in leaves.items()
    ]
    rows = [*packet_rows, *rows] if way == "deserializer" else [*rows, *packet_rows]
    rows.append(_Stream("m_axis_status", [cycle["status"] for cycle in cycles], _status_text))
    label = f"Waveform of the {way} from cycle {start}"
    figure = Figure(LEFT + len(cycles) * COLUMN + 8, TOP + ROW * len(rows) + 4, label)
    for column in range(len(cycles) + 1):
        at = LEFT + column * COLUMN
        figure.line(at, TOP, at, figure.height - 4, "grid")
        if column < len(cycles):
            figure.text(at + COLUMN / 2, TOP - 6, str(start + column), "place")
    for number, row in enumerate(rows):
        row.draw(figure, TOP + number * ROW)
    return figure


@dataclass(frozen=True, slots=True)
class _Stream:
    """A stream: what it offers, and in which cycles that is taken."""

    name: str
    cycles: Sequence[tuple[int, int, int]]
    text: Callable[[int], str]

    def draw(self, figure: Figure, top: float) -> None:
        _name(figure, top, self.name)
        waiting: int | None = None
        for column, (valid, ready, bits) in enumerate(self.cycles):
            x = LEFT + column * COLUMN
            if not valid:
                figure.line(x, top + ROW / 2, x + COLUMN, top + ROW / 2, "grid")
                continue
            text = self.text(bits)
            kind = "taken" if ready else "offered"
            title = f"{self.name}: {text}, {kind}"
            figure.box(x + 1.5, top + 3, COLUMN - 3, ROW - 6, f"bytes {kind}", title)
            shown, last, _ = text.partition(_LAST)
            if ready or bits != waiting:
                if last:
                    figure.box(x + COLUMN - 5, top + 3, 3, ROW - 6, "last")
                figure.text(x + COLUMN / 2, top + 16, clipped(shown, _CHARACTERS), "code")
            waiting = None if ready else bits


@dataclass(frozen=True, slots=True)
class _Bits:
    """A signal of one bit."""

    name: str
    bits: Sequence[int]

    def draw(self, figure: Figure, top: float) -> None:
        _name(figure, top, self.name)
        places = enumerate([*self.bits, self.bits[-1]])
        levels = [(LEFT + c * COLUMN, top + (4 if bit else ROW - 4)) for c, bit in places]
        figure.path(levels, "curve c1", steps=True)


def _name(figure: Figure, top: float, name: str) -> None:
    text = name if len(name) <= _NAME else f"\N{HORIZONTAL ELLIPSIS}{name[1 - _NAME :]}"
    figure.text(LEFT - 8, top + 16, text, "code", "end")


# Payloads as text.


def _status_text(bits: int) -> str:
    return str(Status(bits).name)


def _beat_text(bus_bytes: int) -> Callable[[int], str]:
    """Return the function that names a beat by its bytes, the first one first."""
    width = bus_bytes.bit_length()

    def text(bits: int) -> str:
        data = (bits & (1 << 8 * bus_bytes) - 1).to_bytes(bus_bytes, "little")
        is_last = bits >> (8 * bus_bytes + width)
        # In other beats, `count` has no meaning.
        return (data[: bits >> 8 * bus_bytes & (1 << width) - 1] if is_last else data).hex()

    return text


def _text_of(message: Message, leaf: Leaf) -> Callable[[int], str]:
    """Return the function that names a payload of a leaf."""
    decode = decoder_of(leaf)
    field = field_of(message, leaf)
    is_text = field is not None and isinstance(field.element_type, String)
    formats = {4: "<f", 8: "<d"}

    def number(bits: int) -> str:
        if leaf.kind in ("scalar", "items") and leaf.primitive.kind == "float":
            size = leaf.item_bytes
            data = (bits & (1 << 8 * size) - 1).to_bytes(size, "little")
            return f"{struct.unpack(formats[size], data)[0]:g}"
        return str(bits)

    def text(bits: int) -> str:
        payload = decode(bits)
        if isinstance(payload, int):
            return number(payload)
        items, last = payload
        # The numbers of the message are not 0, so that zeros at the end are free lanes.
        used = max((place + 1 for place, item in enumerate(items) if item), default=0)
        numbers = items[:used]
        what = "".join(map(chr, numbers)) if is_text else " ".join(map(number, numbers))
        return what + _LAST if last else what

    return text
