"""Replay: the messages of a recording through deserializer, no-op accelerator and serializer.

Each message is sent as it was recorded. Its leaves must transfer the values that rosbags decodes.
The packet that comes out must be the one that rosbags writes for these values. This is the recorded
packet itself, unless its writer used another form that the format allows. docs/reference/streams.md
describes the answers to packets that do not fit. For these, hardware and golden model must agree.

Messages are selected so that they are spread evenly. Files are read twice. The first pass keeps
only the times and sizes of all messages, however long the recording is. The messages are selected
by these. The second pass keeps the bytes of the selected messages.
"""

from __future__ import annotations

from array import array
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from itertools import islice
from operator import le
from typing import Any, TypeAlias

import numpy as np

from firm_hdl.cases import NotJudgedError
from firm_hdl.cases.damage import stalls_for
from firm_hdl.cases.effort import (
    LARGE_STRIDE,
    MAX_MESSAGE_BYTES,
    MOST_WORK,
    figures,
    is_large,
    work_of,
)
from firm_hdl.cases.make import Case
from firm_hdl.cases.oracle import Transfers
from firm_hdl.cases.user_oracle import Judge
from firm_hdl.cases.values import as_float, bits_of
from firm_hdl.errors import DefinitionError, Diagnostic
from firm_hdl.frontend import Library, open_library
from firm_hdl.model import WIRE_OF, Message
from firm_hdl.plan import Leaf, Payload, Plan, build_plan
from firm_hdl.plan.interpret import Decoded, decode, encode
from firm_hdl.recordings import Recording, Topic
from firm_hdl.verify.results.records import Record, Test
from firm_hdl.verify.systems.options import MOST_MESSAGES, CaseOptions
from firm_hdl.verify.systems.system import Trial
from firm_hdl.verify.systems.tasks import TypeUnderTest, UnknownTypeError, library_of
from firm_hdl.verify.ts3.acceptance import Acceptance, type_and_oracle, with_commands
from firm_hdl.wire import Wire, lay_out, too_large

__all__ = ["Selection", "collect_recorded", "replay", "select", "topics_of"]


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

    Raises `DefinitionError` if the recording cannot be read.
    """
    return [(bag, topic) for topic in Recording(bag).topics]


def select(
    topics: Sequence[Place], *, most: int, longest: int, most_bytes: int | None = None
) -> Selection:
    """Select messages that are spread evenly over each topic, and if possible over the topics.

    * `topics`: topics, all of the same type.
    * `most`: the maximum number of messages.
    * `longest`: the maximum size of a message in bytes.
    * `most_bytes`: the maximum size of all messages together. The shortest message is selected in
      any case.

    Raises `DefinitionError` if a recording cannot be read to its end.
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

    * `distro`: the distribution by whose rules definitions are read; `None`: the one of the
      recordings.
    * `names`: types by name; empty: all types.
    * `wire`: the wire format that is asked for.
    * `problems`: receives errors in definitions, by their texts, if no type is named. A type
      without a definition that can be read is no error, and is only named in the output.
    * `depends`: folders with the types that the recordings lack.

    Raises `DefinitionError` if a recording cannot be used, or if the definition of a named type
    cannot be used or is too large to be laid out (:func:`firm_hdl.wire.too_large`). Raises
    `UnknownTypeError` if a named type has no topic, or if the recording has another wire format.
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


REPRESENTATIONS = {
    0: "big-endian CDR",
    2: "a big-endian parameter list",
    3: "a parameter list",
    6: "big-endian XCDR2",
    7: "XCDR2",
    8: "big-endian delimited XCDR2",
    9: "delimited XCDR2",
    10: "a big-endian parameter list of XCDR2",
    11: "a parameter list of XCDR2",
}
"""Meanings of the second byte of a CDR packet; OMG DDS-XTypes 1.3, clause 7.6.2.1.2."""


def replay(options: CaseOptions, test: Test) -> Record:
    """Replay the messages of the type of a test. Errors are not raised, but are in the record.

    * `options`: options with recordings.
    * `test`: its distribution is the one by whose rules the definitions in the recordings are read.
    """
    with Trial.of(test) as trial:
        message, judge = type_and_oracle(options, trial)
        _replay(message, judge, options, trial)
    return with_commands(options, trial.end())


def _replay(message: Message, judge: Judge, options: CaseOptions, trial: Trial) -> None:
    record = trial.record
    topics, others = _topics(message, library_of(record.test.distro, options), options.bags)
    selection = _select(message, topics, options)
    longest = max(len(each.data) for each in selection.messages)
    run = Acceptance(message, message.wire, options, trial, _room(longest))
    with_bag = len(options.bags) > 1
    judged = [_judge(run.plan, judge, each, with_bag) for each in selection.messages]
    cases = [each.case for each in judged]
    record.cases, record.written_by = len(cases), ("rosbags",)
    record.metrics = figures(message, run.plan, [case.packet for case in cases])
    trial.failures += [each.finding for each in judged if each.finding]
    parts = [*_counts(selection, options), *others, *_kinds(judged)]
    record.note = "; ".join([*parts, *([judge.note] if judge.note else [])])
    trial.watch.enter("testing")
    run.check_golden_model(cases, ())
    if not options.simulated:
        return
    run.check_circuit(cases, None)
    if options.stalled:
        sample = cases[::LARGE_STRIDE] if is_large(run.plan, cases) else cases
        run.check_circuit(sample, stalls_for(f"{options.seed}/{judge.name}"))
    run.circuit.crosscheck()


