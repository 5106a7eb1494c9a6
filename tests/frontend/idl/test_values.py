"""Expressions, and the types that take their values."""

from __future__ import annotations

import pytest

from firm_hdl.errors import Source
from firm_hdl.frontend.idl.parse import parse_file
from firm_hdl.frontend.idl.values import IdlError, UnknownNameError, Value, evaluate, fit


def value(text, bits=None):
    file = parse_file(Source(name="test.idl", text=f"module m {{ const long A = {text}; }};"))
    node = file.definitions[0].definitions[0].value

    def lookup(name):
        if str(name) == "m::ANSWER":
            return Value("integer", 42)
        raise UnknownNameError(f"no {name}", name.span)

    return evaluate(node, lookup, bits)


@pytest.mark.parametrize(
    ("text", "want"),
    [
        ("42", 42),
        ("052", 42),
        ("0x2A", 42),
        ("0X2a", 42),
        ("0", 0),
        ("00", 0),
        # Zeros in front do not make a number long.
        ("0" * 40 + "52", 42),
        ("0x" + "0" * 40 + "2A", 42),
        ("01777777777777777777777", 2**64 - 1),
        ("+42", 42),
        ("-7 / 2", -3),
        ("7 / -2", -3),
        ("-7 % 2", -1),
        ("7 % -2", 1),
        ("1 + 2 * 3 - 4", 3),
        ("10 - 4 - 3", 3),
        ("1 | 2 | 4 | 8", 15),
        ("1 ^ 3 ^ 8 ^ 8", 2),
        ("15 & 7 & 6 & 12", 4),
        ("1 << 1 << 2 << 3", 64),
        ("96 / 2 / 3 / 4", 4),
        ("(1 + 2) * 3", 9),
        ("1 << 4 >> 2", 4),
        ("0xF0 | 0x0F & 0x3C ^ 0x01", 0xF0 | (0x0F & 0x3C) ^ 0x01),
        ("~0", -1),
        ("-(-3)", 3),
        ("m::ANSWER + 1", 43),
        ("18446744073709551615", 2**64 - 1),
        ("-9223372036854775808", -(2**63)),
        ("3 << 0", 3),
        ("3 >> 0", 3),
        ("1 << 63", 2**63),
        ("18446744073709551615 >> 63", 1),
        ("0 / 3", 0),
        ("0 / -3", 0),
        ("0 % -3", 0),
        ("-6 / -2", 3),
        ("-7 % -2", -1),
    ],
)
def test_integers(text, want):
    assert value(text) == ("integer", want)


def test_complement_of_an_unsigned_type_has_its_size():
    assert value("~1", 8) == ("integer", 254)
    assert value("~0", 64) == ("integer", 2**64 - 1)
    for text, want in {
        "~(~1)": 1,
        "-(~1)": -254,
        "~1 | 1": 255,
        "1 | ~1": 255,
        "~(-1)": 256,
    }.items():
        assert value(text, 8) == ("integer", want), text


@pytest.mark.parametrize(
    ("text", "message"),
    {
        "1 / 0": "division by zero",
        "1 % 0": "division by zero",
        "1. / 0": "division by zero",
        "1 / 0.0": "division by zero",
        f"1{'0' * 29}": "this value does not fit 64 bits",
        f"1{'0' * 30}": "a number of 31 digits is too long",
        f"0x{'F' * 31}": "a number of 31 digits is too long",
        "1e999": "this value is too large",
        "-1e999": "this value is too large",
        "1e308 * 10": "this value is too large",
        "1 + TRUE": "'+' is for numbers, not for a boolean",
        "TRUE + 1": "'+' is for numbers, not for a boolean",
        "1 + 'a'": "'+' is for numbers, not for a character",
        '1.5 - "a"': "'-' is for numbers, not for a string",
        "~1.5": "an integer must follow '~', not a number with a fraction",
        "~TRUE": "an integer must follow '~', not a boolean",
        "-TRUE": "a number must follow '-', not a boolean",
        "+'a'": "a number must follow '+', not a character",
        "1.5 % 2": "'%' is for integers, not for a number with a fraction",
        "1 << 2.": "'<<' is for integers, not for a number with a fraction",
        "2. | 1": "'|' is for integers, not for a number with a fraction",
        "1 < < 2": "'< <' must be written without blanks",
    }.items(),
)
def test_operators_take_numbers_alone(text, message):
    with pytest.raises(IdlError) as error:
        value(text)
    assert error.value.diagnostic.message == message


