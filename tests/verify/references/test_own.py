"""Our own converters as a client library: what they refuse, and with which settings."""

from __future__ import annotations

import pytest

from firm_hdl.verify.references.client import Refusal
from firm_hdl.verify.references.libraries import FirmHdl


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