def _room(longest: int) -> int:
    """Return the limit of the converters for the size of a message: a power of two.

    So recordings of the same robot mostly have the same circuits.
    """
    return max(MAX_MESSAGE_BYTES, 1 << max(0, longest - 1).bit_length())


def _topics(
    message: Message, library: Library, bags: Sequence[str]
) -> tuple[list[Place], list[str]]:
    """Return the topics of a type, and lines about topics that are left out.

    A topic is left out if its messages are in another wire format, or if its digest differs from
    the first digest of the type's topics.
    """
    kept: list[Place] = []
    foreign, others = [], []
    digest = ""
    for place in [each for bag in bags for each in topics_of(bag)]:
        topic = place[1]
        try:
            is_meant = library.message(topic.type).name == message.name
        except DefinitionError:
            # A definition that cannot be used belongs to another type.
            is_meant = False
        if not is_meant:
            continue
        out = f"{topic.name} left out: its"
        if topic.encoding != message.wire:
            foreign.append(f"{out} messages are in '{topic.encoding}', not in {message.wire}")
            continue
        digest = digest or topic.digest
        if topic.digest in ("", digest):
            kept.append(place)
        else:
            others.append(f"{out} definition is another one ({topic.digest})")
    return kept, foreign + others


def _select(message: Message, topics: Sequence[Place], options: CaseOptions) -> Selection:
    """Select messages; raise `NotJudgedError` if there are none."""
    most_bytes = None
    if options.most_cases is None:
        plan = build_plan(
            lay_out(message, message.wire),
            bus_bytes=options.bus_bytes,
            max_message_bytes=MAX_MESSAGE_BYTES,
        )
        most_bytes = MOST_WORK // work_of(plan, plan.bus_bytes) * plan.bus_bytes
    selection = select(
        topics,
        most=options.most_cases or MOST_MESSAGES,
        longest=options.longest,
        most_bytes=most_bytes,
    )
    if not selection.total:
        raise NotJudgedError("no messages of it were recorded")
    if not selection.messages:
        raise NotJudgedError(
            f"all of its {selection.total} messages have more than {options.longest} bytes; "
            "--max-message-bytes N takes longer ones"
        )
    return selection


@dataclass(frozen=True, slots=True, kw_only=True)
class _Judged:
    """A message and the expected results of its replay."""

    case: Case
    kind: str = ""  # How the packet differs from the one that rosbags writes; empty if it does not.
    finding: str = ""  # What is wrong with the message itself; empty if nothing is wrong.


def _judge(plan: Plan, judge: Judge, message: RecordedMessage, with_bag: bool) -> _Judged:
    what = f"{message.bag}: {message}" if with_bag else str(message)
    packet, decoded = message.data, decode(plan, message.data)
    by_golden = Case(
        what=what,
        value=None,
        packet=encode(plan, decoded.streams)[0],
        transfers=_by_path(plan, decoded.streams),
        given=packet,
        status=decoded.status,
    )
    if decoded.status == "ENCAPSULATION" and packet[:2] != b"\0\1":
        return _Judged(case=by_golden, kind=_representation(packet))
    try:
        answer, transfers = _ask(plan, judge, packet)
    # The exceptions of rosbags for packets that it cannot read have no common base class.
    except Exception as error:
        return _refused(plan, judge, by_golden, decoded, error)
    if decoded.status != "OK":
        return _Judged(case=by_golden, finding=_misfit(by_golden, "rosbags reads it"))
    if _changed(plan, decoded.streams, _in_python) != decoded.streams:
        kind = "with a signalling NaN, which Python does not keep"
        return _judged_by_substitute(
            plan, judge, by_golden, decoded, kind, "rosbags reads it otherwise"
        )
    case = Case(what=what, value=None, packet=answer, transfers=transfers, given=packet)
    return _Judged(case=case, kind=_difference(packet, answer, plan.header_bytes))


def _ask(plan: Plan, judge: Judge, packet: bytes) -> tuple[bytes, Transfers]:
    """Return the packet that rosbags writes for the content of a packet, and its transfers."""
    value = judge.oracle.read(packet, judge.name, plan.wire)
    _make_bools_plain(value)
    return (
        judge.oracle.write(value, judge.name, plan.wire),
        judge.oracle.transfers(value, judge.name, plan.wire, plan.bus_bytes),
    )


