"""A participant that announces another address."""

from __future__ import annotations

from dataclasses import replace

from firm_hdl.rtps.events import Matched
from firm_hdl.rtps.wire import message
from firm_hdl.rtps.wire.guid import SPDP_READER, SPDP_WRITER
from firm_hdl.rtps.wire.locators import Address
from firm_hdl.rtps.wire.submessages import Data
from tests.rtps.network import Network


def test_every_endpoint_of_a_participant_that_moves_moves_with_it():
    network = Network()
    one, two = network.station(), network.station()
    topics = ["rt/a", "rt/b", "rt/c"]
    writers = [one.writer(topic=topic) for topic in topics]
    for topic in topics:
        two.reader(topic=topic)
    assert network.run(10, lambda: len(one.named("Matched")) == len(topics))
    network.run(1)
    there = Address("10.0.0.77", 7500)
    # Endpoints without addresses have the default ones of their participant.
    readers = [replace(each, addresses=()) for each in one.core.remotes(writers=False)]
    two.core._sedp.subscriptions.forget(1)
    for each in readers:
        two.core._sedp.subscriptions.write(each.encode(), network.now)
    network.run(1)
    own = two.core.settings.own
    moved = replace(own, discovery=(Address(there.host, 7410),), user=(there,))
    announcement = Data(
        reader=SPDP_READER, writer=SPDP_WRITER, sequence_number=1, payload=moved.encode()
    )
    one.core.receive(message.write(own.prefix, [announcement]), network.now, there.host)
    while one.core.outbox:
        one.core.pop()
    for writer in writers:
        one.write(writer, b"\0\1\0\0")
        found = []
        while one.core.outbox:
            found.append(one.core.pop()[0])
        assert found == [there]
    assert not [event for event in one.core.events if isinstance(event, Matched)]
