"""Datagrams of real peers, and what is read in them."""

from __future__ import annotations

import pytest

from firm_hdl.rtps import Durability, Guid, SampleIdentity
from firm_hdl.rtps.discovery import EndpointData
from firm_hdl.rtps.ros import names
from firm_hdl.rtps.wire import message
from firm_hdl.rtps.wire.locators import Address
from firm_hdl.rtps.wire.parameters import ParameterList
from firm_hdl.rtps.wire.submessages import Data
from tests.rtps.captures import CAPTURES, RECEIVER_OF, SEDP_CYCLONE, SEDP_FAST_DDS


@pytest.mark.parametrize("name", CAPTURES)
def test_captured_datagrams(name):
    text, submessages, seconds, unknown = CAPTURES[name]
    datagram = bytes.fromhex(text)
    content = message.read(datagram, RECEIVER_OF[name.split(":")[0]])
    assert content.error is None
    assert [each.submessage for each in content.received] == submessages
    assert content.unknown == unknown
    assert content.source == datagram[8:20]
    for each in content.received:
        if isinstance(each.submessage, Data):
            # A float of today's seconds is exact to a quarter of a microsecond.
            assert each.timestamp == pytest.approx(seconds * 1e9, abs=1000)


@pytest.mark.parametrize("name", [each for each in CAPTURES if "0e010c00" in CAPTURES[each][0]])
def test_datagrams_for_somebody_else(name):
    content = message.read(bytes.fromhex(CAPTURES[name][0]), bytes(range(12)))
    assert content.received == ()
    assert content.error is None


@pytest.mark.parametrize("name", CAPTURES)
def test_what_is_written_is_what_the_peer_wrote(name):
    """Our bytes of a submessage are those of the peer, but for its version and vendor."""
    text, submessages, *_ = CAPTURES[name]
    datagram = bytes.fromhex(text)
    for each in submessages:
        ours = message.write(bytes(12), [each])[20:]
        assert ours in datagram


def test_a_request_names_its_reader_of_replies():
    (data,) = CAPTURES["fast: DATA of a request, with the reader of replies in its inline QoS"][1]
    reader = Guid(bytes.fromhex("010f7f01377d00a600000000"), 0x1304)
    assert data.inline.related(b"\x01\x0f") == SampleIdentity(reader, -1 << 32)
    # Releases that know the standard's identifier not yet write their own alone.
    old = ParameterList(data.inline.items[1:])
    assert old.related(b"\x01\x0f") == SampleIdentity(reader, -1 << 32)
    assert old.related(b"\x01\x10") is None


def test_sedp_of_fast_dds():
    endpoint = _endpoint(SEDP_FAST_DDS)
    assert endpoint.topic == "rt/rosout"
    assert endpoint.type_name == "rcl_interfaces::msg::dds_::Log_"
    assert str(endpoint.guid) == "010f7f01367d633600000000:00000303"
    # Its address in shared memory is none for us.
    assert endpoint.addresses == (Address("127.0.0.1", 7415),)
    assert endpoint.qos.reliable
    assert endpoint.qos.durability == Durability.TRANSIENT_LOCAL
    assert names.type_hash_of(endpoint.user_data) == (
        "RIHS01_e28ce254ca8abc06abf92773b74602cdbf116ed34fbaf294fb9f81da9f318eac"
    )


def test_sedp_of_cyclone():
    endpoint = _endpoint(SEDP_CYCLONE)
    assert (endpoint.topic, endpoint.type_name) == ("rt/c", "std_msgs::msg::dds_::String_")
    assert endpoint.addresses == ()
    assert endpoint.qos.reliable
    assert endpoint.qos.durability == Durability.VOLATILE


def _endpoint(text):
    content = message.read(bytes.fromhex(text), bytes(12))
    (data,) = [each.submessage for each in content.received]
    return EndpointData.decode(data.payload, writer=True)
