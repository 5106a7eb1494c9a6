"""Numbers on the command line: what is read, and what is told of the others."""

from __future__ import annotations

import argparse

import pytest

from firm_hdl.arguments import (
    add_engine,
    add_options,
    add_origins,
    number_between,
    positive,
    seconds,
)


@pytest.mark.parametrize(
    ("text", "number"), [("7", 7), ("0x10", 16), ("0b11", 3), (" 12 ", 12), ("+5", 5)]
)
def test_numbers_are_read_in_any_usual_base(text, number):
    assert number_between(text, 1, 16) == positive(text) == number


@pytest.mark.parametrize(
    ("text", "limits", "message"),
    [
        ("x", (1, 9), "'x' is not a number"),
        ("1.5", (1, None), "'1.5' is not a number"),
        ("", (0, 9), "'' is not a number"),
        ("010", (1, 99), "'010' is not a number"),
        ("0", (1, None), "must be at least 1, not 0"),
        ("-3", (0, None), "must be at least 0, not -3"),
        ("10", (2, 9), "must be from 2 to 9, not 10"),
        ("1", (2, 9), "must be from 2 to 9, not 1"),
        ("0x10", (2, 9), "must be from 2 to 9, not 16"),
    ],
)
def test_a_wrong_number_is_told_with_what_is_right(text, limits, message):
    with pytest.raises(argparse.ArgumentTypeError) as error:
        number_between(text, *limits)
    assert str(error.value) == message


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x", "'x' is not a number"),
        ("0", "must be above 0, not 0"),
        ("-1e3", "must be above 0, not -1e3"),
        ("inf", "must be above 0, not inf"),
        ("nan", "must be above 0, not nan"),
    ],
)
def test_a_wrong_time_is_told_with_what_is_right(text, message):
    with pytest.raises(argparse.ArgumentTypeError) as error:
        seconds(text)
    assert str(error.value) == message


def test_the_help_tells_the_defaults():
    parser = argparse.ArgumentParser()
    add_origins(parser)
    add_options(parser)
    add_engine(parser, "run")
    text = " ".join(parser.format_help().split())
    assert "default: lyrical, or that of the recording" in text
    assert "bytes per beat: 1, 2, 4, 8, 16, 32, 64; default: 8" in text
    assert "longest message to accept; default: 16777216" in text
    assert "wire format; default: the distribution's own" in text
    assert (
        "for run: compiled with Verilator, or Amaranth's slow simulator (auto: the former if there "
        "are Verilator and a C++ compiler)" in text
    )
