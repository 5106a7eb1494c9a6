"""A second COBS, byte by byte after the description of the article: the oracle of the first."""

from __future__ import annotations

__all__ = ["decode", "encode"]


def encode(data: bytes) -> bytes:
    """Stuff bytes: each 0 becomes the distance to the next one."""
    out = bytearray([0])
    code_at = 0
    for byte in data:
        if byte:
            out.append(byte)
        if byte == 0 or len(out) - code_at == 255:
            out[code_at] = len(out) - code_at
            code_at = len(out)
            out.append(0)
    out[code_at] = len(out) - code_at
    return bytes(out)


def decode(data: bytes) -> bytes:
    """Undo `encode`."""
    out, at = bytearray(), 0
    while at < len(data):
        code = data[at]
        out += data[at + 1 : at + code]
        at += code
        if code < 255 and at < len(data):
            out.append(0)
    return bytes(out)
