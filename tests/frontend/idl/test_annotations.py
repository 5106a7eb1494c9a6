"""Annotations: where they are refused, and what those that count may contain."""

from __future__ import annotations

import pytest

from .reading import read


def members(text):
    """Return the members of a struct, by name."""
    messages, wrong = read(f"module p {{ struct T {{ {text} }}; }};")
    assert [each.message for each in wrong] == []
    return {member.name.text: member for member in messages["T"].members}


def refusal(text):
    """Return the words that the only error of a struct marks, and its message."""
    source = f"module p {{ struct T {{ {text} }}; }};"
    (wrong,) = read(source)[1]
    return source[wrong.span.start : wrong.span.end], wrong.message


PLACES = [
    "{} module p {{ struct T {{ long a; }}; }};",
    "module p {{ {} struct T {{ long a; }}; }};",
    "module p {{ struct T {{ long b; {} long a; }}; }};",
    "module p {{ module T_Constants {{ {} const long A = 1; }}; struct T {{ long a; }}; }};",
    "module p {{ const long B = 1; {} const long A = 1; struct T {{ long a; }}; }};",
]


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize(
    ("annotation", "name"),
    {
        "@optional": "@optional",
        "@mutable": "@mutable",
        "@extensibility(MUTABLE)": "@extensibility(MUTABLE)",
        "@extensibility(value=MUTABLE)": "@extensibility(MUTABLE)",
        "@extensibility(a::MUTABLE)": "@extensibility(MUTABLE)",
    }.items(),
)
def test_what_changes_the_bytes_is_refused_everywhere(place, annotation, name):
    text = place.format(f"@key {annotation} @external")
    (wrong,) = read(text)[1]
    assert wrong.message == f"annotation '{name}' is not supported"
    assert text[wrong.span.start : wrong.span.end] == annotation


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize(
    "annotation", ["@extensibility(FINAL)", "@extensibility(APPENDABLE)", "@other(MUTABLE)"]
)
def test_what_keeps_the_bytes_is_ignored_everywhere(place, annotation):
    assert read(place.format(annotation))[1] == []


@pytest.mark.parametrize(
    ("annotation", "unit"),
    {
        '@unit(value="m")': "m",
        '@unit("m")': "m",
        '@unit(other="s", value="m")': "m",
        '@unit(value="m" "/s")': "m/s",
        '@unit(other="s")': None,
        "@unit(value=5)": None,
        "@unit(value=m)": None,
        "@unit": None,
    }.items(),
)
def test_units_are_texts_with_or_without_the_name_value(annotation, unit):
    assert members(f"{annotation} long a;")["a"].unit == unit


@pytest.mark.parametrize("bits", [8, 16, 32, 64])
def test_complement_has_the_size_of_an_unsigned_member(bits):
    found = members(f"@default(value=~1) uint{bits} a; @default(value=~1) int{bits} b;")
    assert found["a"].default.value == 2**bits - 2
    assert found["b"].default.value == -2


def test_complement_of_a_boolean_has_no_bits_of_its_own():
    assert members("@default(value=~(-2)) boolean a;")["a"].default.value is True
    assert members("@default(value=~(-1)) boolean a;")["a"].default.value is False
    assert refusal("@default(value=~0) boolean a;") == ("~0", "expected TRUE or FALSE")


