"""What participants and endpoints announce, parameter by parameter, after 9.6.2.2."""

from __future__ import annotations

import pytest

from firm_hdl.rtps.discovery import EndpointData, ParticipantData
from firm_hdl.rtps.qos import Qos
from firm_hdl.rtps.wire.guid import Guid
from firm_hdl.rtps.wire.locators import Address
from firm_hdl.rtps.wire.octets import MalformedError
from firm_hdl.rtps.wire.parameters import ParameterList

PREFIX = bytes(range(12))
GUID = Guid(PREFIX, 0x0000_0103)
GUID_TEXT = "000102030405060708090a0b00000103"


def locator(port, *host):
    return "01000000" + port.to_bytes(4, "little").hex() + "00" * 12 + bytes(host).hex()


def parameters(payload):
    """Return the parameters of a payload, each with all its values."""
    found = {}
    for pid, value in ParameterList.decode_payload(payload).items:
        found.setdefault(pid, []).append(value.hex())
    return found


def test_an_endpoint_names_itself_and_where_it_is():
    data = EndpointData(
        guid=GUID,
        topic="rt/a",
        type_name="T",
        qos=Qos(depth=3),
        addresses=(Address("10.1.2.3", 7411), Address("10.1.2.4", 7413)),
        user_data=b"ab",
    )
    found = parameters(data.encode())
    assert found[0x5A] == [GUID_TEXT]
    # The key hash: readers with a key tell instances apart by it.
    assert found[0x70] == [GUID_TEXT]
    assert found[0x05] == ["05000000" + b"rt/a\0\0\0\0".hex()]
    assert found[0x07] == ["02000000" + b"T\0\0\0".hex()]
    assert found[0x2F] == [locator(7411, 10, 1, 2, 3), locator(7413, 10, 1, 2, 4)]
    assert found[0x2C] == ["02000000" + b"ab\0\0".hex()]
    # The policies follow: reliability, durability, history and five more.
    assert {0x1A, 0x1D, 0x40, 0x23, 0x1B, 0x1F, 0x73} <= set(found)


def test_a_participant_has_its_addresses_by_what_they_are_for():
    data = ParticipantData(
        prefix=PREFIX,
        discovery=(Address("10.1.2.3", 7410),),
        user=(Address("10.1.2.3", 7411),),
        lease=20.0,
        name="n",
        domain=0,
    )
    found = parameters(data.encode())
    assert found[0x50] == ["000102030405060708090a0b000001c1"]
    assert found[0x32] == [locator(7410, 10, 1, 2, 3)]
    assert found[0x31] == [locator(7411, 10, 1, 2, 3)]
    assert found[0x02] == ["1400000000000000"]
    assert found[0x58] == ["3f000000"]
    # Domain 0 is one, too.
    assert found[0x0F] == ["00000000"]
    assert found[0x15] == ["02030000"] and found[0x16] == ["01ff0000"]
    assert found[0x62] == ["02000000" + b"n\0\0\0".hex()]
    assert 0x2C not in found


# What peers announce.


def announced(*policies):
    """Return what a peer's writer says with more parameters; their values are hexadecimal."""
    items = ((0x5A, bytes(GUID)), (0x05, b"\2\0\0\0t\0"), (0x07, b"\2\0\0\0T\0"))
    more = tuple((pid, bytes.fromhex(value)) for pid, value in policies)
    return EndpointData.decode(ParameterList((*items, *more)).encode_payload(), writer=True)


def test_policies_that_are_left_out_ask_for_nothing():
    qos = announced().qos
    assert (qos.deadline, qos.lease, qos.liveliness) == (float("inf"), float("inf"), 0)
    assert (qos.exclusive, qos.partitions, qos.representations) == (False, (), ())


@pytest.mark.parametrize(
    ("kind", "is_reliable"), [("00000000", False), ("01000000", False), ("02000000", True)]
)
def test_only_the_kind_2_is_reliable(kind, is_reliable):
    assert announced((0x1A, kind + "00" * 8)).qos.reliable is is_reliable


def test_the_durabilities_are_four():
    for kind in range(4):
        assert announced((0x1D, f"0{kind}000000")).qos.durability == kind
    for value, kind in (("04000000", 4), ("ff000000", 255)):
        with pytest.raises(MalformedError, match=rf"^durability {kind}$"):
            announced((0x1D, value))


@pytest.mark.parametrize(
    ("pid", "policy", "text", "value"),
    [
        (0x29, "partitions", "02000000" + b"p\0\0\0".hex(), "p"),
        (0x73, "representations", "0200", 2),
    ],
)
def test_as_many_as_64_are_read(pid, policy, text, value):
    for count in (1, 64):
        given = (pid, count.to_bytes(4, "little").hex() + text * count)
        assert getattr(announced(given).qos, policy) == (value,) * count
    with pytest.raises(MalformedError, match=r"^65 entries, where 64 may be$"):
        announced((pid, "41000000" + text * 65))
