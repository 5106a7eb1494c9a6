"""Identifiers: legal in every language, never merged, always the same."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from firm_hdl.frontend import DISTROS, Library
from firm_hdl.names.identifiers import first_free, flat_names, identifier, scope_names
from firm_hdl.names.keywords import KEYWORDS, VERILOG, VHDL

LEGAL = re.compile(r"[A-Za-z](_?[A-Za-z0-9])*")

# Names of both dialects, with conflicts: keywords, case, underscores, suffixes of firm-hdl.
words = st.one_of(
    st.sampled_from(["range", "type", "reg", "data", "a", "A", "b", "x_2", "range_field", "f"]),
    st.sampled_from(sorted(KEYWORDS)),
    st.from_regex(r"[A-Za-z][A-Za-z0-9_]{0,4}", fullmatch=True),
    st.text("aA_b2", min_size=1, max_size=5),
)
paths = st.lists(st.lists(words, min_size=1, max_size=3).map(tuple), unique=True, max_size=12)


@given(paths=paths, reserved=st.sets(words, max_size=3))
def test_flat_names_are_legal_and_all_different(paths, reserved):
    names = flat_names(paths, reserved)
    assert list(names) == paths
    lower = [name.lower() for name in names.values()]
    assert len({*lower}) == len(lower)
    assert not {*lower} & {name.lower() for name in reserved}
    for name in names.values():
        assert LEGAL.fullmatch(name)
        assert name.lower() not in KEYWORDS


@given(names=st.lists(words, unique=True, max_size=12))
def test_scope_names_are_legal_and_all_different(names):
    given_names = scope_names(names)
    assert list(given_names) == names
    assert len({name.lower() for name in given_names.values()}) == len(names)
    assert all(LEGAL.fullmatch(name) for name in given_names.values())
    assert not {name.lower() for name in given_names.values()} & KEYWORDS


@given(paths=paths)
def test_a_name_that_is_fine_stays_unless_an_equal_one_was_first(paths):
    names = flat_names(paths)
    first: dict[str, tuple[str, ...]] = {}
    for path in paths:
        joined = "_".join(path)
        if identifier(joined) == joined:
            first.setdefault(joined.lower(), path)
    for path in first.values():
        assert names[path] == "_".join(path)


@given(paths=paths)
def test_names_are_stable(paths):
    assert flat_names(paths) == flat_names(list(paths))


@pytest.mark.parametrize(
    ("name", "want"),
    [
        ("linear", "linear"),
        ("range", "range_field"),
        ("Range", "Range_field"),
        ("reg", "reg_field"),
        ("a__b", "a_b"),
        ("a_", "a"),
        ("_a", "a"),
        ("_1", "f1"),
        ("_", "f"),
        ("sensor_msgs/msg/Imu", "sensor_msgs_msg_Imu"),
    ],
)
def test_identifier(name, want):
    assert identifier(name) == want


def test_reserved_names_are_taken_in_any_case():
    assert scope_names(["clk", "Rst", "a"], {"CLK", "rst"}) == {
        "clk": "clk_2", "Rst": "Rst_2", "a": "a",
    }  # fmt: skip
    assert flat_names([("in", "A")], {"IN_a"}) == {("in", "A"): "in_A_2"}


def test_paths_with_equal_flat_names_are_distinguished():
    paths = [("a", "b_c"), ("a_b", "c"), ("A", "B", "C"), ("a__b", "c"), ("a_b_c_2",)]
    assert list(flat_names(paths).values()) == ["a_b_c", "a_b_c_3", "A_B_C_4", "a_b_c_5", "a_b_c_2"]


def test_keywords_are_complete_enough():
    # 115 keywords of VHDL-2008, and four that other versions reserve.
    assert len(VHDL) == 115 + len({"private", "view", "vpkg", "inherit"} & VHDL) == 119
    assert len(VERILOG) == 248
    assert {"range", "map", "units", "label", "buffer", "vunit", "force"} <= VHDL
    assert {"reg", "wire", "logic", "bit", "priority", "tagged", "unique0"} <= VERILOG


@pytest.mark.parametrize("distro", ["noetic", "lyrical"])
def test_every_field_name_of_a_distribution_gets_a_legal_identifier(distro):
    assert distro in DISTROS
    library = Library(distro)
    clashes = 0
    for name in library.names():
        fields = [field.name for field in library.message(name).fields]
        given_names = scope_names(fields)
        clashes += sum(field.lower() in KEYWORDS for field in fields)
        assert len({text.lower() for text in given_names.values()}) == len(fields)
        assert all(LEGAL.fullmatch(text) for text in given_names.values())
        assert not {text.lower() for text in given_names.values()} & KEYWORDS
    assert clashes > 10


def test_a_free_name_leaves_all_names_that_are_made_of_it_free():
    taken = {"a_pkg", "a_2_t", "b"}

    def derived(name):
        return f"{name}_pkg", f"{name}_T"

    assert first_free("A", taken, derived) == "A_3"
    assert first_free("b", taken, derived) == "b"
    assert first_free("b", taken) == "b_2"
