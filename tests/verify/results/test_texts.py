"""Texts of results: how they are shortened, and where two sequences begin to differ."""

from __future__ import annotations

import pytest

from firm_hdl.verify.results.texts import clipped, first_difference


@pytest.mark.parametrize("text", ["", "ab", "abc"])
def test_a_text_that_is_short_enough_is_whole(text):
    assert clipped(text, 3) == text


@pytest.mark.parametrize(
    ("text", "most", "shown"),
    [("abcd", 3, "abc... (4 characters)"), ("a" * 900, 2, "aa... (900 characters)")],
)
def test_a_longer_text_is_cut_and_says_how_long_it_was(text, most, shown):
    assert clipped(text, most) == shown


@pytest.mark.parametrize(
    ("received", "expected", "index"),
    [
        ("abc", "abc", 3),
        ("xbc", "abc", 0),
        ("abx", "abc", 2),
        ("xbx", "abc", 0),
        # One of them ends early.
        ("ab", "abc", 2),
        ("abc", "a", 1),
        ("", "abc", 0),
        ("", "", 0),
    ],
)
def test_the_first_difference_is_an_item_or_the_end_of_the_shorter(received, expected, index):
    assert first_difference(received, expected) == index
    assert first_difference([*expected], [*received]) == index
