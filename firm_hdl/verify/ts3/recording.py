"""The messages of recordings: of which types, a few of them spread evenly, and their bytes.

Files are read twice: first only sizes are kept, so that which messages to take is decided with all
of them known, however long the recording is; then those are taken, just as they were recorded.
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
from firm_hdl.verify.systems.tasks import TypeUnderTest, UnknownTypeError
from firm_hdl.wire import Wire, too_large

__all__ = ["RecordedMessage", "Selection", "Topic", "collect_recorded", "select", "topics_of"]

_Place: TypeAlias = "tuple[str, str, int]"
"""Recording, topic, and number of the message in the topic."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Topic:
    """A topic of a recording; one that is recorded in several ways counts several times.

    Attributes
    ----------
    bag : str
    name : str
    type : str
        ``package/msg/Type``, as rosbags calls it in both kinds of ROS.
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
        Messages of a topic are counted from 0, in the order of their times.
    nanoseconds : int
        When it was recorded.
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
        Recording by recording, in the order of their times.
    total : int
        How many messages there are.
    topics : int
        How many topics these are from.
    too_long : tuple of int
        Sizes of those that are too long, in bytes.
    sparse : bool
        Whether there are fewer than asked for, because all together have too many bytes.
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
        If it cannot be read.
    """
    found = use_recording(bag, lambda reader: [_topic(bag, each) for each in reader.connections])
    return list(dict.fromkeys(found))


def select(
    topics: Sequence[Topic], *, most: int, longest: int, most_bytes: int | None = None
) -> Selection:
    """Select messages, spread evenly over each topic, and over the topics as evenly as can be.

    Parameters
    ----------
    topics : sequence of Topic
        All of the same type.
    most : int
        Most messages.
    longest : int
        Most bytes of a message.
    most_bytes : int or None
        Most bytes of all together. One message, the shortest, is selected in any case.

    Raises
    ------
    DefinitionError
        If a recording cannot be read, to its end.
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
    # DDS tools write the scopes of IDL; whether the definition can be read is said elsewhere.
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
    """Return the places of what is selected, and whether bytes were what limits it."""
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
    """Divide `most` among topics; what one that is short leaves, the others get."""
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
    """List the types to replay: those that are named, or all that there are topics of.

    Parameters
    ----------
    distro : str or None
        By whose rules definitions are read; `None`: the recordings' own.
    names : sequence of str
        None: all types.
    wire : Wire or None
        The wire format that is asked for.
    problems : dict
        Takes what is wrong with the definition of one of all types, by its text.

    Raises
    ------
    DefinitionError
        If a recording cannot be used, or the definition of a type that is named: it must not be
        too large to be laid out (:func:`firm_hdl.wire.too_large`).
    UnknownTypeError
        If there is no topic of a type that is named, or the recording is of another wire format.
    """
    library = open_library(distro, bags=bags)
    if wire not in (None, there := "ros1" if library.dialect == "ros1" else "cdr"):
        raise UnknownTypeError(f"'{bags[0]}' has messages of {there}, not of {wire}")
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
