"""Terminals of literals and names, on all short words of characters at borders of classes.

The rules of IDL are restated here, independently of the grammar.
"""

from __future__ import annotations

import re
from itertools import product

from firm_hdl.errors import Source
from firm_hdl.frontend.idl.parse import parse_file
from firm_hdl.frontend.idl.tree import FileSyntax


def words(alphabet, longest):
    for length in range(1, longest + 1):
        yield from map("".join, product(alphabet, repeat=length))


def literal(text):
    """Return kind and text of a literal, or `None` for other words."""
    file = parse_file(Source(name="test.idl", text=f"const long A = {text};"))
    if not isinstance(file, FileSyntax):
        return None
    value = file.definitions[0].value
    return (value.kind, value.parts) if hasattr(value, "parts") else None


INTEGER = "0|[1-9][0-9]*|0[0-7]+|0[xX][0-9A-Fa-f]+"
FLOAT = r"([0-9]+\.[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?|[0-9]+[eE][+-]?[0-9]+"
FIXED = r"([0-9]+\.[0-9]*|\.?[0-9]+)[dD]"


def kind_of_number(word):
    """Return which kind of number a word is in IDL."""
    for name, rule in {"integer": INTEGER, "float": FLOAT, "fixed": FIXED}.items():
        if re.fullmatch(rule, word):
            return name
    return None


def test_numbers_are_recognised_as_whole_words():
    digits = [word for word in words("0179.", 3) if word[0] != "."]
    tails = [head + word for head in ("0x", "0X") for word in words("09afAFgG_", 2)]
    floats = [*words("09.e", 4), *(word + "d" for word in words("09.", 3))]
    floats += ["1e+0", "9E-9", "1.0e+09", ".0E9", "9D"]
    after = [head + tail for head in ("0", "07", "0x1", "1.", "1d") for tail in "AZaz09_."]
    for word in (*digits, *tails, *floats, *after):
        if not word[0].isdigit() and word[0] != ".":
            continue  # A name.
        found = literal(word)
        want = kind_of_number(word)
        assert (found[0] if found else None) == want, word


def test_the_whole_word_is_wrong_and_not_what_follows_a_number():
    # With two digits at the end, a shorter prefix could be a number.
    heads = (
        "0 10 199 100 07 077 000 0x1 0xAA 0xFF 0xaa 0xff 0x99 0x00 1. .1 1.0 1.00 1.99 .00 .99 "
        "1e1 1e00 1e99 1d 1.d .1d"
    ).split()
    for word in (head + tail for head in heads for tail in "AZaz09_."):
        if kind_of_number(word) is None:
            found = parse_file(Source(name="test.idl", text=f"const long A = {word};"))
            assert not isinstance(found, FileSyntax), word
            assert found.message == f"'{word}' is not a number"


def test_characters():
    def escaped(word):
        return f"'\\{word}'"

    rule = r"L?'([^'\\\n]|\\([0-7]{1,3}|x[0-9A-Fa-f]{2}|u[0-9A-Fa-f]{4}|[^0-7xu\n]))'"
    inner = [*words("078n'", 3), *("x" + word for word in words("09afAFg", 3))]
    inner += ["u" + word * 4 for word in "09afAFgG"] + ["u" + word + "111" for word in "09afAFgG"]
    inner += ["u111" + word for word in "09afAFgG"] + ["u111", "u11111"]
    for word in (*map(escaped, inner), "'a'", "L'a'", "'ab'", "''", "'\"'", "LL'a'"):
        assert (literal(word) is not None) == (re.fullmatch(rule, word) is not None), word


def test_names():
    def as_name(word):
        file = parse_file(Source(name="test.idl", text=f"const long {word} = 1;"))
        return isinstance(file, FileSyntax) and file.definitions[0].name.text == word

    for word in (*words("AZ@az`09:_", 2), *words("aA0_", 4)):
        legal = re.fullmatch("[A-Za-z][A-Za-z0-9_]*", word) is not None
        assert as_name(word) == legal, word


def test_words_that_go_on_after_a_builtin_type_are_names():
    sized = [f"{u}int{bits}" for u in ("", "u") for bits in (8, 16, 32, 64)]
    for word in ("float", "char", "wchar", "boolean", "octet", *sized, "string", "wstring"):
        (member,) = (
            parse_file(Source(name="t", text=f"struct T {{ {word} a; }};")).definitions[0].members
        )
        assert not hasattr(member.type, "parts"), word
        for letter in "AZaz09_":
            text = f"struct T {{ {word}{letter} a; }};"
            (member,) = parse_file(Source(name="t", text=text)).definitions[0].members
            assert member.type.parts == (word + letter,)
