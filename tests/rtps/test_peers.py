"""The way to a peer: which of its addresses are used, and how much goes to them."""

from __future__ import annotations

from firm_hdl.rtps.discovery import ParticipantData
from firm_hdl.rtps.peers import Peer, Route
from firm_hdl.rtps.wire.locators import Address
from tests.rtps.network import Network

HERE, THERE, LOOP = (Address(host, 1) for host in ("10.1.2.3", "192.168.1.7", "127.0.0.1"))


def peer_of(*addresses, here="10.1.2.9", host="10.9.9.9"):
    data = ParticipantData(prefix=bytes(12), discovery=addresses, user=addresses, lease=10.0)
    return Peer(data, here, host)


def ways(*addresses, here):
    """Return what is tried first if nothing is known of where the peer is heard from."""
    return Route(peer_of(*addresses, here=here, host=None)).ways()[0]


def test_the_nearest_of_several_addresses():
    assert ways(THERE, HERE, LOOP, here="10.1.2.9") == (HERE,)
    assert ways(HERE, THERE, LOOP, here="192.168.1.2") == (THERE,)
    assert ways(HERE, THERE, LOOP, here="127.0.0.1") == (LOOP,)
    assert ways(here="127.0.0.1") == ()
    # Of one network are those that begin alike, not those whose numbers are near.
    near, far = Address("10.0.2.0", 1), Address("10.0.1.1", 1)
    assert ways(near, far, here="10.0.1.255") == (far,)


def test_all_addresses_are_tried_until_the_peer_is_heard_from_one():
    peer = peer_of(THERE, HERE, LOOP)
    for host in ("10.9.9.9", "10.1.2.4"):
        peer.hear(host, 100, 0.0)
        assert Route(peer).ways() == ((HERE, LOOP, THERE), False)
    peer.hear(THERE.host, 100, 1.0)
    assert Route(peer).ways() == ((THERE,), True)
    # The first one is kept as long as it is heard from there, and another one is next.
    for now, way in ((3.9, THERE), (4.1, HERE), (7.2, HERE)):
        peer.hear(HERE.host, 100, now)
        assert Route(peer).ways() == ((way,), True)
    # Its endpoints have ports of their own, and are on the same way.
    assert Route(peer, (Address(LOOP.host, 5), Address(HERE.host, 7))).ways() == (
        (Address(HERE.host, 7),),
        True,
    )
    # Whoever says that an endpoint is elsewhere has not shown it.
    other = Address("10.0.0.66", 53)
    assert Route(peer, (other,)).ways() == ((other,), False)


def test_no_more_than_four_addresses_are_tried():
    many = tuple(Address(f"10.1.{number}.1", 1) for number in range(9))
    assert Route(peer_of(*many)).ways() == (tuple(many[n] for n in (2, 3, 0, 1)), False)


def test_a_peer_whose_nearest_address_leads_nowhere_is_served():
    """A host with two networks, of which one has our numbers, and is not ours."""
    network = Network()
    one, two = network.station(), network.station(elsewhere=("10.0.0.0",))
    writer, reader = one.writer(), two.reader()
    assert network.run(5, lambda: bool(one.named("Matched") and two.named("Matched")))
    one.write(writer, b"abcd")
    assert network.run(1, lambda: two.payloads == [b"abcd"])
    assert reader.lost == 0
