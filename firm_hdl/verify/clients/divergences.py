"""The differences between client libraries and ROS's own serializers that are known.

docs/divergences.md explains each, by its key.
"""

from __future__ import annotations

from typing import Any

from firm_hdl.model import FieldType, Message, Primitive, String
from firm_hdl.verify.clients.finding import Change, KnownDivergence
from firm_hdl.verify.references.values import Plain, is_nan

__all__ = ["KNOWN"]

# What is done to values.


def _quiet(kind: FieldType, value: Plain) -> Plain:
    if isinstance(kind, Primitive) and kind.kind == "float" and kind.bytes == 4:
        return value | 1 << 22 if is_nan(value, 4) else value
    return value


def _number(name: str, mask: int) -> Change:
    def change(kind: FieldType, value: Plain) -> Plain:
        is_meant = isinstance(kind, Primitive) and kind.name == name and not kind.signed
        return value & mask if is_meant else value

    return change


def _same_times(kind: FieldType, value: Plain) -> Plain:
    """Give times the signs that ROS 1 has for them."""
    if isinstance(kind, Message) and kind.name == "time":
        return {**value, "secs": value["secs"] & 0xFFFFFFFF}
    if isinstance(kind, Message):
        nsecs = value["nsecs"] & 0xFFFFFFFF
        return {**value, "nsecs": (nsecs ^ 1 << 31) - (1 << 31)}
    return value


def _tame_times(kind: FieldType, value: Plain) -> Plain:
    if isinstance(kind, Message):
        member = "secs" if kind.name == "time" else "nsecs"
        return {**value, member: value[member] & 0x7FFFFFFF}
    return value


def _canonical(kind: FieldType, value: Plain) -> Plain:
    if isinstance(kind, Message):
        more, nsecs = divmod(value["nsecs"], 1_000_000_000)
        # What is carried over may be more than a time's seconds have room for.
        mask = 0xFFFFFFFF if kind.name == "time" else -1
        return {"secs": value["secs"] + more & mask, "nsecs": nsecs}
    return value


def _cut(kind: FieldType, value: Plain) -> Plain:
    if isinstance(kind, String) and kind.wide:
        return value[: value.index(0)] if 0 in value else value
    return value.partition(b"\0")[0] if isinstance(kind, String) else value


def _replaced(kind: FieldType, value: Plain) -> Plain:
    if isinstance(kind, String) and not kind.wide:
        return value.decode("utf-8", "replace").encode()
    return value


_GENPY = ("genpy", "mcap-ros1")
_PYTHON = ("rosbags", "cyclonedds", "mcap-ros2", *_GENPY)
_FAST_CDR = ("fastcdr", "fastcdr-2.2", "fastcdr-2.3")
_CUTS = ("cut-1", "cut-half", "cut-all", "long-text", "long-items")


def _entry(
    key: str, libraries: str | tuple[str, ...], wires: str, text: str, **more: Any
) -> KnownDivergence:
    names = (libraries,) if isinstance(libraries, str) else libraries
    return KnownDivergence(key=key, libraries=names, wires=wires, text=text, **more)


