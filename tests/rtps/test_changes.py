"""Endpoints of peers that change after they have matched."""

from __future__ import annotations

from dataclasses import replace

from firm_hdl.rtps import Qos, Reliability
from tests.rtps.network import Network
from tests.rtps.test_core import pair

KEEP_ALL = Qos(depth=0)
BEST_EFFORT = Qos(reliability=Reliability.BEST_EFFORT)


def test_a_peer_that_changes_its_policies():
    network = Network()
    one, two, writer = pair(network, BEST_EFFORT, BEST_EFFORT)
    (known,) = one.core.matched(writer.guid)
    for asked, matched in ((KEEP_ALL, 0), (BEST_EFFORT, 1)):
        changed = replace(known, qos=asked).encode()
        two.core._sedp.subscriptions.write(changed, network.now)
        network.run(1)
        assert len(writer.matched) == len(one.core.matched(writer.guid)) == matched
    assert len(one.named("Matched")) == 2 and len(one.named("Unmatched")) == 1