@pytest.mark.parametrize(
    ("text", "want"),
    [
        ("'a'", 97),
        ("' '", 32),
        ("'\"'", 34),
        (r"'\''", 39),
        (r"'\n'", 10),
        (r"'\x41'", 65),
        (r"'\101'", 65),
        (r"'\?'", 63),
        *((rf"'\{letter}'", code) for letter, code in zip("abtnvfr", range(7, 14), strict=True)),
        (r"'\\'", 92),
        (r"'\377'", 255),
        (r"L'\777'", 511),
        ("'é'", 233),
        ("L'é'", 233),
        (r"L'\u2122'", 0x2122),
    ],
)
def test_characters(text, want):
    assert value(text) == ("character", want)


@pytest.mark.parametrize(
    ("literal", "message"),
    [
        (r'"\x4"', r"escape '\x4' needs 2 hexadecimal digits"),
        (r'L"a\u2"', r"escape '\u2' needs 4 hexadecimal digits"),
    ],
)
def test_escapes_in_texts_have_all_their_digits(literal, message):
    with pytest.raises(IdlError) as error:
        value(literal)
    assert error.value.diagnostic.message == message


@pytest.mark.parametrize(
    ("text", "want"),
    [
        (r"a\tb", "a\tb"),
        (r"\101\x42", "AB"),
        # Backslashes are undone twice, but a second time only before a quote or a backslash.
        (r"\\\\n", r"\n"),
        (r"\\n", r"\n"),
        (r"\\\"", '"'),
        (r"\"", '"'),
        (r"\\'", r"\'"),
    ],
)
def test_texts_have_the_values_that_rosidl_gives_them(text, want):
    assert value(f'"{text}"') == value(f'L"{text}"') == ("text", want)


def test_long_escapes_are_of_wide_texts_alone():
    assert value(r'"\u2122"') == ("text", r"\u2122")
    assert value(r'L"\u2122" L"!"') == ("text", "™!")


@pytest.mark.parametrize(
    ("name", "text", "want"),
    [
        ("bool", "TRUE", True),
        ("bool", "0", False),
        ("byte", "255", 255),
        ("char", "'a'", 97),
        ("char", r"'\xff'", -1),
        ("char", r"'\x80'", -128),
        ("char", r"'\x7f'", 127),
        ("char", "-128", -128),
        ("wchar", r"L'\u2122'", 0x2122),
        ("wchar", r"L'\x80'", 128),
        ("wchar", "L'é'", 233),
        ("int8", "-128", -128),
        ("uint64", "18446744073709551615", 2**64 - 1),
        ("float32", "2", 2.0),
        ("string", '"a" "b"', "ab"),
        ("wstring", '"a"', "a"),
    ],
)
def test_values_become_those_of_a_type(name, text, want):
    span = Source(name="x", text="x")
    got = fit(value(text), name, span)
    assert got == want and type(got) is type(want)


@pytest.mark.parametrize(
    "text",
    [
        *("1 << 64", "1 << -1", "1 >> 64", "-9223372036854775808 - 1"),
        *("-(18446744073709551615)", "18446744073709551615 * 2", "~18446744073709551615"),
    ],
)
def test_values_beyond_64_bits_are_refused(text):
    with pytest.raises(IdlError):
        value(text)
    with pytest.raises(IdlError):
        value("18446744073709551615 + 1")


@pytest.mark.parametrize("bits", [8, 16, 32, 64])
def test_integers_reach_from_border_to_border(bits):
    span = Source(name="x", text="x")
    for name, low, high in (
        (f"int{bits}", -(2 ** (bits - 1)), 2 ** (bits - 1) - 1),
        (f"uint{bits}", 0, 2**bits - 1),
    ):
        for number in (low, high):
            assert fit(Value("integer", number), name, span) == number
        for number in (low - 1, high + 1):
            with pytest.raises(IdlError):
                fit(Value("integer", number), name, span)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("bool", "2"),
        ("bool", "1.0"),
        ("byte", "256"),
        ("char", "128"),
        ("char", r"L'\u2122'"),
        ("char", r"L'\u0100'"),
        ("int8", "'a'"),
        ("uint8", "'a'"),
        ("byte", "'a'"),
        ("bool", "'\\1'"),
        ("int32", "TRUE"),
        ("int32", "1."),
        ("float64", '"1"'),
        ("float32", "TRUE"),
        ("string", "'a'"),
        ("wstring", "1"),
    ],
)
def test_values_that_a_type_does_not_have_are_refused(name, text):
    with pytest.raises(IdlError):
        fit(value(text), name, Source(name="x", text="x"))


@pytest.mark.parametrize(
    ("code", "is_character"),
    [
        *(("d7ff", True), ("e000", True), ("ffff", True)),
        *(("d800", False), ("dbff", False), ("dc00", False), ("dfff", False)),
    ],
)
def test_halves_of_surrogate_pairs_are_no_characters(code, is_character):
    if is_character:
        assert value(rf"L'\u{code}'") == ("character", int(code, 16))
    else:
        with pytest.raises(IdlError, match=rf"escape '\\u{code}' is half of a surrogate pair"):
            value(rf"L'\u{code}'")
