"""Every release of Fast CDR against known bytes, and the differences between releases.

``tests/plan/test_wire_facts.py`` has the same bytes and compares our plans with them, also where no
Fast CDR is installed.
"""

from __future__ import annotations

import pytest

from firm_hdl.model import Field, Message, String
from firm_hdl.verify.clients.system import judge_library
from firm_hdl.verify.references.client import Refusal, UnsupportedError
from firm_hdl.verify.results.records import Test
from firm_hdl.verify.results.verdict import KnownDifference, NotJudged, Passed
from firm_hdl.verify.systems.options import Request
from tests.frontend.workspace import make_files
from tests.plan.test_wire_facts import WIDE, data
from tests.strategies import make

RELEASES = ("fastcdr", "fastcdr-2.2", "fastcdr-2.3")


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
    test = Test(system="sut firm-hdl", distro=distro, type="p/msg/W")
    # The others have wide characters of another size.
    others = [name for name in RELEASES if (name == "fastcdr") != (judge == "fastcdr")]
    verdict = judge_library((options, (*RELEASES, "rosbags")), test).verdict
    assert isinstance(verdict, Passed | KnownDifference)
    assert isinstance(judge_library((options, others), test).verdict, NotJudged)
