"""The differences between wire formats, as data."""

from __future__ import annotations

from dataclasses import dataclass

from firm_hdl.model import Wire

__all__ = ["WireRules"]


@dataclass(frozen=True, slots=True, kw_only=True)
class WireRules:
    """Rules of a wire format.

    Attributes
    ----------
    wire : Wire
    encapsulation : bytes
        Representation identifier at the start of every packet; empty if the format has none. A
        packet that starts with other bytes is an error.
    option_bytes : int
        Number of bytes after the identifier that a receiver ignores and a sender sets to zero.
    max_align : int
        A primitive of n bytes starts at a multiple of min(n, max_align) bytes, counted from the end
        of the encapsulation header.
    terminated : bool
        Whether a string ends in a NUL, which its length on the wire counts.
    empty_member : str or None
        Name of the uint8 that represents a message without fields; `None`: such a message has no
        bytes.
    max_trailing_bytes : int
        Largest number of bytes that may follow a message in its packet.
    """

    wire: Wire
    encapsulation: bytes
    option_bytes: int
    max_align: int
    terminated: bool
    empty_member: str | None
    max_trailing_bytes: int

    @property
    def header_bytes(self) -> int:
        """Bytes of the encapsulation header; alignment counts from its end."""
        return len(self.encapsulation) + self.option_bytes
