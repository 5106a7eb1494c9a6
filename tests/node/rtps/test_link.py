"""The link with a participant of the host: discovery, samples both ways, and losses.

Amaranth simulates about a thousand cycles of the link per second, so there is one scenario. Real
peers, and what takes longer, are in ``tests/live/test_participant.py``.
"""

from __future__ import annotations

import pytest

from firm_hdl.rtps import Qos
from firm_hdl.rtps.events import Arrived
from firm_hdl.rtps.ros import graph, names
from firm_hdl.rtps.wire import message
from firm_hdl.rtps.wire.guid import is_builtin, user_reader, user_writer
from firm_hdl.rtps.wire.submessages import AckNack, Data, Heartbeat, InfoDestination
from tests.depth import by_depth
from tests.node.rtps.wires import Wires, core_of, description_of

STRING = names.type_name("std_msgs/msg/String")
# Sizes that are no multiples of 4 are padded on the way.
MESSAGES = [b"\0\1\0\0" + bytes(range(n)) for n in (4, 7, 8)]


class Once:
    """Lose the second sample of a topic, once in each direction."""

    def __init__(self):
        self.lost = set()

    def __call__(self, is_to_board, datagram):
        prefix = datagram[24:36] if datagram[20] == InfoDestination.KIND else bytes(12)
        found = [each.submessage for each in message.read(datagram, prefix).received]
        samples = [each for each in found if isinstance(each, Data) and not is_builtin(each.writer)]
        if is_to_board in self.lost or not any(each.sequence_number == 2 for each in samples):
            return False
        self.lost.add(is_to_board)
        return True


@pytest.mark.parametrize("has_losses", by_depth([False], [False, True]))
def test_discovery_and_samples_both_ways(has_losses):
    core, loses = core_of(1), Once()
    wires = Wires(description_of(), core, loses=loses if has_losses else lambda *_: False)
    reader = core.add_reader("rt/said", STRING, Qos(), b"", 0.0)
    nodes = core.add_reader(graph.TOPIC, graph.TYPE, graph.QOS, b"", 0.0)
    writer = core.add_writer("rt/heard", STRING, Qos(depth=0), b"", 0.0)

    def came(entity):
        return [
            each.sample.payload
            for each in wires.events[core]
            if isinstance(each, Arrived) and each.reader == entity
        ]

    def said(kind, end, entity):
        return any(
            isinstance(each.submessage, kind) and getattr(each.submessage, end) == entity
            for _, datagram in wires.sent
            for each in message.read(datagram, core.prefix).received
        )

    def script():
        wires.put(b"RTPS\2\3\1\xff" + bytes(range(12)) + b"\x15\1\xff\xff" + bytes(30))
        yield from wires.until(lambda: len(came(nodes.guid)) == 1)
        # The link greets a writer and a reader that it has matched.
        greets = ((AckNack, "reader", user_reader(1)), (Heartbeat, "writer", user_writer(2)))
        yield from wires.until(lambda: all(said(*each) for each in greets))
        for number, each in enumerate(MESSAGES):
            core.write(writer, each, wires.now, number)
            wires.to_send.append((2, 0, each))
        yield from wires.until(lambda: len(wires.received) == len(came(reader.guid)) == 3)

    wires.run(script())
    (info,) = map(graph.GraphInfo.decode, came(nodes.guid))
    assert [(each.namespace, each.name) for each in info.nodes] == [("/fpga", "echo")]
    assert wires.received == [(1, 1 + n, each) for n, each in enumerate(MESSAGES)]
    assert came(reader.guid) == [each + bytes(-len(each) % 4) for each in MESSAGES]
    assert loses.lost == ({False, True} if has_losses else set())
    assert wires.counters["malformed"] == 1
    if not has_losses:
        # The header of a datagram, which was stored, has 60 bytes.
        assert wires.waits[0] < 150
        begins = min(each for each in wires.sent_at if each > wires.taken_at[0])
        assert begins - wires.taken_at[0] < 60
