# amaranth: UnusedElaboratable=no
"""What circuits around the parts rely on: the codes on the wires, and the parameters not given."""

from __future__ import annotations

import pytest

from firm_hdl import (
    Deserializer,
    GateStatus,
    PacketArbiter,
    PacketCrossing,
    PacketFifo,
    PacketGate,
    PacketRouter,
    Parser,
    RecordReader,
    RecordWriter,
    Serializer,
    Status,
    load_message,
)
from firm_hdl.gateware.packets import Outcome

# docs/reference/parts.md; software and other circuits read these numbers.
ERRORS = {"OK": 0, "TRUNCATED": 1, "TRAILING": 2, "LENGTH": 3, "ENCAPSULATION": 4, "STRING": 5}


@pytest.mark.parametrize(
    ("kind", "codes"),
    [
        (Status, ERRORS | {"ITEMS": 6}),
        (GateStatus, ERRORS | {"FULL": 8, "LARGE": 9, "OVERRUN": 10}),
        (Outcome, {"KEPT": 0, "ABORTED": 1, "FULL": 2, "LARGE": 3}),
    ],
)
def test_codes_are_those_of_the_documentation(kind, codes):
    assert {each.name: each.value for each in kind} == codes


def test_a_gate_by_default():
    gate = PacketGate(load_message("std_msgs/msg/Bool"))
    assert (gate.bus_bytes, gate.when_full) == (8, "wait")
    assert (gate.shape.memory_bytes, gate.shape.packets) == (65_536, 64)
    assert (gate.plan.wire, gate.plan.max_message_bytes) == ("cdr", 1 << 24)


def test_converters_by_default():
    message = load_message("std_msgs/msg/Bool")
    for kind in (Deserializer, Serializer, Parser):
        plan = kind(message).plan
        assert (plan.wire, plan.bus_bytes, plan.max_message_bytes) == ("cdr", 8, 1 << 24)
    assert RecordReader(message).plan.bus_bytes == RecordWriter(message).plan.bus_bytes == 8


def test_a_crossing_by_default():
    crossing = PacketCrossing(4)
    assert crossing.beats == 16
    assert (crossing.write_domain, crossing.read_domain) == ("write", "read")


def test_other_parts_by_default():
    assert PacketFifo(4, 64, 1).when_full == "wait"
    assert len(PacketRouter(4, 2).topic) == 16
    for part in (PacketRouter(4, 2), PacketArbiter(4, 2)):
        assert not {name for name in part.signature.members if name.startswith("side")}
