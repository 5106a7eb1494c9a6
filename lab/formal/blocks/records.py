"""Claims about record views: a reader that joins leaves, and a writer that splits a record.

The message has two scalars, and an array whose items come in two transfers, the second one with a
lane that is not used. Which bit of the record belongs to which transfer is written down here.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from amaranth.hdl import Array, Cat, Const, Signal, Value
from amaranth.lib import data

from firm_hdl.gateware.record import RecordReader, RecordWriter
from firm_hdl.model import PRIMITIVES, Field, Message
from firm_hdl.model import Array as ArrayType
from lab.formal.bugs import Bug
from lab.formal.catalog import Claim, Study
from lab.formal.scene import Scene
from lab.formal.streams import fires, rules, sink, source

__all__ = ["studies"]

_TYPES = PRIMITIVES["ros1"]
_FIELDS = (
    Field(name="a", type=_TYPES["uint8"]),
    Field(name="b", type=ArrayType(element=_TYPES["uint8"], count=3)),
    Field(name="c", type=_TYPES["uint16"]),
)
_MESSAGE = Message(name="formal/Small", dialect="ros1", fields=_FIELDS)
BUS_BYTES = 2


@dataclass(frozen=True, slots=True, kw_only=True)
class _Leaf:
    """A leaf of the message.

    Attributes
    ----------
    path : tuple of str
        Of the stream.
    bit : int
        The first bit of the record that the leaf fills.
    transfers : tuple of int
        Bits that each transfer fills, from its lowest bit on.
    """

    path: tuple[str, ...]
    bit: int
    transfers: tuple[int, ...]


_LEAVES = (
    _Leaf(path=("a",), bit=0, transfers=(8,)),
    _Leaf(path=("b", "items"), bit=8, transfers=(16, 8)),
    _Leaf(path=("c",), bit=32, transfers=(16,)),
)


def _stream(block: Any, leaf: _Leaf) -> Any:
    port = block.message
    for name in leaf.path:
        port = getattr(port, name)
    return port


def _values(port: Any) -> Value:
    """Return the values of a transfer, without `last`."""
    payload = port.payload
    return Value.cast(payload.data if isinstance(payload, data.View) else payload)


def _counter(scene: Scene, name: str, moves: Value, taken: Value) -> Signal:
    """Count the transfers of a leaf since the record before was taken."""
    moved = Signal(3, name=f"{name}_moved")
    scene.m.d.sync += moved.eq(moved + moves)
    with scene.m.If(taken):
        scene.m.d.sync += moved.eq(0)
    return moved


def _reader(scene: Scene) -> None:
    """Join the leaves of a message that any sources offer."""
    m = scene.m
    m.submodules.block = block = RecordReader(_MESSAGE, bus_bytes=BUS_BYTES)
    record = block.record
    vector = Value.cast(record.payload)
    ready, all_came = sink(scene, record, "record"), Value.cast(1)
    for leaf in _LEAVES:
        name, port, count = leaf.path[0], _stream(block, leaf), len(leaf.transfers)
        source(scene, port, name)
        moves = fires(port)
        moved = _counter(scene, name, moves, fires(record))
        if count == 1:
            came = port.valid
            kept = _values(port)
            scene.claim("one each", moves == fires(record))
        else:
            came = moved == count
            kept = _collected(scene, name, port, moved, leaf)
            scene.claim("one each", ~moves | (moved < count))
            scene.claim("input moves", ~(port.valid & (moved < count)) | port.ready)
        all_came = all_came & came
        bits = vector[leaf.bit : leaf.bit + sum(leaf.transfers)]
        scene.claim("order", ~record.valid | (bits == kept))
    rules(scene, record, "record")
    scene.claim("output moves", record.valid == all_came)
    scene.claim("input moves", ~(all_came & ready) | fires(record))


def _collected(scene: Scene, name: str, port: Any, moved: Signal, leaf: _Leaf) -> Value:
    """Keep what each transfer brought."""
    parts = []
    for number, bits in enumerate(leaf.transfers):
        part = Signal(bits, name=f"{name}_{number}")
        with scene.m.If(fires(port) & (moved == number)):
            scene.m.d.sync += part.eq(_values(port))
        parts.append(part)
    return Cat(parts)


def _writer(scene: Scene) -> None:
    """Split any records into the leaves of a message."""
    m = scene.m
    m.submodules.block = block = RecordWriter(_MESSAGE, bus_bytes=BUS_BYTES)
    record = block.record
    vector = Value.cast(record.payload)
    source(scene, record, "record")
    done = Value.cast(1)
    for leaf in _LEAVES:
        name, port, count = leaf.path[0], _stream(block, leaf), len(leaf.transfers)
        sink(scene, port, name)
        rules(scene, port, name)
        moved = _counter(scene, name, fires(port), fires(record))
        scene.claim("one each", ~port.valid | (record.valid & (moved < count)))
        scene.claim("output moves", port.valid == (record.valid & (moved < count)))
        first, places = leaf.bit, []
        for bits in leaf.transfers:
            places.append(Cat(vector[first : first + bits], Const(0, 16 - bits)))
            first += bits
        used = Array((1 << bits) - 1 for bits in leaf.transfers)[moved]
        given = (_values(port) & used) == Array(places)[moved]
        scene.claim("order", ~port.valid | given)
        if count > 1:
            scene.claim("order", ~port.valid | (port.payload.last == (moved == count - 1)))
        done = done & (moved + fires(port) == count)
    scene.claim("input moves", fires(record) == (record.valid & done))


_READ, _COLLECT = RecordReader.elaborate, RecordReader._collect
_WRITE, _OFFER = RecordWriter.elaborate, RecordWriter._offer


def _reader_claims() -> tuple[Claim, ...]:
    shifts = "with m.If(leaf.valid & ~full):"
    return (
        Claim("valid stays", Bug(_COLLECT, "with m.If(taken):", "with m.If(full):")),
        Claim("payload stays", Bug(_COLLECT, shifts, "with m.If(leaf.valid):")),
        Claim("order", Bug(_COLLECT, "Cat(kept[width:], incoming)", "Cat(incoming, kept[width:])")),
        Claim("one each", Bug(_READ, "leaf.ready.eq(taken)", "leaf.ready.eq(1)")),
        Claim("output moves", Bug(_READ, "Cat(present).all()", "Cat(present[1:]).all()")),
        Claim("input moves", Bug(_COLLECT, "leaf.ready.eq(~full)", "leaf.ready.eq(taken)")),
    )


def _writer_claims() -> tuple[Claim, ...]:
    skips = Bug(_WRITE, "with m.Elif(sent):", "with m.Elif(leaf.valid):")
    turned = Bug(_OFFER, "with m.Case(number):", "with m.Case(len(transfers) - 1 - number):")
    return (
        Claim("valid stays", skips),
        Claim("payload stays", skips),
        Claim("order", turned),
        Claim("one each", Bug(_WRITE, "(self.record.valid & ~over)", "(self.record.valid)")),
        Claim("output moves", Bug(_WRITE, "& ~over)", "& ~over & (index != 1))")),
        Claim("input moves", Bug(_WRITE, "Cat(done).all()", "Cat(done[1:]).all()")),
    )


def studies() -> list[Study]:
    """Return the studies of record views."""
    message = "uint8, uint8[3], uint16, 2 bytes"
    return [
        Study("record-reader", f"`RecordReader` of {message}", _reader, _reader_claims()),
        Study("record-writer", f"`RecordWriter` of {message}", _writer, _writer_claims()),
    ]
