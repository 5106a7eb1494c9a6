# amaranth: UnusedElaboratable=no
"""Signatures of messages: their arguments, and which of them are equal."""

from __future__ import annotations

import pytest
from amaranth.lib import wiring

from firm_hdl import Deserializer, MessageSignature, Serializer
from tests.strategies import make

POINT = make("ros2", {"x": "float64", "names": "string[]"}, "Point")
EMPTY = make("ros2", {}, "Empty")


def test_signature_has_and_prints_its_arguments():
    signature = MessageSignature(POINT)
    assert (signature.message, signature.bus_bytes, signature.wire) == (POINT, 8, "cdr")
    assert repr(signature) == f"MessageSignature({POINT.name}, bus_bytes=8, wire='cdr')"


@pytest.mark.parametrize("component", [Deserializer, Serializer])
@pytest.mark.parametrize("options", [{}, {"bus_bytes": 2}, {"wire": "ros1"}])
def test_a_converter_has_the_signature_of_the_same_arguments(component, options):
    found = component(POINT, **options).message.signature
    found = found.flip() if component is Serializer else found
    expected = MessageSignature(POINT, **options)
    assert found == expected
    assert hash(found) == hash(expected)
    assert found.members == expected.members


def test_signatures_differ_with_each_argument():
    signatures = [
        MessageSignature(POINT),
        MessageSignature(POINT, 4),
        MessageSignature(POINT, wire="ros1"),
        MessageSignature(EMPTY),
        MessageSignature(POINT).flip(),
        wiring.Signature(MessageSignature(POINT).members),
    ]
    for index, one in enumerate(signatures):
        for other in signatures[index + 1 : -1]:
            assert one != other
    assert signatures[0] != signatures[-1]
    assert signatures[0].flip() == MessageSignature(POINT).flip()


def test_the_wire_decides_what_an_empty_message_is():
    assert list(MessageSignature(EMPTY).members) == ["structure_needs_at_least_one_member"]
    assert list(MessageSignature(EMPTY, wire="ros1").members) == ["trigger"]
