"""Random types and values: plans run in Python, compared with rosbags and with the contract."""

from __future__ import annotations

import struct
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from firm_hdl.model import Message
from firm_hdl.plan import Plan, build_plan, check, decode, encode
from firm_hdl.sim.values import from_transfers, to_transfers
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.plan.reference import Reference
from tests.strategies import (
    BUS_WIDTHS,
    Definition,
    definitions,
    make,
    on_every_bus,
    to_rosbags,
    values,
)

slow = settings(
    max_examples=by_depth(15, 100),
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
WIRES = ("ros1", "cdr")


def plan_of(message: Message, wire: Any, bus_bytes: int, **options: int) -> Plan:
    return build_plan(lay_out(message, wire), bus_bytes=bus_bytes, **options)


def serialize(definition: Definition, value: dict[str, Any], wire: str) -> tuple[Any, bytes]:
    """Return the value as rosbags reads it back from its own bytes, and those bytes."""
    store = definition.store()
    name = definition.rosbags_name
    message = to_rosbags(store, definition.message, value)
    if wire == "ros1":
        packet = bytes(store.serialize_ros1(message, name))
        return store.deserialize_ros1(packet, name), packet
    packet = bytes(store.serialize_cdr(message, name))
    return store.deserialize_cdr(packet, name), packet


@st.composite
def typed_values(draw: st.DrawFn, *, wide: bool = False) -> tuple[Definition, dict[str, Any]]:
    definition = draw(definitions(wide=wide))
    return definition, draw(values(definition.message))


def named(plan: Plan, packet: bytes) -> tuple[list[Any], str]:
    decoded = decode(plan, packet)
    transfers = [(str(plan.leaves[leaf]), payload) for leaf, payload in decoded.transfers]
    return transfers, decoded.status


@pytest.mark.parametrize("wire", WIRES)
@slow
@given(case=typed_values(), bus_bytes=st.sampled_from(BUS_WIDTHS))
def test_bytes_and_leaves_are_those_of_rosbags(wire, case, bus_bytes):
    definition, value = case
    decoded_by_rosbags, packet = serialize(definition, value, wire)
    plan = plan_of(definition.message, wire, bus_bytes)
    want = to_transfers(plan, definition.message, decoded_by_rosbags)
    assert to_transfers(plan, definition.message, value) == want
    assert encode(plan, want) == (packet, "OK")
    got = decode(plan, packet)
    assert got.status == "OK"
    assert got.streams == {leaf: payloads for leaf, payloads in want.items() if payloads}


@pytest.mark.parametrize("wire", WIRES)
@slow
@given(case=typed_values(wide=True), bus_bytes=st.sampled_from(BUS_WIDTHS))
def test_values_survive_the_way_to_bytes_and_back(wire, case, bus_bytes):
    definition, value = case
    plan = plan_of(definition.message, wire, bus_bytes)
    want = to_transfers(plan, definition.message, value)
    packet, status = encode(plan, want)
    assert status == "OK"
    decoded = decode(plan, packet)
    assert decoded.status == "OK"
    again = from_transfers(plan, definition.message, decoded.streams)
    plain = to_transfers(plan, definition.message, again)
    # Through Python floats, so that NaNs may differ; everything else is equal bit by bit.
    for leaf, payloads in plain.items():
        if plan.leaves[leaf].type not in ("float32", "float64"):
            assert payloads == want[leaf]


@pytest.mark.parametrize("wire", WIRES)
@slow
@given(case=typed_values(wide=True), data=st.data())
def test_any_packet_decodes_as_the_contract_says_on_every_bus(wire, case, data):
    definition, value = case
    layout = lay_out(definition.message, wire)
    plans = [
        build_plan(layout, bus_bytes=width, max_message_bytes=layout.least_bytes + 700)
        for width in BUS_WIDTHS
    ]
    packet = encode(plans[3], to_transfers(plans[3], definition.message, value))[0]
    packet = data.draw(damaged(packet), label="packet")
    for plan in plans:
        reference = Reference(plan, definition.message, packet)
        assert named(plan, packet) == (reference.transfers, reference.status)


@on_every_bus
@pytest.mark.parametrize(("letters", "status"), [(600, "LENGTH"), (300, "TRUNCATED")])
def test_nested_lengths_share_a_budget_as_the_contract_says(letters, status, bus_bytes):
    element = make("ros1", {"x": "uint32", "s": "string"}, "Element")
    message = make("ros1", {"e": (element, "[]")})
    # Of 700 bytes, 40 elements claim 320.
    plan = plan_of(message, "ros1", bus_bytes, max_message_bytes=4 + 700)
    packet = struct.pack("<III", 40, 0, letters)
    reference = Reference(plan, message, packet)
    assert reference.status == status
    assert named(plan, packet) == (reference.transfers, status)


@st.composite
def damaged(draw: st.DrawFn, packet: bytes) -> bytes:
    """Return packets: cut, lengthened, with some bytes changed, or unchanged."""
    how = draw(st.sampled_from(["cut", "longer", "changed", "both", "whole"]))
    result = bytearray(packet)
    if how in ("changed", "both") and result:
        for _ in range(draw(st.integers(1, 3))):
            at = draw(st.integers(0, len(result) - 1))
            result[at] = draw(st.sampled_from([0, 1, 2, 5, 255]) | st.integers(0, 255))
    if how in ("cut", "both"):
        del result[draw(st.integers(0, len(result))) :]
    if how == "longer":
        result += draw(st.binary(min_size=1, max_size=5))
    return bytes(result)


@pytest.mark.sampled(2)
@pytest.mark.parametrize("wire", WIRES)
@slow
@given(case=typed_values(wide=True), bus_bytes=st.sampled_from(BUS_WIDTHS))
def test_every_prefix_of_a_packet_is_truncated(wire, case, bus_bytes):
    definition, value = case
    plan = plan_of(definition.message, wire, bus_bytes)
    streams = to_transfers(plan, definition.message, value)
    packet = encode(plan, streams)[0]
    for size in range(max(0, len(packet) - 40), len(packet)):
        assert decode(plan, packet[:size]).status == "TRUNCATED"


@pytest.mark.parametrize("wire", WIRES)
@slow
@given(definition=definitions(wide=True), bus_bytes=st.sampled_from(BUS_WIDTHS))
def test_plans_are_sound(wire, definition, bus_bytes):
    layout = lay_out(definition.message, wire)
    plan = build_plan(layout, bus_bytes=bus_bytes)
    assert check(plan, layout) == []
