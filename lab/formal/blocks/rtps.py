"""Claims about the receiver of RTPS: the walk over a datagram, lists of parameters.

Datagrams have any bytes, and any size.
"""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Array, Cat, Mux, Signal, Value

from firm_hdl.node.description import Link
from firm_hdl.node.rtps.events import EventKind
from firm_hdl.node.rtps.messages import _LEAST, WORD_BYTES, MessageReader
from firm_hdl.node.rtps.parameters import ParameterReader
from firm_hdl.rtps.wire.submessages import (
    AckNack,
    Data,
    DataFrag,
    Gap,
    Heartbeat,
    InfoSource,
    InfoTimestamp,
    NackFrag,
)
from lab.formal.bugs import Bug
from lab.formal.catalog import Claim, Study
from lab.formal.scene import Scene
from lab.formal.streams import fires, progress, rules, sink

__all__ = ["studies"]

_HEADER_WORDS, _PAD = 5, 1


class _Walk:
    """Where a datagram stands, by the lengths in it alone (9.4.5.1), a word at a time.

    Attributes
    ----------
    togo : Value
        Bytes of the datagram that did not leave yet, with their word.
    begun : Signal
        A word of it left.
    kind, left : Signal
        The submessage, and bytes that it has yet.
    head : Signal
        Words that left of the header.
    """

    def __init__(self, scene: Scene, block: MessageReader):
        m, packets = scene.m, block.packets
        word = scene.free(32, "word")
        size, begun = Signal(16, name="size", reset_less=True), Signal(name="begun")
        kept, last, held = Signal(16, name="kept"), Signal(name="last"), Signal(name="held")
        self.togo, self.begun = Mux(begun, kept, size), begun
        m.d.comb += [
            last.eq(self.togo <= WORD_BYTES),
            block.size.eq(size),
            packets.valid.eq(held | scene.free(1, "offers")),
            Value.cast(packets.payload.data).eq(word),
            packets.payload.count.eq(Mux(last, self.togo, WORD_BYTES)),
            packets.payload.last.eq(last),
        ]
        m.d.sync += held.eq(packets.valid & ~packets.ready)
        self.kind, self.left = Signal(8, name="walk_kind"), Signal(16, name="walk_left")
        self.head = Signal(3, name="walk_head")
        kind, bounds = word[:8], (word[16:24], word[24:])
        length = Mux(word[8], Cat(bounds), Cat(reversed(bounds)))
        to_end = (length == 0) & (kind != _PAD) & (kind != InfoTimestamp.KIND)
        rest = Mux(last, 0, self.togo - WORD_BYTES)
        with m.If(fires(packets)):
            m.d.sync += [begun.eq(~last), kept.eq(rest)]
            with m.If(last):
                m.d.sync += size.eq(scene.free(16, "next_size"))
            with m.If(~begun):
                m.d.sync += [self.head.eq(1), self.left.eq(0), self.kind.eq(0)]
            with m.Elif(self.head != _HEADER_WORDS):
                m.d.sync += self.head.eq(self.head + 1)
            with m.Elif(self.left != 0):
                m.d.sync += self.left.eq(Mux(self.left < WORD_BYTES, 0, self.left - WORD_BYTES))
            with m.Else():
                m.d.sync += [self.kind.eq(kind), self.left.eq(Mux(to_end, rest, length))]


