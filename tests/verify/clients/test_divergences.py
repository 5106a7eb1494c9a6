"""Each known divergence occurs, has a key, and is documented in docs/reference/divergences.md."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from firm_hdl.cases.values import shown
from firm_hdl.verify.clients.divergences import KNOWN
from firm_hdl.verify.clients.judge import LibraryComparison
from firm_hdl.verify.references.client import Refusal
from firm_hdl.verify.references.objects import definition_text
from tests.verify.clients.examples import EXAMPLES

PAGE = Path(__file__).parents[3] / "docs" / "reference" / "divergences.md"


@pytest.fixture
def ask_example(library_here, make_message):
    """Ask for an example; return the difference and its keys."""

    def ask(example):
        contest = LibraryComparison(
            library_here(example.library),
            library_here(example.reference),
            "ros1" if example.distro == "noetic" else "cdr",
        )
        message = make_message(example.text, example.distro)
        return contest.ask(message, example.what, example.value)

    return ask


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


@pytest.mark.sampled(2)
@pytest.mark.parametrize("key", EXAMPLES)
def test_divergence_is_known_by_its_key_and_shown(ask_example, key):
    finding, keys = ask_example(EXAMPLES[key])
    assert list(keys) == [key]
    assert block(finding) in section(key)


def test_every_key_has_an_example_and_a_section():
    keys = sorted(entry.key for entry in KNOWN)
    assert keys == sorted(EXAMPLES)
    listed = re.findall(r"^### `([a-z0-9-]+)`$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    assert sorted(listed) == keys


def test_a_known_divergence_hides_no_other(library_here, make_message):
    contest = LibraryComparison(library_here("rosbags"), library_here("fastcdr"), "cdr")
    message = make_message("byte a\nuint16 b\n")
    codec = contest.library.open(message, "cdr")

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

    contest.library = type("Twin", (), {"name": "rosbags", "wires": {"cdr"}, "open": opened})()
    for what in ("encode", "decode"):
        finding, keys = contest.ask(message, what, {"a": 254, "b": 7})
        assert not keys and finding.what == what
