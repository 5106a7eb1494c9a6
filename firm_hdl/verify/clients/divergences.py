"""The known differences between client libraries and ROS's own serializers.

docs/reference/divergences.md explains each, by its key. A difference in values is explained if the
values are equal without the parts that known divergences are about. So a known divergence hides no
other difference. If one library takes an unusual packet and the other refuses it, the case and the
library explain the difference. A difference that no entry explains is new.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, TypeGuard

from firm_hdl.cases.values import Change, Plain, changed, is_nan, packed
from firm_hdl.model import FieldType, Message, Primitive, String
from firm_hdl.verify.references.client import Codec, Refusal, UnsupportedError
from firm_hdl.verify.references.clients import client
from firm_hdl.wire import Wire

__all__ = ["KNOWN", "Finding", "KnownDivergence", "known_keys", "known_writing"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """One difference."""

    library: str
    reference: str
    wire: Wire
    # `encode`, `decode`, the name of an unusual case of a packet, or `encode` and that of a value.
    what: str
    message: Message
    value: Plain = field(repr=False)  # The value to write, or the value of the packet.
    packet: bytes = field(repr=False)  # The packet to read.
    # The answers of the reference and of the library.
    expected: Any = field(repr=False)
    got: Any = field(repr=False)

    @property
    def size(self) -> int:
        """The size of the value in bytes."""
        return len(packed(self.message, self.value))

    def answers(self, library: str) -> tuple[Any, Any]:
        """Return the answer of one of the two libraries, and the answer of the other."""
        if library == self.library:
            return self.got, self.expected
        return self.expected, self.got


@dataclass(frozen=True, slots=True, kw_only=True)
class KnownDivergence:
    """One known difference."""

    key: str  # The name of the difference, here and in docs/reference/divergences.md.
    libraries: tuple[str, ...]  # Libraries that differ from ROS.
    wires: str  # `ros1`, `cdr`, or both.
    text: str  # What the libraries do, in one sentence.
    take_out: Change | None = None  # Removes the difference from a value to write.
    same: Change | None = None  # Removes the difference from a value that was read.
    case_names: tuple[str, ...] = ()  # Unusual cases that this divergence is about.
    # What the libraries do with these cases while the other side does the opposite. `None`: both
    # sides take them.
    answer: Literal["takes", "refuses"] | None = None

    def is_about(self, finding: Finding) -> str | None:
        """Return the library of a finding that this difference is about; `None` if neither is."""
        return self.affected_library(finding.wire, finding.library, finding.reference)

    def affected_library(self, wire: Wire, *libraries: str) -> str | None:
        """Return the first library that this difference is about on a wire; `None` if none is."""
        if wire not in self.wires.split():
            return None
        return next((name for name in libraries if name in self.libraries), None)

    def explains_answer(self, finding: Finding) -> bool:
        """Whether this difference explains which side takes an unusual packet or value."""
        name = self.is_about(finding)
        if name is None or finding.what not in self.case_names:
            return False
        mine, other = (isinstance(each, Refusal) for each in finding.answers(name))
        return (mine, other) == {
            "takes": (False, True),
            "refuses": (True, False),
            None: (False, False),
        }[self.answer]


# Changes of values, for `KnownDivergence.take_out` and `KnownDivergence.same`.


def _quiet_nan(kind: FieldType, value: Plain) -> Plain:
    if isinstance(kind, Primitive) and kind.kind == "float" and kind.bytes == 4:
        return value | 1 << 22 if is_nan(value, 4) else value
    return value


def _number(name: str, mask: int) -> Change:
    def change(kind: FieldType, value: Plain) -> Plain:
        is_meant = isinstance(kind, Primitive) and kind.name == name and not kind.signed
        return value & mask if is_meant else value

    return change


def _is_time(kind: FieldType) -> TypeGuard[Message]:
    return isinstance(kind, Message) and kind.name in ("time", "duration")


def _same_times(kind: FieldType, value: Plain) -> Plain:
    """Give times the signs that ROS 1 has for them."""
    if not _is_time(kind):
        return value
    if kind.name == "time":
        return {**value, "secs": value["secs"] & 0xFFFFFFFF}
    nsecs = value["nsecs"] & 0xFFFFFFFF
    return {**value, "nsecs": (nsecs ^ 1 << 31) - (1 << 31)}


def _positive_times(kind: FieldType, value: Plain) -> Plain:
    """Clear the sign bits of members that are signed in either rosbags or ROS 1, but not both."""
    if not _is_time(kind):
        return value
    member = "secs" if kind.name == "time" else "nsecs"
    return {**value, member: value[member] & 0x7FFFFFFF}


def _canonical(kind: FieldType, value: Plain) -> Plain:
    if not _is_time(kind):
        return value
    more, nsecs = divmod(value["nsecs"], 1_000_000_000)
    # The carry may be more than the seconds of a time have room for.
    mask = 0xFFFFFFFF if kind.name == "time" else -1
    return {"secs": value["secs"] + more & mask, "nsecs": nsecs}


def _cut(kind: FieldType, value: Plain) -> Plain:
    if isinstance(kind, String) and kind.wide:
        return value[: value.index(0)] if 0 in value else value
    return value.partition(b"\0")[0] if isinstance(kind, String) else value


def _replaced(kind: FieldType, value: Plain) -> Plain:
    if isinstance(kind, String) and not kind.wide:
        return value.decode("utf-8", "replace").encode()
    return value


class _Entries:
    """Adds differences of some libraries on some wire formats to `KNOWN`."""

    def __init__(self, *libraries: str, wires: str = "cdr"):
        self.libraries, self.wires = libraries, wires

    def add(self, key: str, text: str, **more: Any) -> None:
        """Add a difference by attributes of `KnownDivergence`."""
        found = KnownDivergence(
            key=key, libraries=self.libraries, wires=self.wires, text=text, **more
        )
        KNOWN.append(found)

    def takes(self, key: str, text: str, *case_names: str) -> None:
        """Add cases that the libraries accept and the others refuse."""
        self.add(key, text, case_names=case_names, answer="takes")

    def refuses(self, key: str, text: str, *case_names: str) -> None:
        """Add cases that the libraries refuse and the others accept."""
        self.add(key, text, case_names=case_names, answer="refuses")


KNOWN: list[KnownDivergence] = []
"""All entries, in the order in which they are tried."""

_CYCLONEDDS, _FIRM_HDL = _Entries("cyclonedds"), _Entries("firm-hdl")
_FASTCDR, _FASTCDR_2_3 = _Entries("fastcdr"), _Entries("fastcdr-2.3")
_ALL_FASTCDR = _Entries("fastcdr", "fastcdr-2.2", "fastcdr-2.3")
_GENPY = _Entries("genpy", "mcap-ros1", wires="ros1")
_MCAP_ROS2, _ROSBAGS = _Entries("mcap-ros2"), _Entries("rosbags")
_CUTS = ("cut-1", "cut-half", "cut-all", "long-text", "long-items")

# Values that libraries write or read differently from ROS.

_Entries(*("rosbags", "cyclonedds", "mcap-ros2"), *_GENPY.libraries, wires="ros1 cdr").add(
    "python-signalling-nan",
    "A signalling NaN of 4 bytes becomes a quiet one, as any Python float.",
    take_out=_quiet_nan,
    same=_quiet_nan,
)
_Entries("rosbags", "cyclonedds", "mcap-ros2", wires="ros1 cdr").refuses(
    "python-not-utf8", "A string that is not UTF-8 is refused.", "not-utf8", "encode not-utf8"
)
_ROSBAGS.add(
    "rosbags-byte-signed",
    "A byte is -128 to 127; in ROS 2 it is 0 to 255.",
    take_out=_number("byte", 0x7F),
    same=_number("byte", 0xFF),
)
_Entries("rosbags", wires="ros1 cdr").add(
    "rosbags-time-signs",
    "Seconds of a ROS 1 time are signed and nanoseconds of a duration unsigned; in ROS 1, it is "
    "the other way round.",
    take_out=_positive_times,
    same=_same_times,
)
_MCAP_ROS2.add(
    "mcap-ros2-char-signed",
    "A char is -128 to 127; in ROS 2 it is 0 to 255.",
    take_out=_number("char", 0x7F),
    same=_number("char", 0xFF),
)
_Entries("fastcdr", "fastcdr-2.2").add(
    "fastcdr-cut-at-nul", "A string and a wstring are written up to the first NUL.", take_out=_cut
)
_FASTCDR_2_3.refuses(
    "fastcdr-no-nul-inside", "A string with a NUL inside cannot be written.", "encode nul-inside"
)
_FASTCDR.add(
    "fastcdr-wide-characters",
    "Of the four bytes of a wchar, two are read.",
    same=_number("wchar", 0xFFFF),
)
_FASTCDR_2_3.refuses(
    "fastcdr-options",
    "The last two bits of its options shorten a packet by as many bytes.",
    "options",
)
_ALL_FASTCDR.refuses(
    "fastcdr-bools",
    "In a sequence without a bound, a bool that is neither 0 nor 1 is refused.",
    "bool-2",
)
_ALL_FASTCDR.add(
    "fastcdr-bool-arrays",
    "In an array, a bool that is neither 0 nor 1 is not read.",
    case_names=("bool-2",),
)
_GENPY.add(
    "genpy-time-normalized",
    "When a time is read, nanoseconds from 1,000,000,000 on are carried to the seconds.",
    same=_canonical,
)
_GENPY.add(
    "genpy-not-utf8", "Bytes of a string that are not UTF-8 are read as U+FFFD.", same=_replaced
)
_GENPY.refuses(
    "genpy-not-utf8-written", "A string that is not UTF-8 cannot be written.", "encode not-utf8"
)

# Packets that are malformed or unusual.

_GENPY.takes(
    "genpy-cut", "A string or an array of bytes at the end of a packet may be cut short.", *_CUTS
)
_GENPY.takes("genpy-trailing", "Bytes after a message are ignored.", "trailing-1", "trailing-4")
_ROSBAGS.refuses(
    "rosbags-bare-string", "An empty string whose length is 0 is refused.", "bare-string"
)
_ROSBAGS.refuses("rosbags-no-nul", "A string without a NUL is refused.", "no-nul")
_ROSBAGS.refuses("rosbags-trailing", "More than 3 bytes after a message are refused.", "trailing-4")
_ROSBAGS.takes(
    "rosbags-bounds", "Bounds of sequences are not checked.", "bound-items", "encode bound-items"
)
_CYCLONEDDS.add(
    "cyclonedds-no-nul", "A string without a NUL loses its last byte.", case_names=("no-nul",)
)
_CYCLONEDDS.takes(
    "cyclonedds-cut",
    "A packet without bytes, or one that ends in an array of bytes, is read as far as it goes.",
    *_CUTS,
)
_CYCLONEDDS.takes(
    "cyclonedds-bounds", "Bounds of sequences are not checked when a packet is read.", "bound-items"
)
_CYCLONEDDS.refuses(
    "cyclonedds-text-bounds",
    "A string that is longer than its bound is not written.",
    "encode bound-text",
)
_MCAP_ROS2.add(
    "mcap-ros2-no-nul", "A string without a NUL loses its last byte.", case_names=("no-nul",)
)
_MCAP_ROS2.takes(
    "mcap-ros2-cut", "A string or an array of bytes is read as far as the packet goes.", *_CUTS
)
_MCAP_ROS2.takes(
    "mcap-ros2-bounds",
    "Bounds of sequences are not checked in packets; elements over the bound are not written.",
    "bound-items",
    "encode bound-items",
)
_FIRM_HDL.refuses("firm-hdl-no-nul", "A string without a NUL is refused.", "no-nul")
_FIRM_HDL.refuses(
    "firm-hdl-trailing", "More than 3 bytes after a message are refused.", "trailing-4"
)
_FIRM_HDL.refuses(
    "firm-hdl-bounds",
    "Bounds of strings are checked, like those of sequences.",
    "bound-text",
    "encode bound-text",
)


_WRITER = "rosbags"


def known_keys(finding: Finding, library_codec: Codec, reference_codec: Codec) -> Sequence[str]:
    """Return the keys of the divergences that explain a difference; none if it is new."""
    entries = [entry for entry in KNOWN if entry.is_about(finding)]
    for entry in entries:
        if entry.explains_answer(finding):
            return [entry.key]
    if finding.what.startswith("encode"):
        return _explained_writing(
            finding.message, finding.value, entries, library_codec, reference_codec
        )
    if isinstance(finding.expected, Refusal) or isinstance(finding.got, Refusal):
        return ()
    found, expected, got = [], finding.expected, finding.got
    for entry in entries:
        if entry.same is not None:
            one, other = (changed(finding.message, each, entry.same) for each in (expected, got))
            if (one, other) != (expected, got):
                found.append(entry.key)
            expected, got = one, other
    return found if expected == got else ()


def _explained_writing(
    message: Message,
    value: Plain,
    entries: Sequence[KnownDivergence],
    library_codec: Codec,
    reference_codec: Codec,
) -> Sequence[str]:
    found = []
    for entry in entries:
        if entry.take_out is not None:
            left = changed(message, value, entry.take_out)
            if left != value:
                found.append(entry.key)
            value = left
    if not found:
        return ()
    one, other = reference_codec.encode_all([value])[0], library_codec.encode_all([value])[0]
    return found if one == other and not isinstance(one, Refusal) else ()


def known_writing(
    message: Message, wire: Wire, value: Plain, library: str, codec: Codec
) -> Sequence[str]:
    """Return the keys of divergences that explain why a library and rosbags write different bytes.

    The divergences explain it if both libraries write the same packet once the parts that the
    divergences are about are taken out of the value. There are no divergences of a type that
    rosbags does not have.

    * `codec`: the codec of `library`. That of rosbags is opened here.
    """
    try:
        reference_codec = client(_WRITER).open(message, wire)
    except UnsupportedError:
        # Without the type, rosbags writes nothing to compare.
        return ()
    entries = [
        entry for entry in KNOWN if entry.affected_library(wire, library, _WRITER) is not None
    ]
    return _explained_writing(message, value, entries, codec, reference_codec)
