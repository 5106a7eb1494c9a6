# amaranth: UnusedElaboratable=no
"""The ports of a component: names, directions, widths, and values to bits and back."""

from __future__ import annotations

import pytest
from amaranth.hdl import Const, signed, unsigned
from amaranth.lib import data, enum, stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl import PacketSignature
from firm_hdl.sim.fast.ports import Ports, bytes_of, ports_of


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


def test_members_in_any_nesting_have_a_direction_and_a_number():
    one = {"go": Out(1, init=1), "back": In(5)}
    inner = wiring.Signature(one | {"s": Out(stream.Signature(9)).array(2)})
    # Amaranth cannot turn arrays of streams.
    other = wiring.Signature(one | {"s": Out(stream.Signature(9)), "t": In(stream.Signature(9))})
    found = ports(
        {
            "first": In(stream.Signature(8)),
            "plain": Out(3),
            "seen": Out(inner).array(1, 2),
            "turned": In(other),
        }
    )
    assert [(each.number, each.name, each.is_input) for each in found.streams] == [
        (0, "first", True),
        (1, "seen.0.0.s.0", False),
        (2, "seen.0.0.s.1", False),
        (3, "seen.0.1.s.0", False),
        (4, "seen.0.1.s.1", False),
        (5, "turned.s", True),
        (6, "turned.t", False),
    ]
    assert [each.name for each in found.outputs] == [
        *("plain", "seen.0.0.go", "seen.0.1.go", "turned.back")
    ]
    assert [(each.name, each.init) for each in found.inputs] == [
        *(("seen.0.0.back", None), ("seen.0.1.back", None), ("turned.go", 1))
    ]
    assert found.plain_port("turned.go", is_input=True)[0] == 2
    assert found.plain_port("turned.back", is_input=False)[0] == 3
    # Each is a stream of its own.
    assert len({id(each.port) for each in found.streams}) == 7


def test_a_signature_that_was_turned_before_has_the_other_direction():
    turned = stream.Signature(8).flip()
    found = ports({"sent": Out(turned), "received": In(turned)})
    assert [(each.name, each.is_input) for each in found.streams] == [
        *(("sent", True), ("received", False))
    ]


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
    ("bits", "expected"), [(0, 1), (1, 1), (8, 1), (9, 2), (16, 2), (17, 3), (100, 13)]
)
def test_a_value_has_whole_bytes_and_at_least_one(bits, expected):
    assert bytes_of(bits) == expected
    found = ports({"p": Out(bits), "s": Out(stream.Signature(bits))})
    assert found.plain[0].bytes == found.streams[0].bytes == expected


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


@pytest.mark.parametrize(("width", "value"), [(5, 32), (5, -17), (1, 2), (1, -2), (0, 1)])
def test_numbers_that_do_not_fit_are_refused(width, value):
    found = ports({"p": In(width), "s": In(stream.Signature(width))})
    for port in (found.plain[0], found.streams[0]):
        with pytest.raises(ValueError, match=rf"^'{port.name}' has {width} bits, too few for"):
            port.bits(value)


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


def test_bits_of_a_layout_have_its_members():
    found = ports({"p": Out(PAIR), "s": Out(stream.Signature(PAIR))})
    for port in (found.plain[0], found.streams[0]):
        view = port.view(0x213)
        assert (view.low, view.high) == (3, 0x21)


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


def test_what_is_no_component_has_no_ports():
    with pytest.raises(TypeError, match=r"must be a component of amaranth\.lib\.wiring, not 5$"):
        ports_of(5)
