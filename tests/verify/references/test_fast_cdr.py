"""Every release of Fast CDR against known bytes, and the differences between releases.

``tests/plan/test_wire_facts.py`` has the same bytes and compares our plans with them, also where no
Fast CDR is installed.
"""

from __future__ import annotations

import pytest

from firm_hdl.model import IDL_PRIMITIVES, Field, Message, Sequence, String, idl_primitives
from firm_hdl.verify.clients.run import judge_type
from firm_hdl.verify.references.client import Refusal, UnsupportedError
from firm_hdl.verify.results.verdict import KnownDifference, Passed
from firm_hdl.verify.systems.options import Request
from tests.frontend.workspace import make_files
from tests.plan.test_wire_facts import FACTS, WIDE, data
from tests.strategies import make
from tests.verify.references.plain import plain

RELEASES = ("fastcdr", "fastcdr-2.2", "fastcdr-2.3")
CDR_FACTS = {name: fact for name, fact in FACTS.items() if fact[0] == "ros2"}


@pytest.mark.parametrize("release", RELEASES)
def test_facts_of_the_wire_are_those_of_fast_cdr(library_here, release):
    library = library_here(release)
    assert len(CDR_FACTS) > 15
    for name, (dialect, fields, value, text) in CDR_FACTS.items():
        message = make(dialect, fields)
        codec = library.open(message, "cdr")
        given = plain(message, value)
        assert codec.encode(given).hex() == data(text).hex(), name
        assert codec.decode(data(text)) == given, name


@pytest.mark.parametrize("release", RELEASES)
def test_wide_characters_have_the_size_of_the_release(library_here, release):
    library = library_here(release)
    own = 4 if release == "fastcdr" else 2
    message, value, packet = WIDE[own]
    codec = library.open(message, "cdr")
    assert codec.encode(value) == packet
    assert codec.decode(packet) == value
    with pytest.raises(UnsupportedError, match=f"wide characters of {own} bytes, not {6 - own}"):
        library.open(WIDE[6 - own][0], "cdr")


@pytest.mark.parametrize(
    ("release", "narrow", "wide"),
    [
        ("fastcdr", "00010000 02000000 6100", "00010000 01000000 61000000"),
        ("fastcdr-2.2", "00010000 02000000 6100", "00010000 03000000 61000000 00000000 62000000"),
        ("fastcdr-2.3", None, "00010000 03000000 61000000 00000000 62000000"),
    ],
)
def test_a_nul_inside_a_text_is_the_affair_of_the_release(library_here, release, narrow, wide):
    def written(kind, value):
        message = Message(name="p/msg/T", dialect="ros2", fields=(Field(name="t", type=kind),))
        return library_here(release).open(message, "cdr").encode({"t": value})

    assert written(String(wide=True), [0x61, 0, 0x62]) == data(wide)
    if narrow is not None:
        assert written(String(), b"a\0b") == data(narrow)
        return
    with pytest.raises(Refusal, match="null characters"):
        written(String(), b"a\0b")


@pytest.mark.parametrize("release", RELEASES)
def test_a_unit_of_wide_text_that_is_too_large(library_here, release):
    message = make("ros2", {"w": "wstring"})
    codec = library_here(release).open(message, "cdr")
    packet = data("00010000 01000000 61000100")
    if release == "fastcdr":
        # The unit passes through a wchar_t of 32 bits, and is truncated to 16 bits afterwards.
        assert codec.decode(packet) == {"w": [0x61]}
        return
    with pytest.raises(Refusal, match="more than 16 bits"):
        codec.decode(packet)


WIDE_IDL = "module p { module msg { struct W { octet a; wchar b; }; }; };"


@pytest.mark.parametrize(("distro", "judge"), [("humble", "fastcdr"), ("kilted", "fastcdr-2.3")])
def test_a_release_with_the_type_judges_it(library_here, tmp_path, distro, judge):
    for name in RELEASES:
        library_here(name)
    root = make_files(tmp_path, {"p/msg/W.idl": WIDE_IDL})
    options = Request(libraries=("firm-hdl",), most_cases=2, paths=(str(root),))
    (trial,) = judge_type(distro, "p/msg/W", options, (*RELEASES, "rosbags"))
    assert trial.reference == judge and isinstance(trial.verdict, Passed | KnownDifference)


def test_wide_characters_of_the_facts_are_those_of_the_model():
    for size, (message, _, _) in WIDE.items():
        kinds = [item.type for item in message.fields]
        assert kinds[0] == idl_primitives(size)["wchar"] and kinds[1] == IDL_PRIMITIVES["byte"]
        assert isinstance(kinds[2], Sequence) and kinds[2].bound
