"""The link with a participant of the host: discovery, samples both ways, and losses.

Amaranth simulates about a thousand cycles of the link per second, so there is one scenario. Real
peers, and what takes longer, are in ``tests/live/test_participant.py``.
"""

from __future__ import annotations

from dataclasses import replace

import pytest

from firm_hdl.rtps import Qos
from firm_hdl.rtps.events import Arrived
from firm_hdl.rtps.ros import graph, names
from firm_hdl.rtps.wire import message
from firm_hdl.rtps.wire.guid import is_builtin, user_reader, user_writer
from firm_hdl.rtps.wire.submessages import (
    AckNack,
    Data,
    DataFrag,
    Heartbeat,
    InfoDestination,
    NackFrag,
    NumberSet,
    fragment,
)
from tests.depth import by_depth
from tests.node.rtps.wires import Wires, core_of, description_of

STRING = names.type_name("std_msgs/msg/String")
# Sizes that are no multiples of 4 are padded on the way; the last one needs two fragments.
MESSAGES = [b"\0\1\0\0" + bytes(n % 251 for n in range(size)) for size in (4, 7, 293)]
FRAGMENT_BYTES, WANTED = 256, NumberSet(2, (2,))


class Losses:
    """Lose the second sample of a topic, and the first fragment, once in each direction.

    While `silent` is not empty, lose what participants with these prefixes acknowledge of the
    link's topic.
    """

    def __init__(self, once):
        self.once, self.lost, self.silent = once, set(), ()

    def __call__(self, is_to_board, datagram):
        prefix = datagram[24:36] if datagram[20] == InfoDestination.KIND else bytes(12)
        for each in message.read(datagram, prefix).received:
            what, is_silent = each.submessage, each.source in self.silent
            if is_silent and isinstance(what, AckNack) and what.writer == user_writer(2):
                return True
            if not self.once:
                continue
            is_second = (
                isinstance(what, Data) and what.sequence_number == 2 and not is_builtin(what.writer)
            )
            is_first = isinstance(what, DataFrag) and what.first == 1
            key = is_to_board, is_first
            if (is_second or is_first) and key not in self.lost:
                self.lost.add(key)
                return True
        return False


@pytest.mark.parametrize("has_losses", by_depth([False], [False, True]))
def test_discovery_and_samples_both_ways(has_losses):
    core, loses = core_of(1, fragment_bytes=FRAGMENT_BYTES), Losses(once=has_losses)
    wires = Wires(description_of(datagram_bytes=448), core, loses=loses)
    reader = core.add_reader("rt/said", STRING, Qos(), b"", 0.0)
    nodes = core.add_reader(graph.TOPIC, graph.TYPE, graph.QOS, b"", 0.0)
    writer = core.add_writer("rt/heard", STRING, Qos(depth=0), b"", 0.0)

    def came(entity):
        return [
            each.sample.payload
            for each in wires.events[core]
            if isinstance(each, Arrived) and each.reader == entity
        ]

    def said(kind, **fields):
        return [
            each.submessage
            for _, datagram in wires.sent
            for each in message.read(datagram, core.prefix).received
            if isinstance(each.submessage, kind)
            and all(getattr(each.submessage, name) == value for name, value in fields.items())
        ]

    def script():
        wires.put(b"RTPS\2\3\1\xff" + bytes(range(12)) + b"\x15\1\xff\xff" + bytes(30))
        yield from wires.until(lambda: len(came(nodes.guid)) == 1)
        # The link greets a writer and a reader that it has matched.
        yield from wires.until(lambda: said(AckNack, reader=user_reader(1)))
        yield from wires.until(lambda: said(Heartbeat, writer=user_writer(2)))
        for number, each in enumerate(MESSAGES):
            core.write(writer, each, wires.now, number)
        yield from wires.until(lambda: wires.received)
        wires.to_send.extend((2, 0, each) for each in MESSAGES)
        yield from wires.until(lambda: len(wires.received) == len(came(reader.guid)) == 3)
        # Nothing else is under way when it comes.
        yield from wires.pause(0.02)
        core.write(writer, MESSAGES[0], wires.now, 3)
        yield from wires.until(lambda: len(wires.received) == 4)
        # Fragments that somebody misses, and no others.
        before = len(said(DataFrag, first=2))
        ends = {"reader": reader.guid.entity, "writer": user_writer(2), "sequence_number": 3}
        wires.put(message.write(core.prefix, [NackFrag(**ends, missing=WANTED, count=99)]))
        yield from wires.until(lambda: len(said(DataFrag, first=2)) > before)
        assert has_losses or len(said(DataFrag, first=1)) == before
        # Fragments that the link misses. Those with other sizes, or behind the end, are not those.
        data = Data(
            reader=user_reader(1),
            writer=writer.guid.entity,
            sequence_number=5,
            payload=MESSAGES[2],
        )
        first, second = (fragment(data, number, FRAGMENT_BYTES) for number in (1, 2))
        changes = [{"fragment_bytes": 252}, {"sample_bytes": 300}, {"sample_bytes": 1 << 20}]
        others = [replace(second, **change) for change in (*changes, {"first": 9})]
        begun = Heartbeat(
            reader=user_reader(1), writer=writer.guid.entity, first=1, last=5, count=99
        )
        # They end within a word, so nothing follows them in their datagrams.
        for each in ([first, others[0]], *([other] for other in others[1:]), [begun]):
            wires.put(message.write(core.prefix, each))
        yield from wires.until(lambda: said(NackFrag, sequence_number=5, missing=WANTED))
        wires.put(message.write(core.prefix, [second]))
        yield from wires.until(lambda: len(wires.received) == 5)
        # The memory has room for one of these. The next one waits until it is acknowledged.
        loses.silent = (core.prefix,)
        wires.to_send.extend([(2, 0, MESSAGES[2])] * 2)
        yield from wires.until(lambda: len(came(reader.guid)) == 4)
        yield from wires.pause(0.02)
        assert len(wires.taken_at) == 4
        ends = {"reader": reader.guid.entity, "writer": user_writer(2), "count": 99}
        wires.put(message.write(core.prefix, [AckNack(**ends, missing=NumberSet(5))]))
        yield from wires.until(lambda: len(wires.taken_at) == 5)

    wires.run(script())
    (info,) = map(graph.GraphInfo.decode, came(nodes.guid))
    assert [(each.namespace, each.name) for each in info.nodes] == [("/fpga", "echo")]
    wanted = [*MESSAGES, MESSAGES[0], MESSAGES[2]]
    assert wires.received == [(1, 1 + n, each) for n, each in enumerate(wanted)]
    whole, padded = [], came(reader.guid)
    for each in (*MESSAGES, MESSAGES[2]):
        # A sample in fragments has its size, as a whole one has not.
        whole.append(each + bytes(-len(each) % 4) if len(each) < FRAGMENT_BYTES else each)
    assert padded == whole
    assert len(loses.lost) == (4 if has_losses else 0)
    assert wires.counters["malformed"] == 1
    assert has_losses or wires.counters["cut"] == 4
    if not has_losses:
        begins = min(each for each in wires.sent_at if each > wires.taken_at[0])
        assert (wires.waits[3], begins - wires.taken_at[0]) == (54, 45)


