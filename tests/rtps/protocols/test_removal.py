"""Endpoints that are removed, and what a participant does with what still comes for them."""

from __future__ import annotations

from tests.rtps.network import Network


def test_an_endpoint_can_be_removed_twice():
    network = Network()
    one, two = network.station(), network.station()
    writer, reader = one.writer(), two.reader()
    assert network.run(5, lambda: len(writer.matched) == 1)
    for _ in range(2):
        one.core.remove(writer.guid, network.now)
        two.core.remove(reader.guid, network.now)
    assert network.run(5, lambda: not list(two.core.remotes(writers=True)))
    assert writer.matched == reader.matched == ()
