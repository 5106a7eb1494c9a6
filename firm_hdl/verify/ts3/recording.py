"""The messages of recordings: their types, and a selection of messages that are spread evenly.

Files are read twice. The first pass keeps only the sizes of all messages, however long the
recording is. The messages are selected by these sizes. The second pass reads the bytes of the
selected messages.
"""

from __future__ import annotations

from array import array
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TypeAlias

from rosbags.interfaces import Connection

from firm_hdl.errors import DefinitionError, Diagnostic
from firm_hdl.frontend import open_library
from firm_hdl.frontend.recordings import Reader, use_recording
from firm_hdl.model import WIRE_OF
from firm_hdl.verify.systems.tasks import TypeUnderTest, UnknownTypeError
from firm_hdl.wire import Wire, too_large

__all__ = ["RecordedMessage", "Selection", "Topic", "collect_recorded", "select", "topics_of"]

_Place: TypeAlias = "tuple[str, str, int]"
"""Recording, topic, and number of the message in the topic."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Topic:
    """A topic of a recording. A topic with several types or digests counts several times.

    Attributes
    ----------
    bag : str
    name : str
    type : str
        ``package/msg/Type``, the name that rosbags uses for ROS 1 and ROS 2.
    digest : str
        The recorded md5 sum or type hash; empty if there is none.
    """

    bag: str
    name: str
    type: str
    digest: str


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordedMessage:
    """A message as it was recorded.

    Attributes
    ----------
    bag : str
    topic : str
    number : int
        The index of the message in its topic, from 0, in the order of times.
    nanoseconds : int
        The time of the recording.
    data : bytes
    """

    bag: str
    topic: str
    number: int
    nanoseconds: int
    data: bytes

    def __str__(self) -> str:
        seconds, rest = divmod(self.nanoseconds, 10**9)
        return f"{self.topic} message {self.number} at {seconds}.{rest:09}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Selection:
    """Messages of a type that were selected.

    Attributes
    ----------
    messages : tuple of RecordedMessage
        Selected messages, recording by recording, in the order of their times.
    total : int
        The number of all messages of the type.
    topics : int
        The number of topics with these messages.
    too_long : tuple of int
        Sizes in bytes of the messages that are too long.
    sparse : bool
        Whether fewer messages than asked for were selected, because of their total size.
    """

    messages: tuple[RecordedMessage, ...]
    total: int
    topics: int
    too_long: tuple[int, ...]
    sparse: bool


def topics_of(bag: str) -> list[Topic]:
    """List the topics of a recording.

    Raises
    ------
    DefinitionError
        If the recording cannot be read.
    """
    found = use_recording(bag, lambda reader: [_topic(bag, each) for each in reader.connections])
    return list(dict.fromkeys(found))


def select(
    topics: Sequence[Topic], *, most: int, longest: int, most_bytes: int | None = None
) -> Selection:
    """Select messages that are spread evenly over each topic, and if possible over the topics.

    Parameters
    ----------
    topics : sequence of Topic
        Topics, all of the same type.
    most : int
        The maximum number of messages.
    longest : int
        The maximum size of a message in bytes.
    most_bytes : int or None
        The maximum size of all messages together. The shortest message is selected in any case.

    Raises
    ------
    DefinitionError
        If a recording cannot be read to its end.
    """
    sizes: dict[tuple[str, str], Sequence[int]] = {}
    for bag in dict.fromkeys(topic.bag for topic in topics):
        found = use_recording(bag, partial(_sizes, bag=bag, topics=topics))
        sizes.update(((bag, name), each) for name, each in found.items())
    places, sparse = _choose(sizes, most, longest, most_bytes)
    return Selection(
        messages=tuple(_fetch(places, topics)),
        total=sum(map(len, sizes.values())),
        topics=len(sizes),
        too_long=tuple(size for each in sizes.values() for size in each if size > longest),
        sparse=sparse,
    )


def _topic(bag: str, connection: Connection) -> Topic:
    # DDS tools write names with ``::``. Whether the definition can be read is checked elsewhere.
    name = connection.msgtype.replace("::", "/")
    return Topic(bag=bag, name=connection.topic, type=name, digest=connection.digest or "")


def _messages(
    reader: Reader, bag: str, topics: Sequence[Topic]
) -> Iterator[tuple[str, int, int, bytes]]:
    """Yield topic, number, time and bytes of each message of some topics."""
    connections = [each for each in reader.connections if _topic(bag, each) in topics]
    # rosbags takes an empty list for all connections.
    if not connections:
        return
    numbers: Counter[str] = Counter()
    for connection, nanoseconds, data in reader.messages(connections=connections):
        yield connection.topic, numbers[connection.topic], nanoseconds, bytes(data)
        numbers[connection.topic] += 1


def _sizes(reader: Reader, bag: str, topics: Sequence[Topic]) -> dict[str, Sequence[int]]:
    found: dict[str, array[int]] = {}
    for topic, _, _, data in _messages(reader, bag, topics):
        found.setdefault(topic, array("Q")).append(len(data))
    return dict(found)


def _choose(
    sizes: Mapping[tuple[str, str], Sequence[int]], most: int, longest: int, most_bytes: int | None
) -> tuple[list[_Place], bool]:
    """Return the places of the selected messages, and whether `most_bytes` limited their number."""
    short = {
        topic: [number for number, size in enumerate(each) if size <= longest]
        for topic, each in sizes.items()
    }
    short = {topic: numbers for topic, numbers in short.items() if numbers}
    wanted = most = min(most, sum(map(len, short.values())))
    while most:
        chosen = [
            (*topic, number)
            for topic, share in _shares(short, most).items()
            for number in _spread(short[topic], share)
        ]
        size = sum(sizes[bag, name][number] for bag, name, number in chosen)
        if most_bytes is None or size <= most_bytes:
            return chosen, most < wanted
        most = min(most - 1, most * most_bytes // size)
    everything = [(*topic, number) for topic, numbers in short.items() for number in numbers]
    shortest = min(everything, key=lambda place: sizes[place[:2]][place[2]], default=None)
    return ([], False) if shortest is None else ([shortest], wanted > 1)


def _shares(
    numbers: Mapping[tuple[str, str], Sequence[int]], most: int
) -> dict[tuple[str, str], int]:
    """Divide `most` among topics. Topics with few messages leave the rest to the others."""
    shares = {}
    order = sorted(numbers, key=lambda topic: len(numbers[topic]))
    for index, topic in enumerate(order):
        shares[topic] = min(len(numbers[topic]), most // (len(order) - index))
        most -= shares[topic]
    return {topic: shares[topic] for topic in numbers}


def _spread(numbers: Sequence[int], count: int) -> list[int]:
    """Take `count` of some numbers at even distances, the first and the last included."""
    if count < 2:
        return list(numbers[:count])
    return [numbers[index * (len(numbers) - 1) // (count - 1)] for index in range(count)]


def _fetch(places: Iterable[_Place], topics: Sequence[Topic]) -> Iterator[RecordedMessage]:
    wanted = set(places)
    for bag in dict.fromkeys(topic.bag for topic in topics):
        mine = {place[1:] for place in wanted if place[0] == bag}
        if mine:
            yield from use_recording(bag, partial(_take, bag=bag, topics=topics, wanted=mine))


def _take(
    reader: Reader, bag: str, topics: Sequence[Topic], wanted: set[tuple[str, int]]
) -> list[RecordedMessage]:
    found: list[RecordedMessage] = []
    for topic, number, nanoseconds, data in _messages(reader, bag, topics):
        if (topic, number) in wanted:
            found.append(
                RecordedMessage(
                    bag=bag,
                    topic=topic,
                    number=number,
                    nanoseconds=nanoseconds,
                    data=data,
                )
            )
            if len(found) == len(wanted):
                break
    return found


def collect_recorded(
    distro: str | None,
    names: Sequence[str],
    bags: Sequence[str],
    *,
    wire: Wire | None,
    problems: dict[str, Diagnostic],
) -> list[TypeUnderTest]:
    """List the types to replay: those that are named, or all types that have topics.

    Parameters
    ----------
    distro : str or None
        The distribution by whose rules definitions are read; `None`: the one of the recordings.
    names : sequence of str
        Types by name; empty: all types.
    wire : Wire or None
        The wire format that is asked for.
    problems : dict
        Receives errors in definitions, by their texts, if no type is named.

    Raises
    ------
    DefinitionError
        If a recording cannot be used, or if the definition of a named type cannot be used or is
        too large to be laid out (:func:`firm_hdl.wire.too_large`).
    UnknownTypeError
        If a named type has no topic, or if the recording has another wire format.
    """
    library = open_library(distro, bags=bags)
    recorded_wire = WIRE_OF[library.dialect]
    if wire not in (None, recorded_wire):
        raise UnknownTypeError(f"'{bags[0]}' has messages of {recorded_wire}, not of {wire}")
    found: dict[str, None] = {}
    wrong: dict[str, Diagnostic] = {} if names else problems
    for kind in dict.fromkeys(topic.type for bag in bags for topic in topics_of(bag)):
        try:
            found[library.message(kind).name] = None
        except DefinitionError as error:
            wrong.update((str(problem), problem) for problem in error.diagnostics)
    wanted = list(dict.fromkeys(library.message(name).name for name in names)) or list(found)
    if missing := [name for name in wanted if name not in found]:
        raise UnknownTypeError(
            f"There is no topic of {', '.join(missing)}, only of {', '.join(sorted(found))}"
        )
    if large := [each for name in names for each in too_large(library.message(name))]:
        raise DefinitionError(large)
    return [
        TypeUnderTest(distro=library.distro, name=name, same=(library.distro,)) for name in wanted
    ]