def test_the_words_of_a_value_are_in_one_line():
    messages, wrong = read(
        """module p { module T_Constants { const double A = 1 /
            // half
            2.; const wstring W = L"x" ; const string S = "y"; };
        struct T { @default(value= -
            3) long a; }; };"""
    )
    assert wrong == []
    half, wide, text, a = messages["T"].members
    assert (half.value.text, a.default.text) == ("1 / // half 2.", "- 3")
    assert [(each.type.name, each.value.text) for each in (wide, text)] == [
        ("wstring", 'L"x"'), ("string", '"y"')
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("type_", "text", "want"),
    [
        ("long", "(1, two)", 'expected a list of int32 as a string, such as "(1, 2)"'),
        ("double", "(1.0, 1e999)", 'expected a list of float64 as a string, such as "(1, 2)"'),
        # Numbers of C, but not of Python.
        ("long", "(1, 012)", 'expected a list of int32 as a string, such as "(1, 2)"'),
        ("double", "(1, 1.2.3)", 'expected a list of float64 as a string, such as "(1, 2)"'),
        ("long", "(", 'expected a list of int32 as a string, such as "(1, 2)"'),
        ("long", "[1, 2)", 'expected a list of int32 as a string, such as "(1, 2)"'),
        ("long", "(1, None)", 'expected a list of int32 as a string, such as "(1, 2)"'),
        ("long", "(1, True)", "expected an integer, not a boolean"),
        ("long", "(1, 2.0)", "expected an integer, not a number with a fraction"),
        ("double", "(1, 'a')", "expected a number, not a string"),
        ("boolean", "(True, 2)", "expected TRUE or FALSE"),
        ("string", "('a', 1)", "expected a string, not an integer"),
    ],
)
def test_every_item_of_a_default_has_the_type_of_the_elements(type_, text, want):
    words = f'"{text}"'
    for size in ("sequence<{}> a;", "sequence<{}, 2> a;", "{} a[2];"):
        assert refusal(f"@default(value={words}) {size.format(type_)}") == (words, want)


def test_items_of_a_default_keep_their_kinds():
    found = members(
        '@default(value="(1, -2.5e-1)") sequence<double> a; '
        '@default(value="(True, False, 1)") boolean b[3];'
        r"""@default(value="['it\\\\'s', 'a, b', \"c\"]") string c[3];"""
    )
    values = {name: [item.value for item in each.default.items] for name, each in found.items()}
    assert values.pop("c") == ["it's", "a, b", "c"]
    assert values == {"a": [1.0, -0.25], "b": [True, False, True]}
    assert [type(value) for value in values["a"] + values["b"]] == [float] * 2 + [bool] * 3


def test_annotations_belong_to_their_own_member():
    text = """module p { module msg {
      @verbatim(language="comment", text="of T") struct T {
        @verbatim(language="comment", text="of a") @unit(value="m") @default(value=1) long a;
        long b;
        @unit(value="s") long c[2];
        @verbatim(language="comment", text="of d") long d[3];
        @default(value="(1, 2)") sequence<long, 2> e;
        sequence<long, 2> f;
        @unit(value="kg") @default(value=2) long g, h;
        long i;
      };
    }; };"""
    messages, wrong = read(text)
    assert wrong == [] and messages["T"].comment == "of T"

    def default(member):
        value = member.default
        if value is None:
            return None
        return tuple(i.value for i in value.items) if hasattr(value, "items") else value.value

    found = {m.name.text: (m.comment, m.unit, default(m)) for m in messages["T"].members}
    assert found == {
        "a": ("of a", "m", 1),
        "b": ("", None, None),
        "c": ("", "s", None),
        "d": ("of d", None, None),
        "e": ("", None, (1, 2)),
        "f": ("", None, None),
        "g": ("", "kg", 2),
        "h": ("", "kg", 2),
        "i": ("", None, None),
    }


def test_comments_are_those_in_the_language_of_comments():
    text = """module p { struct T {
      @verbatim(language="comment", text="one") @verbatim(language="c++", text="no")
      @verbatim(language="comment", text="two" "\\n" "three") @verbatim(text="none")
      @verbatim(language="comment") @verbatim(language="comment", text="") @verbatim long a;
      @vendor::unit(value="m") @vendor::verbatim(language="comment", text="theirs") long b;
      @unit::vendor(value="s") long c;
    }; };"""
    messages, wrong = read(text)
    assert wrong == []
    a, b, c = messages["T"].members
    assert a.comment == "one\ntwo\nthree"
    # rosidl_parser decides by the first word of a name.
    assert (b.comment, b.unit, c.unit) == ("", None, "s")
