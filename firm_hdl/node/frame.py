"""The frame between a node and its host, as data, and the host's side of its header.

Host and gateware are both made from `HEADER`; neither has an offset of its own. All links carry the
same frame: 16 bytes of header, then bytes of a message. What lies around it is the link's business.
Numbers are little-endian. ``docs/reference/frame.md`` has the rules for senders and receivers.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import accumulate

__all__ = [
    "FLAG_LAST",
    "FLAG_START",
    "FRAGMENT_UNIT",
    "HEADER",
    "HEADER_BYTES",
    "LATE_MESSAGES",
    "VERSION",
    "FrameError",
    "Header",
    "decode_header",
    "encode_header",
]


@dataclass(frozen=True, slots=True, kw_only=True)
class HeaderField:
    """A field of the header."""

    name: str
    bytes: int  # Size; the fields follow each other without gaps.
    meaning: str  # Description for people, in Markdown.


VERSION = 0xF1
"""``0xF0`` plus the version of the frame, so that most foreign bytes are no header."""

FLAG_LAST = 1 << 0
"""The frame is the last one of its message."""

FLAG_START = 1 << 1
"""The sender has started: the sequence begins with this message, so nothing before it is lost."""

LATE_MESSAGES = 64
"""A message is late if its number is at most so many before the next one that is expected. A
number that is further away is believed when the next one follows."""

FRAGMENT_UNIT = 16
"""All fragments but the last one of a message have a multiple of so many bytes, so that they fill
whole beats on every bus of a node."""

HEADER: tuple[HeaderField, ...] = (
    HeaderField(name="version", bytes=1, meaning=f"`{VERSION:#04x}`. Other frames are dropped."),
    HeaderField(
        name="flags",
        bytes=1,
        meaning="Bit 0: the frame is the last one of its message. Bit 1: the sender has started, "
        "and its sequence begins here. Other bits are sent as 0 and ignored.",
    ),
    HeaderField(name="topic", bytes=2, meaning="Id of the topic; 0 is control."),
    HeaderField(
        name="length", bytes=4, meaning="Bytes of the whole message, the same in all its frames."
    ),
    HeaderField(
        name="tag",
        bytes=4,
        meaning="Of a request: any number. Its response has the same one. Else 0.",
    ),
    HeaderField(
        name="sequence",
        bytes=2,
        meaning="Number of the message, from one to the next by 1, whatever the topic. Each "
        "direction counts for itself.",
    ),
    HeaderField(name="fragment", bytes=2, meaning="Number of the frame in its message, from 0."),
)
"""The header, in the order of its bytes."""

HEADER_BYTES = sum(each.bytes for each in HEADER)

_OFFSETS = dict(
    zip(
        (each.name for each in HEADER),
        accumulate((each.bytes for each in HEADER), initial=0),
        strict=False,
    )
)


class FrameError(ValueError):
    """Bytes are no frame; the text says why."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Header:
    """A header. Its attributes are the fields of `HEADER`, with the flags one by one."""

    topic: int
    length: int
    tag: int = 0
    sequence: int = 0
    fragment: int = 0
    last: bool = True
    start: bool = False


def encode_header(header: Header) -> bytes:
    """Write a header.

    Raises `ValueError` if a number does not fit into its field.
    """
    flags = FLAG_LAST * header.last | FLAG_START * header.start
    parts = []
    for each in HEADER:
        value = {"version": VERSION, "flags": flags}.get(each.name)
        if value is None:
            value = getattr(header, each.name)
        if not 0 <= value < 1 << 8 * each.bytes:
            raise ValueError(f"{each.name} must fit into {each.bytes} bytes, not {value!r}")
        parts.append(value.to_bytes(each.bytes, "little"))
    return b"".join(parts)


def decode_header(frame: bytes) -> Header:
    """Read the header of a frame.

    Raises `FrameError` if the frame is too short, or of another version.
    """
    if len(frame) < HEADER_BYTES:
        raise FrameError(f"a frame has {HEADER_BYTES} bytes at least, not {len(frame)}")
    values = {
        each.name: int.from_bytes(
            frame[_OFFSETS[each.name] : _OFFSETS[each.name] + each.bytes], "little"
        )
        for each in HEADER
    }
    if (version := values.pop("version")) != VERSION:
        raise FrameError(f"version is {version:#04x}, not {VERSION:#04x}")
    flags = values.pop("flags")
    return Header(**values, last=bool(flags & FLAG_LAST), start=bool(flags & FLAG_START))