def _in_step(inner: dict[str, Any], walk: _Walk) -> Value:
    """Return what always holds of the reader's state: with it, each claim follows from a cycle."""
    reader, parser = inner["MessageReader"], inner["ParameterReader"]
    state, rest, left, kind = reader.is_in, reader.rest, reader.left, reader.kind
    event, place, at = reader.event, reader.place, Cat(0, 0, reader.index)

    def has(bytes_in_all: Any, left: Value = left, at: Value = at) -> Value:
        """Of what is being read, `at` bytes were taken; there are enough for the others."""
        return (at < bytes_in_all) & (left + at >= bytes_in_all)

    # Up to the size of a set.
    fixed = _LEAST | {AckNack.KIND: 20, NackFrag.KIND: 24}
    fields = Mux(kind[5:] == 0, Array(fixed.get(number, 0) for number in range(32))[kind[:5]], 0)
    is_header = state("EVENT") & (event.kind == EventKind.SOURCE) & (kind != InfoSource.KIND)
    outside = state("START", "HEADER", "SUBMESSAGE", "DROP") | is_header
    body = ~outside & ~state("LENGTH", "CHECK")
    is_sample = (event.kind == EventKind.SAMPLE) & ~event.is_gone & ~reader.is_part
    in_list = parser.is_in("CHECK", "VALUE") | (parser.place != 0)
    new = (walk.left == 0) & (walk.kind == 0) & (kind == 0)
    is_data, is_fragment = kind == Data.KIND, kind == DataFrag.KIND
    is_set = (kind == Gap.KIND) | (kind == AckNack.KIND) | (kind == NackFrag.KIND)
    in_data = state("DATA", "BEFORE_INLINE", "CONTENT", "PARAMETERS", "LISTED")
    in_announcement = state("PARAMETERS", "LISTED") & reader.in_payload
    is_over = ~walk.begun & (place == 0)
    return Cat(
        state(),
        parser.is_in(),
        # In DROP, words leave whole.
        ~state("START") | is_over,
        state("START") | (rest != 0) | is_over,
        state("START") | (rest == 0) | (state("DROP") & walk.begun) | (rest + place == walk.togo),
        state("START", "HEADER", "DROP") | (walk.head == _HEADER_WORDS),
        state("START", "HEADER", "DROP") | walk.begun | (rest == 0),
        ~state("HEADER") | (has(20, rest) & (walk.begun == (at != 0)) & (kind == 0)),
        ~state("HEADER") | (at == 0) | ((walk.head == reader.index) & new),
        ~state("HEADER", "LENGTH", "CHECK", "FIELDS", "SET", "HEARTBEAT", "DATA") | (place == 0),
        ~state("PAYLOAD") | (place == 0),
        ~is_header | (new & (place == 0)),
        ~state("SUBMESSAGE") | (walk.left == place),
        ~state("CHECK") | (reader.index == 0),
        ~state("LENGTH") | (reader.index == 0),
        ~state("LENGTH") | (walk.left == Mux(reader.to_end, rest, reader.length)),
        ~(body | state("CHECK")) | (walk.left == left + place),
        ~(body | state("LENGTH", "CHECK")) | (walk.kind == kind),
        ~body | (left <= rest),
        ~state("FIELDS") | has(fields),
        ~state("SET") | is_set,
        ~state("HEARTBEAT") | (kind == Heartbeat.KIND),
        ~in_data | is_data | is_fragment,
        ~state("CHECK", "FIELDS", "DATA", "BEFORE_INLINE") | ~reader.in_payload,
        ~(state("ENCAPSULATION") | in_announcement) | is_data,
        ~state("FRAGMENTS") | is_fragment,
        ~state("PAYLOAD") | (left != 0),
        ~(state("EVENT") & is_sample) | ((left != 0) & (place == 0)),
        ~in_list | state("PARAMETERS"),
        parser.is_in("HEAD", "VALUE") | (parser.place == 0),
        ~parser.is_in("HEAD") | (parser.place == 0) | has(4, left, parser.place),
        ~parser.is_in("VALUE") | ((parser.size != 0) & (parser.size <= left)),
    ).all()