KNOWN: tuple[KnownDivergence, ...] = (
    # What they make of values.
    _entry(
        "python-signalling-nan",
        _PYTHON,
        "ros1 cdr",
        "A signalling NaN of 4 bytes becomes a quiet one, as any Python float.",
        take_out=_quiet,
        same=_quiet,
    ),
    _entry(
        "python-not-utf8",
        ("rosbags", "cyclonedds", "mcap-ros2"),
        "ros1 cdr",
        "A string that is not UTF-8 is refused.",
        whats=("not-utf8", "encode not-utf8"),
        answer="refuses",
    ),
    _entry(
        "rosbags-byte-signed",
        "rosbags",
        "cdr",
        "A byte is -128 to 127; in ROS 2 it is 0 to 255.",
        take_out=_number("byte", 0x7F),
        same=_number("byte", 0xFF),
    ),
    _entry(
        "rosbags-time-signs",
        "rosbags",
        "ros1 cdr",
        "Seconds of a ROS 1 time are signed, nanoseconds of a duration are not; in ROS 1 it is the "
        "other way round.",
        take_out=_tame_times,
        same=_same_times,
    ),
    _entry(
        "mcap-ros2-char-signed",
        "mcap-ros2",
        "cdr",
        "A char is -128 to 127; in ROS 2 it is 0 to 255.",
        take_out=_number("char", 0x7F),
        same=_number("char", 0xFF),
    ),
    _entry(
        "fastcdr-cut-at-nul",
        ("fastcdr", "fastcdr-2.2"),
        "cdr",
        "A string and a wstring are written up to the first NUL.",
        take_out=_cut,
    ),
    _entry(
        "fastcdr-no-nul-inside",
        "fastcdr-2.3",
        "cdr",
        "A string with a NUL inside cannot be written.",
        whats=("encode nul-inside",),
        answer="refuses",
    ),
    _entry(
        "fastcdr-wide-characters",
        "fastcdr",
        "cdr",
        "Of the four bytes of a wchar, two are read.",
        same=_number("wchar", 0xFFFF),
    ),
    _entry(
        "fastcdr-options",
        "fastcdr-2.3",
        "cdr",
        "A packet has as many bytes less as the last two bits of its options say.",
        whats=("options",),
        answer="refuses",
    ),
    _entry(
        "fastcdr-bools",
        _FAST_CDR,
        "cdr",
        "In a sequence without a bound, a bool that is neither 0 nor 1 is refused.",
        whats=("bool-2",),
        answer="refuses",
    ),
    _entry(
        "fastcdr-bool-arrays",
        _FAST_CDR,
        "cdr",
        "In an array, a bool that is neither 0 nor 1 is not read.",
        whats=("bool-2",),
    ),
    _entry(
        "genpy-time-normalized",
        _GENPY,
        "ros1",
        "Nanoseconds of a second and more are carried over when a time is read.",
        same=_canonical,
    ),
    _entry(
        "genpy-not-utf8",
        _GENPY,
        "ros1",
        "What is not UTF-8 in a string is read as U+FFFD.",
        same=_replaced,
    ),
    _entry(
        "genpy-not-utf8-written",
        _GENPY,
        "ros1",
        "A string that is not UTF-8 cannot be written.",
        whats=("encode not-utf8",),
        answer="refuses",
    ),
    # Packets that are not as they are to be.
    _entry(
        "genpy-cut",
        _GENPY,
        "ros1",
        "A string or an array of bytes at the end of a packet may be cut short.",
        whats=_CUTS,
        answer="takes",
    ),
    _entry(
        "genpy-trailing",
        _GENPY,
        "ros1",
        "What follows a message is ignored.",
        whats=("trailing-1", "trailing-4"),
        answer="takes",
    ),
    _entry(
        "rosbags-bare-string",
        "rosbags",
        "cdr",
        "An empty string whose length is 0 is refused.",
        whats=("bare-string",),
        answer="refuses",
    ),
    _entry(
        "rosbags-no-nul",
        "rosbags",
        "cdr",
        "A string without a NUL is refused.",
        whats=("no-nul",),
        answer="refuses",
    ),
    _entry(
        "rosbags-trailing",
        "rosbags",
        "cdr",
        "More than 3 bytes behind a message are refused.",
        whats=("trailing-4",),
        answer="refuses",
    ),
    _entry(
        "rosbags-bounds",
        "rosbags",
        "cdr",
        "Bounds of sequences are not checked.",
        whats=("bound-items", "encode bound-items"),
        answer="takes",
    ),
    _entry(
        "cyclonedds-no-nul",
        "cyclonedds",
        "cdr",
        "A string without a NUL loses its last byte.",
        whats=("no-nul",),
    ),
    _entry(
        "cyclonedds-cut",
        "cyclonedds",
        "cdr",
        "No packet at all, and one that ends in an array of bytes, is read as far as it goes.",
        whats=_CUTS,
        answer="takes",
    ),
    _entry(
        "cyclonedds-bounds",
        "cyclonedds",
        "cdr",
        "Bounds of sequences are not checked when a packet is read.",
        whats=("bound-items",),
        answer="takes",
    ),
    _entry(
        "cyclonedds-text-bounds",
        "cyclonedds",
        "cdr",
        "A string that is longer than its bound is not written.",
        whats=("encode bound-text",),
        answer="refuses",
    ),
    _entry(
        "mcap-ros2-no-nul",
        "mcap-ros2",
        "cdr",
        "A string without a NUL loses its last byte.",
        whats=("no-nul",),
    ),
    _entry(
        "mcap-ros2-cut",
        "mcap-ros2",
        "cdr",
        "A string or an array of bytes is read as far as the packet goes.",
        whats=_CUTS,
        answer="takes",
    ),
    _entry(
        "mcap-ros2-bounds",
        "mcap-ros2",
        "cdr",
        "Bounds of sequences are not checked in packets; what exceeds them is not written.",
        whats=("bound-items", "encode bound-items"),
        answer="takes",
    ),
    _entry(
        "firm-hdl-no-nul",
        "firm-hdl",
        "cdr",
        "A string without a NUL is refused.",
        whats=("no-nul",),
        answer="refuses",
    ),
    _entry(
        "firm-hdl-trailing",
        "firm-hdl",
        "cdr",
        "More than 3 bytes behind a message are refused.",
        whats=("trailing-4",),
        answer="refuses",
    ),
    _entry(
        "firm-hdl-bounds",
        "firm-hdl",
        "cdr",
        "Bounds of strings are checked as those of sequences are.",
        whats=("bound-text", "encode bound-text"),
        answer="refuses",
    ),
)
