"""The messages of recordings: their types, and a selection of messages that are spread evenly.

Files are read twice. The first pass keeps only the times and sizes of all messages, however long
the recording is. The messages are selected by these. The second pass keeps the bytes of the
selected messages.
"""

from __future__ import annotations

from array import array
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from operator import le
from typing import TypeAlias

from firm_hdl.errors import DefinitionError, Diagnostic
from firm_hdl.frontend import open_library
from firm_hdl.model import WIRE_OF
from firm_hdl.recordings import Recording, Topic
from firm_hdl.verify.systems.tasks import TypeUnderTest, UnknownTypeError
from firm_hdl.wire import Wire, too_large

__all__ = ["Place", "RecordedMessage", "Selection", "collect_recorded", "select", "topics_of"]

_Message: TypeAlias = "tuple[str, str, int]"
"""Recording, topic, and number of the message in the topic."""


Place: TypeAlias = "tuple[str, Topic]"
"""A topic of a recording, with the recording."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordedMessage:
    """A message as it was recorded."""

    bag: str
    topic: str
    number: int  # The index of the message in its topic, from 0, in the order of times.
    nanoseconds: int  # The time of the recording.
    data: bytes

    def __str__(self) -> str:
        seconds, rest = divmod(self.nanoseconds, 10**9)
        return f"{self.topic} message {self.number} at {seconds}.{rest:09}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Selection:
    """Messages of a type that were selected."""

    # Selected messages, recording by recording, in the order of their times.
    messages: tuple[RecordedMessage, ...]
    total: int  # The number of all messages of the type.
    topics: int  # The number of topics with these messages.
    too_long: tuple[int, ...]  # Sizes in bytes of the messages that are too long.
    # Whether fewer messages than asked for were selected, because of their total size.
    sparse: bool


def topics_of(bag: str) -> list[Place]:
    """List the topics of a recording. One with several types or digests counts several times.

    Raises
    ------
    DefinitionError
        If the recording cannot be read.
    """
    return [(bag, topic) for topic in Recording(bag).topics]


def select(
    topics: Sequence[Place], *, most: int, longest: int, most_bytes: int | None = None
) -> Selection:
    """Select messages that are spread evenly over each topic, and if possible over the topics.

    Parameters
    ----------
    topics : sequence of (str, Topic)
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
    # Where the messages of a topic are in the file, in the order of their times.
    orders: dict[tuple[str, str], Sequence[int]] = {}
    for bag in dict.fromkeys(bag for bag, _ in topics):
        for name, times, each in _sizes(bag, topics):
            orders[bag, name] = order = _sorted(times)
            sizes[bag, name] = array("Q", [each[place] for place in order])
    places, sparse = _choose(sizes, most, longest, most_bytes)
    return Selection(
        messages=tuple(_fetch(places, orders, topics)),
        total=sum(map(len, sizes.values())),
        topics=len(sizes),
        too_long=tuple(size for each in sizes.values() for size in each if size > longest),
        sparse=sparse,
    )


def _messages(bag: str, topics: Iterable[Place]) -> Iterator[tuple[str, int, bytes]]:
    """Yield topic, time and bytes of each message of some topics, in the order of the file."""
    wanted = {topic for where, topic in topics if where == bag}
    for topic, nanoseconds, data in Recording(bag).messages(wanted):
        yield topic.name, nanoseconds, data


def _sizes(bag: str, topics: Sequence[Place]) -> Iterator[tuple[str, array[int], array[int]]]:
    """Yield the name of each topic, and the times and sizes of its messages."""
    found: dict[str, tuple[array[int], array[int]]] = {}
    for topic, nanoseconds, data in _messages(bag, topics):
        times, sizes = found.setdefault(topic, (array("q"), array("Q")))
        times.append(min(nanoseconds, (1 << 63) - 1))
        sizes.append(len(data))
    for topic, (times, sizes) in found.items():
        yield topic, times, sizes


def _sorted(times: Sequence[int]) -> Sequence[int]:
    """Return the places of some times, the earliest first."""
    if all(map(le, times, islice(times, 1, None))):
        return range(len(times))
    return array("Q", sorted(range(len(times)), key=times.__getitem__))


def _choose(
    sizes: Mapping[tuple[str, str], Sequence[int]], most: int, longest: int, most_bytes: int | None
) -> tuple[list[_Message], bool]:
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


def _fetch(
    places: Iterable[_Message],
    orders: Mapping[tuple[str, str], Sequence[int]],
    topics: Sequence[Place],
) -> Iterator[RecordedMessage]:
    """Yield messages, recording by recording, in the order of their times."""
    wanted: dict[str, dict[tuple[str, int], int]] = {}
    for bag, topic, number in places:
        wanted.setdefault(bag, {})[topic, orders[bag, topic][number]] = number
    for bag, numbers in wanted.items():
        found: list[RecordedMessage] = []
        seen: Counter[str] = Counter()
        for topic, nanoseconds, data in _messages(bag, topics):
            place = topic, seen[topic]
            seen[topic] += 1
            if place not in numbers:
                continue
            found.append(
                RecordedMessage(
                    bag=bag, topic=topic, number=numbers[place], nanoseconds=nanoseconds, data=data
                )
            )
            if len(found) == len(numbers):
                break
        yield from sorted(found, key=lambda message: message.nanoseconds)


def collect_recorded(
    distro: str | None,
    names: Sequence[str],
    bags: Sequence[str],
    *,
    wire: Wire | None,
    problems: dict[str, Diagnostic],
    depends: Sequence[str] = (),
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
        Receives errors in definitions, by their texts, if no type is named. A type without a
        definition that can be read is no error, and is only named in the output.
    depends : sequence of str
        Folders with the types that the recordings lack.

    Raises
    ------
    DefinitionError
        If a recording cannot be used, or if the definition of a named type cannot be used or is
        too large to be laid out (:func:`firm_hdl.wire.too_large`).
    UnknownTypeError
        If a named type has no topic, or if the recording has another wire format.
    """
    library = open_library(distro, bags=bags, depends=depends)
    recorded_wire = WIRE_OF[library.dialect]
    if wire not in (None, recorded_wire):
        raise UnknownTypeError(f"'{bags[0]}' has messages of {recorded_wire}, not of {wire}")
    if not names:
        for sentence in library.unusable.values():
            print(f"note: {sentence}")
    found: dict[str, None] = {}
    wrong: dict[str, Diagnostic] = {} if names else problems
    for kind in dict.fromkeys(topic.type for bag in bags for _, topic in topics_of(bag)):
        try:
            found[library.message(kind).name] = None
        except DefinitionError as error:
            if kind not in library.unusable:
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
