"""A minimal case of each known divergence, as docs/reference/divergences.md shows it."""

from __future__ import annotations

from typing import Any, NamedTuple

__all__ = ["EXAMPLES", "Example"]


class Example(NamedTuple):
    """A library, a reference, a question about a type, and the two different answers."""

    library: str
    reference: str
    text: str
    value: dict[str, Any]
    what: str = "encode"

    @property
    def distro(self) -> str:
        """The distribution whose rules the text follows."""
        if self.text.startswith("module"):
            return "humble"
        return "noetic" if "genpy" in (self.library, self.reference) else "lyrical"


_TEXT = {"a": b""}

EXAMPLES = {
    "python-signalling-nan": Example("mcap-ros2", "fastcdr", "float32 a\n", {"a": 0x7F800001}),
    "python-not-utf8": Example("rosbags", "fastcdr", "string a\n", _TEXT, "not-utf8"),
    "rosbags-byte-signed": Example("rosbags", "fastcdr", "byte a\n", {"a": 254}),
    "rosbags-time-signs": Example(
        "rosbags", "genpy", "time a\n", {"a": {"secs": 1 << 31, "nsecs": 0}}
    ),
    "mcap-ros2-char-signed": Example("mcap-ros2", "fastcdr", "char a\n", {"a": 200}, "decode"),
    "fastcdr-cut-at-nul": Example("fastcdr", "rosbags", "string a\n", {"a": b"a\0b"}),
    "fastcdr-no-nul-inside": Example(
        "firm-hdl", "fastcdr-2.3", "string a\n", {"a": b"a"}, "encode nul-inside"
    ),
    "fastcdr-wide-characters": Example(
        "firm-hdl",
        "fastcdr",
        "module p { module msg { struct A { wchar a; }; }; };",
        {"a": 0x1F600},
        "decode",
    ),
    "fastcdr-options": Example("firm-hdl", "fastcdr-2.3", "uint32 a\n", {"a": 1}, "options"),
    "fastcdr-bools": Example("firm-hdl", "fastcdr", "bool[] a\n", {"a": [True]}, "bool-2"),
    "fastcdr-bool-arrays": Example("firm-hdl", "fastcdr", "bool[1] a\n", {"a": [True]}, "bool-2"),
    "genpy-time-normalized": Example(
        "genpy",
        "rosbags",
        "time a\n",
        {"a": {"secs": 1, "nsecs": 1_000_000_001}},
        "decode",
    ),
    "genpy-not-utf8": Example("firm-hdl", "genpy", "string a\n", _TEXT, "not-utf8"),
    "genpy-not-utf8-written": Example("firm-hdl", "genpy", "string a\n", _TEXT, "encode not-utf8"),
    "genpy-cut": Example("firm-hdl", "genpy", "string a\n", {"a": b"ab"}, "cut-1"),
    "genpy-trailing": Example("rosbags", "genpy", "uint8 a\n", {"a": 1}, "trailing-1"),
    "rosbags-bare-string": Example("rosbags", "fastcdr", "string a\n", _TEXT, "bare-string"),
    "rosbags-no-nul": Example("rosbags", "fastcdr", "string a\n", {"a": b"ab"}, "no-nul"),
    "rosbags-trailing": Example("rosbags", "fastcdr", "uint8 a\n", {"a": 1}, "trailing-4"),
    "rosbags-bounds": Example(
        "rosbags", "fastcdr", "uint8[<=1] a\n", {"a": [1]}, "encode bound-items"
    ),
    "cyclonedds-no-nul": Example("cyclonedds", "fastcdr", "string a\n", {"a": b"ab"}, "no-nul"),
    "cyclonedds-cut": Example("cyclonedds", "fastcdr", "uint8[2] a\n", {"a": [1, 2]}, "cut-1"),
    "cyclonedds-bounds": Example(
        "cyclonedds", "fastcdr", "uint8[<=1] a\n", {"a": [1]}, "bound-items"
    ),
    "cyclonedds-text-bounds": Example(
        "cyclonedds", "fastcdr", "string<=1 a\n", _TEXT, "encode bound-text"
    ),
    "mcap-ros2-no-nul": Example("mcap-ros2", "fastcdr", "string a\n", {"a": b"ab"}, "no-nul"),
    "mcap-ros2-cut": Example("mcap-ros2", "fastcdr", "uint8[] a\n", {"a": [1]}, "long-items"),
    "mcap-ros2-bounds": Example(
        "mcap-ros2", "fastcdr", "uint8[<=1] a\n", {"a": [1]}, "encode bound-items"
    ),
    "firm-hdl-no-nul": Example("firm-hdl", "fastcdr", "string a\n", {"a": b"ab"}, "no-nul"),
    "firm-hdl-trailing": Example("firm-hdl", "fastcdr", "uint8 a\n", {"a": 1}, "trailing-4"),
    "firm-hdl-bounds": Example("firm-hdl", "fastcdr", "string<=1 a\n", _TEXT, "bound-text"),
}
