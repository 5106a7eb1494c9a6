"""Expressions, literals and long lines of VHDL."""

from __future__ import annotations

import pytest

from firm_hdl.vhdl.text import Expression, atom, bit_literal, chain, infix, literal, prefix, wrap

A, B, C = atom("a"), atom("b"), atom("c")


@pytest.mark.parametrize(
    ("expression", "text"),
    [
        (infix("-", infix("-", A, B), C), "a - b - c"),
        (infix("-", A, infix("-", B, C)), "a - (b - c)"),
        (infix("-", A, infix("+", B, C)), "a - (b + c)"),
        (infix("+", infix("*", A, B), C), "a * b + c"),
        (infix("*", infix("+", A, B), C), "(a + b) * c"),
        (infix("*", A, infix("*", B, C)), "a * (b * c)"),
        (infix("=", A, infix("+", B, C)), "a = b + c"),
        # Relations are of boolean type, and VHDL does not chain them.
        (infix("=", infix("<", A, B), C), "(a < b) = c"),
        (infix("=", A, infix("<", B, C)), "a = (b < c)"),
        (chain("and", A, chain("and", B, C)), "a and b and c"),
        # Different logical operators have one precedence, and need parentheses.
        (chain("and", A, chain("or", B, C)), "a and (b or c)"),
        (chain("or", chain("and", A, B), chain("xor", B, C)), "(a and b) or (b xor c)"),
        (infix("and", infix("=", A, B), infix("/=", B, C)), "a = b and b /= c"),
        (chain("or", A), "a"),
        (prefix("not", infix("=", A, B)), "not (a = b)"),
        (prefix("not", prefix("not", A)), "not (not a)"),
        (infix("and", prefix("not", A), B), "not a and b"),
        # A reduction is combined with nothing.
        (infix("and", prefix("or", A), B), "(or a) and b"),
        (infix("=", prefix("xor", A), B), "(xor a) = b"),
        (prefix("and", infix("&", A, B)), "and (a & b)"),
        (infix("&", infix("+", A, B), C), "a + b & c"),
    ],
)
def test_parentheses(expression: Expression, text: str) -> None:
    assert expression.text == text


@pytest.mark.parametrize(
    ("bits", "text"),
    [
        ("0", '"0"'),
        ("10110001", '"10110001"'),
        ("110110001", '9x"1B1"'),
        ("0000110110001", '13x"01B1"'),
        ("101010111100", 'x"ABC"'),
        ("0000000000001111", 'x"000F"'),
        ("1x1-z0000", '9x"140"'),
    ],
)
def test_literals_have_exactly_their_width(bits: str, text: str) -> None:
    assert literal(bits) == text


def test_bits() -> None:
    assert [bit_literal(bit) for bit in "01xz-"] == ["'0'", "'1'", "'0'", "'0'", "'0'"]


def test_a_line_of_100_columns_stays_and_a_longer_one_is_broken() -> None:
    for name in ("n" * 79, "n" * 80):
        line = f"  target_1 <= {name} and b;"
        assert len(line) == 21 + len(name)
        broken = [f"  target_1 <= {name} and", "      b;"]
        assert wrap(line) == ([line] if len(line) <= 100 else broken)
    # Without an operator or a comma, any space will do; without a space, none.
    assert wrap(f"  x <= {'a' * 60} {'b' * 60};") == [f"  x <= {'a' * 60}", f"      {'b' * 60};"]
    assert wrap("x" * 120) == ["x" * 120]


def test_several_breaks_have_one_indent() -> None:
    words = [f"{letter * 40} and" for letter in "abcd"]
    assert wrap("  " + " ".join(words)) == [
        f"  {words[0]} {words[1]}",
        f"      {words[2]} {words[3]}",
    ]


def test_no_break_inside_of_a_string() -> None:
    text = '"' + "a, b and c, " * 9 + '"'
    assert wrap(f"    report {text} severity note;") == [
        "    report",
        f"        {text} severity note;",
    ]


def test_the_comment_of_a_long_line_goes_before_it() -> None:
    code = "    signal " + "s" * 60 + " : std_logic;"
    assert wrap(f"{code}  -- short") == [f"{code}  -- short"]
    assert wrap(f"{code}  -- {'long ' * 9}end") == [f"    -- {'long ' * 9}end", code]
    comment = f"  -- {'word, ' * 30}"
    assert wrap(comment) == [comment]
