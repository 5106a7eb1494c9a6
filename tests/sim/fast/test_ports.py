# amaranth: UnusedElaboratable=no
"""The ports of a component: names, directions, widths, and values to bits and back."""

from __future__ import annotations

import pytest
from amaranth.hdl import Const, signed, unsigned
from amaranth.lib import data, enum, stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl import PacketSignature
from firm_hdl.sim.fast.ports import Ports, ports_of


class Color(enum.Enum, shape=unsigned(3)):
    """A shape with names."""

    NONE = 0
    RED = 1
    BLUE = 4


PAIR = data.StructLayout({"low": 4, "high": 6})


def ports(members) -> Ports:
    return ports_of(wiring.Component(members))


def beats(**changes) -> data.StructLayout:
    """Return the payload of a packet stream with lanes of 4 bytes, with changed members."""
    whole = {"data": data.ArrayLayout(8, 4), "count": 3, "last": 1}
    return data.StructLayout(whole | changes)


@pytest.mark.parametrize(
    ("shape", "bus_bytes"),
    [
        (PacketSignature(1).members["payload"].shape, 1),
        (PacketSignature(64).members["payload"].shape, 64),
        (beats(), 4),
        (beats(data=data.ArrayLayout(unsigned(8), 5)), 5),
        # Lanes that are no bytes, or no lanes at all.
        (beats(data=data.ArrayLayout(7, 4)), 0),
        (beats(data=data.ArrayLayout(16, 4)), 0),
        (beats(data=32), 0),
        (beats(data=data.StructLayout({"a": 16, "b": 16})), 0),
        # A count that is too narrow or too wide, and a flag of two bits.
        (beats(count=2), 0),
        (beats(count=4), 0),
        (beats(data=data.ArrayLayout(8, 8)), 0),
        (beats(last=2), 0),
        (beats(user=1), 0),
        (data.StructLayout({"data": data.ArrayLayout(8, 4), "last": 1, "count": 3}), 0),
        (data.UnionLayout({"data": data.ArrayLayout(8, 4), "count": 3, "last": 1}), 0),
        (36, 0),
    ],
)
def test_only_beats_of_bytes_are_packets(shape, bus_bytes):
    (port,) = ports({"o": Out(stream.Signature(shape))}).streams
    assert port.bus_bytes == bus_bytes
    assert port.last_bit == (port.width - 1 if bus_bytes else None)


def test_a_stream_without_a_handshake_is_found_by_its_constants():
    always = {"always_ready": True, "always_valid": True}
    (port,) = ports({"o": Out(stream.Signature(8, **always))}).streams
    assert port.is_always_ready
    (port,) = ports({"o": Out(stream.Signature(8, always_valid=True))}).streams
    assert not port.is_always_ready
    with pytest.raises(ValueError, match=r"^Stream 'i' is an input that is always valid$"):
        ports({"i": In(stream.Signature(8, **always))})
    (port,) = ports({"i": In(stream.Signature(8, always_ready=True))}).streams
    assert port.is_always_ready and port.is_input


@pytest.mark.parametrize(
    ("shape", "value", "bits"),
    [
        (unsigned(5), 31, 31),
        # As in Amaranth, a negative number has the bits of its two's complement.
        (unsigned(5), -16, 16),
        (unsigned(5), True, 1),
        (Color, Color.BLUE, 4),
        (PAIR, {"low": 3, "high": 0x21}, 0x213),
        (PAIR, 0x3FF, 0x3FF),
        (data.ArrayLayout(4, 3), [1, 2, 15], 0xF21),
        (unsigned(4), Const(9, 4), 9),
    ],
)
def test_values_as_bits(shape, value, bits):
    found = ports({"p": In(shape), "s": In(stream.Signature(shape))})
    assert found.plain[0].bits(value) == found.streams[0].bits(value) == bits


@pytest.mark.parametrize(
    ("shape", "bits", "value"),
    [
        (unsigned(4), 8, 8),
        (signed(4), 7, 7),
        (signed(4), 8, -8),
        (signed(4), 15, -1),
        (signed(1), 1, -1),
        (Color, 4, Color.BLUE),
        (range(10), 9, 9),
        (range(-8, 8), 9, -7),
    ],
)
def test_bits_as_values(shape, bits, value):
    found = ports({"p": Out(shape), "s": Out(stream.Signature(shape))})
    assert found.plain[0].view(bits) == found.streams[0].view(bits) == value


def test_a_name_that_is_wrong_is_told_with_those_that_there_are():
    found = ports(
        {"i": In(stream.Signature(8)), "o": Out(PacketSignature(2)), "x": In(1), "y": Out(1)}
    )
    assert found.stream("i").number == 0 and found.stream("o", is_packets=True).number == 1
    for call, message in [
        (lambda: found.stream("z"), "There is no stream 'z'; there are 'i', 'o'"),
        (lambda: found.stream("o", is_input=True), "There is no input stream 'o'; there are 'i'"),
        (lambda: found.stream("i", is_input=False), "There is no output stream 'i'; there are 'o'"),
        (lambda: found.stream("i", is_packets=True), "Stream 'i' does not carry packets"),
        (
            lambda: found.plain_port("y", is_input=True),
            "There is no plain input 'y'; there are 'x'",
        ),
        (lambda: found.plain_port("x", is_input=False), "no plain output 'x'; there are 'y'"),
        (lambda: ports({}).stream("o"), "There is no stream 'o'; there is none"),
        (lambda: ports({"x": In(1)}).plain_port("x", is_input=False), "'x'; there is none"),
    ]:
        with pytest.raises(ValueError, match=rf"{message}$"):
            call()
