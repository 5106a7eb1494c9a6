"""The datagrams of a node as templates: bytes with places for what is not known before it runs.

:mod:`firm_hdl.rtps` writes each datagram twice, with other values of the fields. The bytes that
differ are those of fields, and their values tell which ones. So no layout is written down here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple

from amaranth.lib import data

from firm_hdl.node.description import Description, Link
from firm_hdl.node.rtps.endpoints import own_of
from firm_hdl.rtps.wire import message
from firm_hdl.rtps.wire.guid import (
    PUBLICATIONS_READER,
    PUBLICATIONS_WRITER,
    SPDP_READER,
    SPDP_WRITER,
    SUBSCRIPTIONS_READER,
    SUBSCRIPTIONS_WRITER,
    Guid,
    SampleIdentity,
)
from firm_hdl.rtps.wire.octets import padded
from firm_hdl.rtps.wire.parameters import ParameterList, identity
from firm_hdl.rtps.wire.submessages import (
    AckNack,
    Data,
    DataFrag,
    Gap,
    Heartbeat,
    InfoDestination,
    NackFrag,
    NumberSet,
    Submessage,
    encode,
)

__all__ = [
    "FIELDS",
    "HEAD_BYTES",
    "PAYLOAD",
    "Job",
    "Template",
    "Templates",
    "Word",
    "fields_layout",
    "fragment_bytes",
    "op_layout",
    "templates_of",
]

FIELDS = {
    "own": 12,
    "peer": 12,
    "reader": 4,
    "writer": 4,
    "number": 4,
    "first": 4,
    "last": 4,
    "count": 4,
    "bits": 4,
    "bitmap": 4,
    "size": 4,
    "flags": 4,
    "related": 16,
    "related_number": 4,
}
"""The fields of templates, and their bytes.

