"""Our own converters as a client library: what they refuse, and with which settings."""

from __future__ import annotations

import pytest

from firm_hdl.errors import DefinitionError, Diagnostic
from firm_hdl.export.build import BuildError
from firm_hdl.verify.references import own
from firm_hdl.verify.references.client import Refusal, UnsupportedError
from firm_hdl.verify.references.own import FirmHdl


@pytest.fixture
def codec_of(make_message):
    """Return a function that opens the codec of a text."""

    def codec(text, wire="cdr"):
        distro = "noetic" if wire == "ros1" else "lyrical"
        return FirmHdl().open(make_message(text, distro), wire)

    return codec


def packet(wire, count, data=b""):
    """A packet with the number of items of a list, and the first of the items."""
    return (b"\0\1\0\0" if wire == "cdr" else b"") + count.to_bytes(4, "little") + data


@pytest.mark.parametrize("wire", ["ros1", "cdr"])
def test_a_list_of_more_than_65536_bytes_is_refused_at_its_length(codec_of, wire):
    """A packet that ends too early is another mistake."""
    codec = codec_of("uint8[] a\n", wire)
    assert codec.decode(packet(wire, 2, b"\1\2")) == {"a": [1, 2]}
    for count, status in ((600, "TRUNCATED"), (65_537, "LENGTH"), (1 << 31, "LENGTH")):
        with pytest.raises(Refusal, match=f"^status {status}$"):
            codec.decode(packet(wire, count, b"\1\2"))
    with pytest.raises(Refusal, match=r"^status TRAILING$"):
        codec.decode(packet(wire, 1, b"\1" + bytes(9)))


def test_values_that_break_a_bound_are_refused_by_the_circuit(codec_of):
    codec = codec_of("uint8[<=2] a\n")
    assert codec.encode({"a": [1, 2]}) == packet("cdr", 2, b"\1\2")
    with pytest.raises(Refusal, match=r"^status LENGTH$"):
        codec.encode({"a": [1, 2, 3]})
    # The next value is not affected.
    assert codec.encode({"a": [3]}) == packet("cdr", 1, b"\3")
    assert codec.decode(packet("cdr", 1, b"\4")) == {"a": [4]}


@pytest.mark.parametrize(
    "error", [ValueError("7"), BuildError("7"), DefinitionError([Diagnostic(message="7")])]
)
def test_a_type_that_no_circuit_can_be_made_of_is_unsupported(codec_of, monkeypatch, error):
    given = []

    def fails(message, **settings):
        given.append((message.name, settings))
        raise error

    monkeypatch.setattr(own, "Deserializer", fails)
    monkeypatch.setattr(own, "Serializer", fails)
    codec = codec_of("uint8 a\n", "ros1")
    assert given == []  # The type is known to be unsupported only when it is needed.
    why = str(error)
    for ask in (lambda: codec.decode(b"\1"), lambda: codec.encode({"a": 1})):
        with pytest.raises(UnsupportedError) as caught:
            ask()
        assert str(caught.value) == f"firm-hdl cannot build it: {why}"
    settings = {"wire": "ros1", "bus_bytes": 8, "max_message_bytes": 65536}
    assert given == [("p/A", settings)] * 2
