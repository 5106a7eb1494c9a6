"""A participant that announces another address."""

from __future__ import annotations

from dataclasses import replace

from firm_hdl.rtps.events import Matched
from firm_hdl.rtps.wire.locators import Address
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
    remotes = one.core._sedp._remotes
    remotes |= {guid: (replace(data, addresses=()), kind) for guid, (data, kind) in remotes.items()}
    (peer,) = one.core.peers
    one.core._found(replace(peer, user=(there,)), network.now)
    for writer in writers:
        one.write(writer, b"\0\1\0\0")
        found = []
        while one.core.outbox:
            found.append(one.core.pop()[0])
        assert found == [there]
    assert not [event for event in one.core.events if isinstance(event, Matched)]
