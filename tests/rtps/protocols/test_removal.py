"""Endpoints that are removed, and what a participant does with what still comes for them."""

from __future__ import annotations

import gc
import weakref

from firm_hdl.rtps import Qos
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


def test_an_endpoint_that_is_removed_takes_no_memory():
    network = Network()
    one, two = network.station(), network.station()

    def use():
        writer, reader = one.writer(Qos(depth=0)), two.reader()
        assert network.run(5, lambda: len(writer.matched) == 1)
        one.write(writer, bytes(100))
        one.core.remove(writer.guid, network.now)
        two.core.remove(reader.guid, network.now)
        return weakref.ref(writer), weakref.ref(reader)

    kept = use()
    assert network.run(5, lambda: not list(two.core.remotes(writers=True)))
    gc.collect()
    assert [each() for each in kept] == [None, None]