`own` and `peer` are GUID prefixes, `reader` and `writer` entity identifiers, and `related` is a
GUID, in the order of the wire. All others are little-endian. Numbers are the lower half of sequence
numbers, whose upper half is 0. `size` has in its upper half the length of the submessage DATA or
DATA_FRAG, `flags` in its second byte those of HEARTBEAT and ACKNACK: so they are in the places that
they have in a submessage's header, and the other bits have to be 0. A DATA_FRAG has its number in
`first` and the size of the sample in `last`; a NACK_FRAG has in `first` the base of its set.
"""


class Job(IntEnum):
    """The first templates. Those of announced endpoints follow: writers, readers, the graph."""

    ANNOUNCE = 0
    HEARTBEAT = 1
    GAP = 2
    ACKNACK = 3
    ACKNACK_MISSING = 4
    SAMPLE = 5
    REPLY = 6
    FRAGMENT = 7
    REPLY_FRAGMENT = 8
    NACK_FRAG = 9


PAYLOAD = 31
"""The number of a word of the fields that stands for the payload."""


class Word(NamedTuple):
    """4 bytes of a datagram, or its payload."""

    value: int  # The bytes that are constant, the first one lowest; others are 0.
    field: int = 0  # From 1 on: the word of the fields that has all others.


@dataclass(frozen=True, slots=True)
class Template:
    """A datagram."""

    words: tuple[Word, ...]

    @property
    def size(self) -> int:
        """Bytes, without those of a payload."""
        return 4 * sum(each.field != PAYLOAD for each in self.words)


@dataclass(frozen=True, slots=True, kw_only=True)
class Templates:
    """All datagrams of a node."""

    every: tuple[Template, ...]  # By number: those of `Job`, then those of endpoints.
    # Numbers of the first announced writer, of the first announced reader, and of the graph.
    writers: int
    readers: int
    graph: int

    @property
    def rom(self) -> list[dict[str, int]]:
        """The words of all templates, as `op_layout` has them."""
        return [
            {**word._asdict(), "last": number == len(each.words)}
            for each in self.every
            for number, word in enumerate(each.words, 1)
        ]

    @property
    def starts(self) -> list[int]:
        """The place in the ROM of each template."""
        lengths = [len(each.words) for each in self.every]
        return [sum(lengths[:number]) for number in range(len(lengths))]


def fragment_bytes(link: Link) -> int:
    """Return the size of fragments that fit into a datagram: a power of two."""
    room = link.datagram_bytes - _SIZE_AT - 2 - HEAD_BYTES[Job.REPLY_FRAGMENT]
    return 1 << max(_LEAST_FRAGMENT_BITS, room.bit_length() - 1)


def fields_layout() -> data.StructLayout:
    """Return the fields, the first byte on the wire in the lowest bits."""
    return data.StructLayout({name: 8 * size for name, size in FIELDS.items()})


def op_layout() -> data.StructLayout:
    """Return a word of the ROM: a :class:`Word`, and whether it is the last one of its template."""
    return data.StructLayout({"value": 32, "field": 5, "last": 1})


HEAD_BYTES = {Job.SAMPLE: 20, Job.REPLY: 80, Job.FRAGMENT: 32, Job.REPLY_FRAGMENT: 92}
"""Bytes of a submessage before its payload: 20 of DATA, 32 of DATA_FRAG (9.4.5.4, 9.4.5.5). A reply
has inline QoS: two parameters of 28 bytes each, and the sentinel."""

_SIZE_AT = 20 + 16 + 2
"""Place of the length of a DATA behind the header and INFO_DST."""

_LEAST_FRAGMENT_BITS = 6

_HALF = 0x80
"""What is added to the number of a byte in the second writing."""


class _Values:
    """Values of all fields: their bytes are the numbers of bytes, plus `offset`."""

    def __init__(self, offset: int) -> None:
        self.offset = offset
        self.of: dict[str, bytes] = {}
        at = 0
        for name, size in FIELDS.items():
            self.of[name] = bytes(range(offset + at, offset + at + size))
            at += size

    def __getattr__(self, name: str) -> int:
        """Return a field as the number that is written with the lowest byte first."""
        return int.from_bytes(self.of[name], "little")

    @property
    def reader(self) -> int:
        return int.from_bytes(self.of["reader"], "big")

    @property
    def writer(self) -> int:
        return int.from_bytes(self.of["writer"], "big")

    def to_peer(self, *submessages: Submessage) -> bytes:
        """Return a datagram for one participant."""
        return message.write(self.of["own"], (InfoDestination(self.of["peer"]), *submessages))


@dataclass(frozen=True, slots=True)
class _Bits(NumberSet):
    """A set whose count of bits, and whose 32 bits, are fields."""

    written: bytes = b""

    def bitmap(self, order: str) -> bytes:
        return self.written


def templates_of(description: Description) -> Templates:
    """Write all datagrams of a node."""
    own = own_of(description, bytes(12))
    every: list[Template] = [_template(description, job) for job in _JOBS]
    writers, readers = len(own.writers), len(own.readers)
    for is_writer, count in ((True, writers), (False, readers)):
        every += [_template(description, _endpoint(is_writer, each)) for each in range(count)]
    every.append(_template(description, _graph))
    first = len(Job)
    return Templates(
        every=tuple(every),
        writers=first,
        readers=first + writers,
        graph=first + writers + readers,
    )


_Parts = tuple[bytes, ...]
_Make = Callable[[Description, _Values], _Parts]
"""Writes a datagram in one part, or in two with the payload between them."""


def _template(description: Description, make: _Make) -> Template:
    first, second = (make(description, _Values(offset)) for offset in (0, _HALF))
    words = [Word(0, PAYLOAD)]
    for one, other in zip(first, second, strict=True):
        places = range(0, len(one), 4)
        words += [_word(one[at : at + 4], other[at : at + 4]) for at in places]
        words.append(Word(0, PAYLOAD))
    return Template(tuple(words[1:-1]))


def _word(one: bytes, other: bytes) -> Word:
    value, fields = bytearray(4), set()
    for place, (a, b) in enumerate(zip(one, other, strict=True)):
        if a == b:
            value[place] = a
        else:
            assert b - a == _HALF and a % 4 == place, "a field is not written word by word"
            fields.add(1 + a // 4)
    assert len(one) == 4 and len(fields) <= 1, "a word has two fields"
    return Word(int.from_bytes(value, "little"), *fields)


def _announce(description: Description, values: _Values) -> _Parts:
    payload = own_of(description, values.of["own"]).participant.encode()
    sample = Data(reader=SPDP_READER, writer=SPDP_WRITER, sequence_number=1, payload=payload)
    return (message.write(values.of["own"], (sample,)),)


def _endpoint(is_writer: bool, number: int) -> _Make:
    def make(description: Description, values: _Values) -> _Parts:
        own = own_of(description, values.of["own"])
        sample = Data(
            reader=PUBLICATIONS_READER if is_writer else SUBSCRIPTIONS_READER,
            writer=PUBLICATIONS_WRITER if is_writer else SUBSCRIPTIONS_WRITER,
            sequence_number=1 + number,
            payload=(own.writers if is_writer else own.readers)[number].data.encode(),
        )
        return (values.to_peer(sample),)

    return make


def _graph(description: Description, values: _Values) -> _Parts:
    own = own_of(description, values.of["own"])
    writer = own.writers[0].data.guid.entity
    sample = Data(reader=values.reader, writer=writer, sequence_number=1, payload=padded(own.graph))
    return (values.to_peer(sample),)


def _heartbeat(description: Description, values: _Values) -> _Parts:
    datagram = bytearray(values.to_peer(_heartbeat_of(values, values.first, values.last)))
    datagram[_SIZE_AT - 1] = values.of["flags"][1]
    return (bytes(datagram),)


def _heartbeat_of(values: _Values, first: int, last: int) -> Heartbeat:
    return Heartbeat(
        reader=values.reader, writer=values.writer, first=first, last=last, count=values.count
    )


def _gap(description: Description, values: _Values) -> _Parts:
    gap = Gap(
        reader=values.reader,
        writer=values.writer,
        start=values.first,
        numbers=NumberSet(values.last),
    )
    return (values.to_peer(gap),)


def _acknack(is_missing: bool) -> _Make:
    def make(description: Description, values: _Values) -> _Parts:
        numbers = NumberSet(values.number)
        if is_missing:
            numbers = _Bits(values.number, written=values.of["bits"] + values.of["bitmap"])
        answer = AckNack(
            reader=values.reader,
            writer=values.writer,
            missing=numbers,
            count=values.count,
            final=is_missing,
        )
        datagram = bytearray(values.to_peer(answer))
        datagram[_SIZE_AT - 1] = values.of["flags"][1]
        return (bytes(datagram),)

    return make


def _nack_frag(description: Description, values: _Values) -> _Parts:
    """Acknowledge what is below a sample, and ask for fragments of it."""
    ends = {"reader": values.reader, "writer": values.writer, "count": values.count}
    acknowledged = AckNack(missing=NumberSet(values.number), final=True, **ends)
    missing = _Bits(values.first, written=values.of["bits"] + values.of["bitmap"])
    answer = NackFrag(sequence_number=values.number, missing=missing, **ends)
    return (values.to_peer(acknowledged, answer),)


def _sample(*, is_reply: bool, is_fragment: bool) -> _Make:
    """Write a sample with a heartbeat, or a fragment without."""

    def make(description: Description, values: _Values) -> _Parts:
        inline = ParameterList(())
        if is_reply:
            related = SampleIdentity(Guid.parse(values.of["related"]), values.related_number)
            inline = ParameterList(tuple(identity(related)))
        sample: Submessage = Data(
            reader=values.reader,
            writer=values.writer,
            sequence_number=values.number,
            payload=b"",
            inline=inline,
        )
        if is_fragment:
            sample = DataFrag(
                reader=values.reader,
                writer=values.writer,
                sequence_number=values.number,
                first=values.first,
                count=1,
                fragment_bytes=fragment_bytes(description.link),
                sample_bytes=values.last,
                payload=b"",
                inline=inline,
            )
        head = bytearray(values.to_peer(sample))
        head[_SIZE_AT : _SIZE_AT + 2] = values.of["size"][2:]
        heartbeat = encode(_heartbeat_of(values, values.first, values.last))
        return bytes(head), b"" if is_fragment else heartbeat

    return make


_JOBS: tuple[_Make, ...] = (
    _announce,
    _heartbeat,
    _gap,
    _acknack(is_missing=False),
    _acknack(is_missing=True),
    _sample(is_reply=False, is_fragment=False),
    _sample(is_reply=True, is_fragment=False),
    _sample(is_reply=False, is_fragment=True),
    _sample(is_reply=True, is_fragment=True),
    _nack_frag,
)
"""How the templates of `Job` are written, in their order."""
