"""The stream of datagrams between a core for UDP and what is above it."""

from __future__ import annotations

from amaranth.lib import data, stream

__all__ = ["DatagramSignature", "datagram_layout"]


def datagram_layout(data_bytes: int) -> data.StructLayout:
    """Return the payload of a stream of datagrams, with the names of LiteEth's raw UDP port.

    Members
    -------
    data : unsigned(8 * data_bytes)
        The first byte in the lowest bits.
    last : unsigned(1)
        Last word of the datagram.
    last_be : unsigned(data_bytes)
        With `last`: a single 1 at the last byte. Only sent; what comes is counted by `length`.
    error : unsigned(1)
        With `last`: the datagram is damaged. Only received. LiteEth has a bit for each byte; any of
        them counts.
    length : unsigned(16)
        Bytes of the datagram's payload; like all that follows, the same in all its words.
    ip_address : unsigned(32)
        Address of the other side; its first number in the highest bits.
    src_port, dst_port : unsigned(16)
    """
    return data.StructLayout(
        {
            "data": 8 * data_bytes,
            "last": 1,
            "last_be": data_bytes,
            "error": 1,
            "length": 16,
            "ip_address": 32,
            "src_port": 16,
            "dst_port": 16,
        }
    )


def DatagramSignature(data_bytes: int) -> stream.Signature:
    """Return a stream of datagrams. See :func:`datagram_layout`."""
    return stream.Signature(datagram_layout(data_bytes))