@pytest.mark.thorough
def test_a_silent_reader_holds_a_writer_for_three_seconds():
    cores, loses = (core_of(1), core_of(2)), Losses(once=False)
    description = description_of(clock_hz=6_000.0, said=", history: keep_all")
    wires = Wires(description, *cores, loses=loses)
    for each in cores:
        each.add_reader("rt/said", STRING, Qos(), b"", 0.0)

    def came(core):
        return sum(isinstance(each, Arrived) for each in wires.events[core])

    def script():
        yield from wires.pause(3.0)
        loses.silent = tuple(each.prefix for each in cores)
        wires.to_send.extend([(2, 0, MESSAGES[2])] * 2)
        yield from wires.until(lambda: came(cores[1]) == 1)
        yield from wires.pause(2.0)
        assert len(wires.taken_at) == 1
        # The other one answers again.
        loses.silent = (cores[1].prefix,)
        yield from wires.pause(0.5)
        assert len(wires.taken_at) == 1
        yield from wires.until(lambda: came(cores[0]) == 2, 2.0)
        wires.to_send.extend([(2, 0, MESSAGES[2])] * 9)
        yield from wires.until(lambda: came(cores[0]) == 11, 4.0)

    wires.run(script())


@pytest.mark.thorough
def test_a_peer_that_has_just_come_does_not_give_way():
    # There is room for two peers.
    wires = Wires(description_of(clock_hz=6_000.0), *map(core_of, (1, 2, 3)))
    wires.run(wires.pause(0.85))
    assert wires.counters["unsent"] >= 1
    hosts = {to.host for to, _ in wires.sent}
    assert {"10.0.0.1", "10.0.0.2"} <= hosts and "10.0.0.3" not in hosts


@pytest.mark.thorough
def test_a_peer_has_half_of_the_endpoints_and_others_when_they_are_free():
    said = [b"\0\1\0\0" + each for each in (b"once", b"more")]
    # There is room for six endpoints of two peers.
    first, second = core_of(1), core_of(2)
    wires = Wires(description_of(clock_hz=6_000.0), first, second)
    greedy = [first.add_reader("rt/said", STRING, Qos(), b"", 0.0) for _ in range(5)]
    reader = second.add_reader("rt/said", STRING, Qos(), b"", 0.0)

    def served(core, number):
        ends = [each for each in wires.events[core] if isinstance(each, Arrived)]
        return {each.reader for each in ends if each.sample.payload == said[number]}

    def script():
        yield from wires.pause(2.0)
        wires.to_send.append((2, 0, said[0]))
        yield from wires.until(lambda: served(second, 0))
        yield from wires.pause(0.2)
        assert served(first, 0) == {each.guid for each in greedy[:3]}
        for each in greedy[1:3]:
            first.remove(each.guid, wires.now)
        yield from wires.pause(2.5)
        wires.to_send.append((2, 0, said[1]))
        yield from wires.until(lambda: len(served(first, 1)) == 3)
        yield from wires.pause(0.2)

    wires.run(script())
    assert served(first, 1) == {each.guid for each in (greedy[0], *greedy[3:])}
    assert served(second, 1) == {reader.guid}
