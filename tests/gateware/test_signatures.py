# amaranth: UnusedElaboratable=no
"""Signatures of messages: their arguments, and which of them are equal."""

from __future__ import annotations

from typing import Any, get_type_hints

import pytest
from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl import (
    AxiStreamToPackets,
    Deserializer,
    GateStatusSignature,
    MessageSignature,
    PacketArbiter,
    PacketCrossing,
    PacketFifo,
    PacketGate,
    PacketRouter,
    PacketsToAxiStream,
    PacketWidth,
    Parser,
    RecordReader,
    RecordWriter,
    Serializer,
    StatusSignature,
)
from firm_hdl.accelerator import Fixed, FixedToFloat, FloatToFixed, Fork
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


@pytest.mark.parametrize("signature", [StatusSignature, GateStatusSignature])
def test_a_signature_without_parameters_is_called_like_others_or_used_as_it_is(signature):
    class Old(wiring.Component):
        def __init__(self):
            super().__init__({"status": Out(signature)})

    class New(wiring.Component):
        def __init__(self):
            super().__init__({"status": In(signature())})

    old, new = Old(), New()
    wiring.connect(Module(), old.status, new.status)
    assert old.status.payload.shape() == new.status.payload.shape()


PARTS = {
    Deserializer: lambda: Deserializer(POINT),
    Serializer: lambda: Serializer(POINT),
    Parser: lambda: Parser(POINT),
    RecordReader: lambda: RecordReader(POINT, fields=["x"]),
    RecordWriter: lambda: RecordWriter(POINT, fields=["x"]),
    PacketFifo: lambda: PacketFifo(8, 64, 2, side_bits=1),
    PacketGate: lambda: PacketGate(POINT, side_bits=1),
    PacketWidth: lambda: PacketWidth(8, 4, side_bits=1),
    PacketCrossing: lambda: PacketCrossing(8, side_bits=1),
    PacketArbiter: lambda: PacketArbiter(8, 2, side_bits=1),
    PacketRouter: lambda: PacketRouter(8, 2, side_bits=1),
    AxiStreamToPackets: lambda: AxiStreamToPackets(8, side_bits=1, dest_bits=1),
    PacketsToAxiStream: lambda: PacketsToAxiStream(8, side_bits=1, dest_bits=1),
    Fork: lambda: Fork(8, 2),
    FloatToFixed: lambda: FloatToFixed(32, Fixed(16, 8)),
    FixedToFloat: lambda: FixedToFloat(Fixed(16, 8), 32),
}


@pytest.mark.parametrize("kind", PARTS)
def test_each_member_of_a_component_has_a_type_for_editors(kind):
    types = get_type_hints(kind)
    for name, member in PARTS[kind]().signature.members.items():
        if member.is_signature and name != "axis":
            assert types[name] is not Any, name
        assert name in types