def _make_bools_plain(value: Any) -> None:
    """Make every item of arrays of bools 0 or 1, because NumPy keeps the byte that was read."""
    for field in fields(value):
        member = getattr(value, field.name)
        if isinstance(member, np.ndarray) and member.dtype == np.bool_:
            object.__setattr__(value, field.name, member.view(np.uint8) != 0)
        for each in member if isinstance(member, list) else [member]:
            if is_dataclass(each):
                _make_bools_plain(each)


def _refused(plan: Plan, judge: Judge, case: Case, decoded: Decoded, error: Exception) -> _Judged:
    """Judge a packet that rosbags refuses to read."""
    lines = str(error).strip().splitlines() or [type(error).__name__]
    text = f"rosbags says: {lines[0]}"
    if decoded.status != "OK":
        return _Judged(case=case, finding=_misfit(case, text))
    is_text = isinstance(error.__cause__, UnicodeDecodeError)
    kind = (
        "with text that is not UTF-8, which rosbags read with other letters in its place"
        if is_text
        else f"that rosbags reads only as a serializer writes them ({lines[0]})"
    )
    return _judged_by_substitute(plan, judge, case, decoded, kind, text)


def _judged_by_substitute(
    plan: Plan, judge: Judge, case: Case, decoded: Decoded, kind: str, text: str
) -> _Judged:
    """Judge a packet by a similar one without the floats and texts that rosbags cannot read."""
    kept = _changed(plan, decoded.streams, _in_python)
    streams = _changed(plan, kept, _in_ascii)
    packet = encode(plan, streams)[0]
    try:
        is_same = _ask(plan, judge, packet) == (packet, _by_path(plan, streams))
    except Exception:
        is_same = False
    if is_same:
        return _Judged(case=case, kind=kind)
    return _Judged(case=case, finding=_misfit(case, text))


def _misfit(case: Case, text: str) -> str:
    return (
        f"{case.what}: its {len(case.sent)} bytes do not fit the definition: status {case.status}; "
        f"{text}"
    )


def _by_path(plan: Plan, streams: Mapping[int, Sequence[Payload]]) -> Transfers:
    return {plan.leaves[leaf].path: list(payloads) for leaf, payloads in streams.items()}


def _changed(
    plan: Plan,
    streams: Mapping[int, Sequence[Payload]],
    change: Callable[[Leaf, Payload], Payload],
) -> dict[int, list[Payload]]:
    return {
        number: [change(plan.leaves[number], payload) for payload in payloads]
        for number, payloads in streams.items()
    }


def _in_python(leaf: Leaf, payload: Payload) -> Payload:
    """Return a payload after a conversion to a Python float, which loses signalling NaNs."""
    if leaf.kind != "scalar" or leaf.type not in ("float32", "float64"):
        return payload
    assert isinstance(payload, int)
    return bits_of(as_float(payload, leaf.item_bytes), leaf.item_bytes)


def _in_ascii(leaf: Leaf, payload: Payload) -> Payload:
    """Return a payload with the highest bit of each byte cleared, so that all text is ASCII."""
    if isinstance(payload, int) or leaf.item_bytes != 1 or leaf.signed:
        return payload
    items, last = payload
    return tuple(item & 0x7F for item in items), last


def _representation(packet: bytes) -> str:
    known = REPRESENTATIONS.get(packet[1]) if len(packet) > 1 and packet[0] == 0 else None
    name = known or f"the representation {packet[:2].hex() or 'of an empty packet'}"
    return f"in {name}, which get the status ENCAPSULATION"


def _difference(packet: bytes, answer: bytes, header_bytes: int) -> str:
    """Return a text about how a packet differs from rosbags' packet with the same meaning."""
    found = []
    if packet[:header_bytes] != answer[:header_bytes]:
        found.append("option bits")
    if len(packet) > len(answer):
        found.append("bytes after the message")
    body, other = packet[header_bytes : len(answer)], answer[header_bytes:]
    if body != other:
        found.append("padding that is not zero, or a bool that is neither 0 nor 1")
    return f"with {', '.join(found)}" if found else ""


def _counts(selection: Selection, options: CaseOptions) -> list[str]:
    """Return texts about how many messages were replayed, and which were left out and why."""
    topics = "1 topic" if selection.topics == 1 else f"{selection.topics} topics"
    found = [f"{len(selection.messages)} of {selection.total} messages of {topics} replayed"]
    if selection.sparse:
        found.append("more would take long, --cases N takes N")
    if selection.too_long:
        found.append(
            f"{len(selection.too_long)} left out, of more than {options.longest} bytes (up to "
            f"{max(selection.too_long)}): --max-message-bytes N takes longer ones"
        )
    return found


def _kinds(judged: Sequence[_Judged]) -> list[str]:
    """Count packets that rosbags would write differently, and name the first of each kind."""
    counts = Counter(each.kind for each in judged if each.kind)
    first = {each.kind: each.case.what for each in reversed(judged)}
    return [f"{count} {kind} (first: {first[kind]})" for kind, count in counts.items()]