def _reader(scene: Scene) -> None:
    """Read any datagrams, and answer events in any way."""
    m, block = scene.m, MessageReader(Link(kind="rtps", address="10.0.0.50"))
    inner = scene.inside(block)
    walk = _Walk(scene, block)
    packets, events, payload = block.packets, block.events, block.payload
    fragments, reader = block.fragments, inner["MessageReader"]
    state = reader.is_in
    m.d.comb += [
        block.own.eq(scene.rigid(96, "own")),
        block.knows.eq(scene.free(1, "knows")),
        block.wants.eq(scene.free(1, "wants")),
        block.drained.eq(scene.free(1, "drained")),
        fragments.wants.eq(scene.free(1, "fragments_wanted")),
        fragments.is_whole.eq(scene.free(1, "is_whole")),
    ]
    sink(scene, events, "events")
    sink(scene, payload, "payload")
    rules(scene, events, "events")
    in_step = _in_step(inner, walk)
    # What an event is about is the submessage that the lengths lead to.
    of_data = ("PARTICIPANT", "PARTICIPANT_GONE", "ENDPOINT", "ENDPOINT_GONE")
    kinds = {
        **{getattr(EventKind, name): (Data.KIND,) for name in of_data},
        EventKind.SAMPLE: (Data.KIND, DataFrag.KIND),
        EventKind.FRAGMENT: (DataFrag.KIND,),
        EventKind.HEARTBEAT: (Heartbeat.KIND,),
        EventKind.ACKNACK: (AckNack.KIND,),
        EventKind.GAP: (Gap.KIND,),
        EventKind.NACK_FRAG: (NackFrag.KIND,),
        EventKind.SOURCE: (0, InfoSource.KIND),
    }
    for event, numbers in kinds.items():
        allowed = Cat(walk.kind == kind for kind in numbers).any()
        is_event = events.valid & (events.payload.kind == event)
        in_step = in_step & (~is_event | allowed)
    scene.claim("inside", in_step)
    # A word is not read beyond its end, nor a submessage beyond its own.
    taken_to = reader.place + reader.step
    scene.claim("inside", ~reader.takes | (taken_to <= packets.payload.count))
    inside = (reader.step <= reader.left) & (walk.left <= walk.togo)
    is_body = fires(payload) | fragments.takes | (reader.takes & state("PARAMETERS", "FIELDS"))
    scene.claim("inside", ~is_body | inside)
    scene.claim("inside", ~fires(payload) | (payload.payload.last == (walk.left <= WORD_BYTES)))


def _list(scene: Scene) -> None:
    """Read any list of parameters, in a submessage of any length."""
    m, block = scene.m, ParameterReader()
    parser = scene.inside(block)["ParameterReader"]
    left, ready = Signal(16, name="left", reset_less=True), scene.free(1, "offers")
    is_over = block.ended | block.failed
    begins = is_over & scene.free(1, "begins")
    m.d.comb += [
        block.begins.eq(begins),
        block.byte.eq(scene.free(8, "byte")),
        block.takes.eq(block.wants & ready),
        block.is_little.eq(scene.rigid(1, "little")),
        block.left.eq(left),
    ]
    m.d.sync += left.eq(Mux(begins, scene.free(16, "length"), left - block.takes))
    scene.claim("inside", ~block.wants | (left != 0))
    scene.claim("inside", ~parser.is_in("VALUE") | ((parser.size != 0) & (parser.size <= left)))
    is_begun = parser.is_in("HEAD") & (parser.place != 0)
    scene.claim("inside", ~is_begun | (left + parser.place >= 4))
    scene.claim("inside", parser.is_in("HEAD", "VALUE") | (parser.place == 0))
    waited = progress(scene, "input moves", ~block.wants & ~is_over, 2)
    scene.claim("input moves", parser.is_in())
    scene.claim("input moves", (waited == 0) | ~parser.is_in("CHECK"))
    scene.claim("input moves", (waited <= 1) | ~parser.is_in("HEAD", "VALUE"))


_READER, _LIST = MessageReader.elaborate, ParameterReader.elaborate


_INDUCTIVE = ("inside", "input moves")


def _claims(bugs: dict[str, Bug]) -> tuple[Claim, ...]:
    return tuple(
        Claim(name, bug, "induction" if name in _INDUCTIVE else "PDR", found_within=80)
        for name, bug in bugs.items()
    )


def studies() -> list[Study]:
    """Return the studies of the receiver of RTPS."""
    reader = {
        "valid stays": Bug(_READER, "m.If(self.events.ready)", "m.If(1)"),
        "payload stays": Bug(
            _READER,
            "m.d.comb += self.events.valid.eq(1)",
            "m.d.comb += self.events.valid.eq(1); m.d.sync += event.last.eq(event.number)",
        ),
        "inside": Bug(_READER, "skip > left", "skip > rest"),
    }
    parameters = {
        "inside": Bug(_LIST, "size > self.left", "size > self.left + 1"),
        "input moves": Bug(_LIST, 'm.next = "VALUE"', 'm.next = "CHECK"'),
    }
    return [
        Study("rtps-list", "`ParameterReader`", _list, _claims(parameters)),
        Study("rtps-reader", "`MessageReader`, datagrams of any size", _reader, _claims(reader)),
    ]
