"""Each known divergence occurs, has a key, and is documented in docs/reference/divergences.md."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from firm_hdl.cases.values import shown
from firm_hdl.model import PRIMITIVES, Message, String
from firm_hdl.verify.clients.divergences import KNOWN, Finding, known_keys
from firm_hdl.verify.clients.unusual import unusual_packet, unusual_value
from firm_hdl.verify.references.client import Refusal
from firm_hdl.verify.references.objects import definition_text
from tests.verify.clients.examples import EXAMPLES

PAGE = Path(__file__).parents[3] / "docs" / "reference" / "divergences.md"


def ask(library, reference, message, what, value):
    """Ask both libraries one question; return the difference and its keys."""
    codecs = [each.open(message, message.wire) for each in (library, reference)]
    case, packet = what.removeprefix("encode").strip(), b""
    if what.startswith("encode"):
        value = unusual_value(message, value, case) if case else value
        answers = [each.encode_all([value])[0] for each in codecs]
    else:
        (packet,) = codecs[1].encode_all([value])
        if what != "decode":
            packet = unusual_packet(message, message.wire, value, what)
        answers = [each.decode_all([packet])[0] for each in codecs]
    got, expected = answers
    assert expected != got
    finding = Finding(
        library=library.name,
        reference=reference.name,
        wire=message.wire,
        what=what,
        message=message,
        value=value,
        packet=packet,
        expected=expected,
        got=got,
    )
    return finding, known_keys(finding, *codecs)


def block(finding):
    """Return an example as on the page: without texts of refusals, which depend on the release."""

    def answer_text(answer):
        if isinstance(answer, Refusal):
            return "refuses"
        if isinstance(answer, bytes):
            return answer.hex()
        return shown(finding.message, answer)

    lines = [definition_text(finding.message).strip()]
    if finding.what.startswith("encode"):
        lines.append(f"value: {shown(finding.message, finding.value)}")
    else:
        lines.append(f"packet: {finding.packet.hex()}")
    lines.append(f"{finding.reference}: {answer_text(finding.expected)}")
    lines.append(f"{finding.library}: {answer_text(finding.got)}")
    return "\n".join(["```", *lines, "```"])


def section(key):
    _, _, rest = PAGE.read_text(encoding="utf-8").partition(f"\n### `{key}`\n")
    return rest.partition("\n### ")[0].partition("\n## ")[0]


@pytest.mark.sampled(7)
@pytest.mark.parametrize("key", EXAMPLES)
def test_divergence_is_known_by_its_key_and_shown(library_here, make_message, key):
    example = EXAMPLES[key]
    both = library_here(example.library), library_here(example.reference)
    message = make_message(example.text, example.distro)
    finding, keys = ask(*both, message, example.what, example.value)
    assert list(keys) == [key]
    assert block(finding) in section(key)


def test_every_key_has_an_example_and_a_section():
    keys = sorted(entry.key for entry in KNOWN)
    assert keys == sorted(EXAMPLES)
    listed = re.findall(r"^### `([a-z0-9-]+)`$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    assert sorted(listed) == keys


def test_a_known_divergence_hides_no_other(library_here, make_message):
    message = make_message("byte a\nuint16 b\n")
    codec = library_here("rosbags").open(message, "cdr")

    class Wrong(type(codec)):
        def write(self, value):
            value.b ^= 1
            return super().write(value)

        def read(self, packet):
            value = super().read(packet)
            value.b ^= 1
            return value

    def opened(*given):
        return Wrong(message, "cdr")

    twin = type("Twin", (), {"name": "rosbags", "open": opened})()
    for what in ("encode", "decode"):
        value = {"a": 254, "b": 7}
        finding, keys = ask(twin, library_here("fastcdr"), message, what, value)
        assert not keys and finding.what == what


ROS1, ROS2 = PRIMITIVES["ros1"], PRIMITIVES["ros2"]
TIME = Message(name="time", dialect="ros1", fields=())
DURATION = Message(name="duration", dialect="ros1", fields=())


@pytest.mark.parametrize(
    ("key", "how", "kind", "value", "want"),
    [
        ("python-signalling-nan", "same", ROS2["float32"], 0x7F800001, 0x7FC00001),
        ("python-signalling-nan", "same", ROS2["float32"], 0x7F800000, 0x7F800000),
        ("python-signalling-nan", "take_out", ROS2["uint32"], 0x7F800001, 0x7F800001),
        ("rosbags-byte-signed", "take_out", ROS2["char"], 0xFE, 0xFE),
        ("rosbags-byte-signed", "take_out", ROS1["byte"], -2, -2),
        ("mcap-ros2-char-signed", "same", ROS2["char"], -56, 200),
        ("rosbags-time-signs", "same", TIME, {"secs": -1, "nsecs": 5},
         {"secs": 0xFFFFFFFF, "nsecs": 5}),
        ("rosbags-time-signs", "same", DURATION, {"secs": -1, "nsecs": 0xFFFFFFFF},
         {"secs": -1, "nsecs": -1}),
        ("rosbags-time-signs", "take_out", DURATION, {"secs": 3, "nsecs": -1},
         {"secs": 3, "nsecs": 0x7FFFFFFF}),
        ("fastcdr-cut-at-nul", "take_out", String(), b"ab\0c\0", b"ab"),
        ("fastcdr-cut-at-nul", "take_out", String(wide=True), [1, 2, 0, 3, 0], [1, 2]),
        ("genpy-time-normalized", "same", TIME, {"secs": 0xFFFFFFFF, "nsecs": 1_000_000_000},
         {"secs": 0, "nsecs": 0}),
        ("genpy-time-normalized", "same", DURATION, {"secs": -1, "nsecs": -1},
         {"secs": -2, "nsecs": 999_999_999}),
        ("genpy-not-utf8", "same", String(), b"a\xffb", "a\N{REPLACEMENT CHARACTER}b".encode()),
    ],
)  # fmt: skip
def test_a_change_removes_the_difference_of_its_entry_alone(key, how, kind, value, want):
    (entry,) = [each for each in KNOWN if each.key == key]
    assert getattr(entry, how)(kind, value) == want
