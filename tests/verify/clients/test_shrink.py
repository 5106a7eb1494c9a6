"""Shrinking a difference to the smallest type and value that still show it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from firm_hdl.model import closure
from firm_hdl.verify.clients.finding import Finding
from firm_hdl.verify.clients.shrink import shrunk
from firm_hdl.verify.references.objects import full_text

TEXT = "uint8 a\nstring s\nB b\nB[] many\nuint16[6] fixed\nuint32[] plain\nbool t\nC[2] two"
B = "uint32 x\nstring name\nC c"
C = "int8 y\nint8 z"
POINT = {"x": 7, "name": b"point", "c": {"y": 1, "z": 2}}
VALUE = {
    "a": 3,
    "s": b"some text",
    "b": POINT,
    "many": [{**POINT, "x": number} for number in (4, 5, 6)],
    "fixed": [1, 2, 3, 4, 5, 6],
    "plain": [10, 11, 12],
    "t": True,
    "two": [{"y": 3, "z": 4}, {"y": 5, "z": 6}],
}


def all_items(value):
    """Yield all numbers and texts of a value, each with the name of its field."""
    if isinstance(value, dict):
        for name, each in value.items():
            yield name, each
            yield from all_items(each)
    elif isinstance(value, list):
        for each in value:
            yield from all_items(each)


def shrink(make_message, shows, text=TEXT, value=VALUE):
    message = make_message(text, B=B, C=C)
    asked = []

    def again(message, what, value):
        asked.append(what)
        found = replace(finding, message=message, value=value)
        return found if shows(dict(all_items(value)), value) else None

    finding = Finding(
        library="mine",
        reference="yours",
        wire="cdr",
        what="encode",
        message=message,
        value=value,
        packet=b"",
        expected=None,
        got=None,
    )
    assert shows(dict(all_items(value)), value)
    found = shrunk(finding, again)
    assert {*asked} == {"encode"}
    lines = [line for line in full_text(found.message).splitlines() if line]
    return lines, found.value


@pytest.mark.parametrize(
    ("shows", "lines", "value"),
    [
        # A field of the type itself with any value; then a field whose value matters.
        (lambda all_, _: "a" in all_, ["uint8 a"], {"a": 0}),
        (lambda all_, _: all_.get("a") == 3, ["uint8 a"], {"a": 3}),
        (lambda all_, _: "t" in all_, ["bool t"], {"t": False}),
        # Texts get shorter at both ends, and their characters plainer.
        (lambda all_, _: "s" in all_, ["string s"], {"s": b""}),
        (lambda all_, _: len(all_.get("s", b"")) > 2, ["string s"], {"s": b"xxx"}),
        (lambda all_, _: b"t" in all_.get("s", b""), ["string s"], {"s": b"t"}),
        # Sequences and arrays get shorter, too.
        (lambda all_, _: "plain" in all_, ["uint32[] plain"], {"plain": []}),
        (lambda all_, _: 12 in all_.get("plain", []), ["uint32[] plain"], {"plain": [12]}),
        (lambda all_, _: 11 in all_.get("plain", []), ["uint32[] plain"], {"plain": [11]}),
        (lambda all_, _: "fixed" in all_, ["uint16[1] fixed"], {"fixed": [0]}),
        (lambda all_, _: 6 in all_.get("fixed", []), ["uint16[1] fixed"], {"fixed": [6]}),
        (
            lambda all_, _: len(all_.get("fixed", [])) > 2,
            ["uint16[3] fixed"],
            {"fixed": [0, 0, 0]},
        ),
        # A nested field replaces the message around it, if possible.
        (lambda all_, _: "y" in all_, ["int8 y"], {"y": 0}),
        (lambda all_, _: all_.get("z") == 6, ["int8 z"], {"z": 6}),
        (lambda all_, _: all_.get("x") == 6, ["uint32 x"], {"x": 6}),
        # A text in an element gets shorter as well, if it must not be empty.
        (
            lambda all_, value: "many" in value and b"i" in all_.get("name", b""),
            ["p/B[] many", "=" * 80, "MSG: p/B", "string name"],
            {"many": [{"name": b"i"}]},
        ),
        # Two fields are needed.
        (
            lambda all_, _: all_.get("a") == 3 and all_.get("t") is True,
            ["uint8 a", "bool t"],
            {"a": 3, "t": True},
        ),
    ],
)
def test_everything_irrelevant_is_removed(make_message, shows, lines, value):
    assert shrink(make_message, shows) == (lines, value)


# A difference that only some lengths show is reached in steps of a half, or at once, alone.
HALVES = {
    "string s": [
        (b"abcdefgh", {4, 8}, b"a", {"s": b"abcd"}),
        (b"abcdefgh", {4, 8}, b"h", {"s": b"efgh"}),
        (b"abcdefgh", {2, 4, 8}, b"d", {"s": b"cd"}),
        (b"abcdefgh", {0, 8}, b"", {"s": b""}),
        # The longer half of an odd length is the second one.
        (b"abcde", {3, 5}, b"", {"s": b"xxx"}),
        (b"abcde", {2, 5}, b"", {"s": b"xx"}),
    ],
    "uint8[] s": [
        ([1, 2, 3, 4, 5, 6, 7, 8], {4, 8}, [1], {"s": [1, 0, 0, 0]}),
        ([1, 2, 3, 4, 5, 6, 7, 8], {4, 8}, [8], {"s": [0, 0, 0, 8]}),
        ([1, 2, 3, 4, 5, 6, 7, 8], {2, 4, 8}, [4], {"s": [0, 4]}),
        ([1, 2, 3, 4, 5, 6, 7, 8], {0, 8}, [], {"s": []}),
    ],
    "uint8[8] s": [
        ([1, 2, 3, 4, 5, 6, 7, 8], {4, 8}, [1], {"s": [1, 0, 0, 0]}),
        ([1, 2, 3, 4, 5, 6, 7, 8], {4, 8}, [8], {"s": [0, 0, 0, 8]}),
        ([1, 2, 3, 4, 5, 6, 7, 8], {2, 4, 8}, [4], {"s": [0, 4]}),
        ([1, 2, 3, 4, 5, 6, 7, 8], {1, 8}, [], {"s": [0]}),
    ],
    "uint8[5] s": [
        ([1, 2, 3, 4, 5], {3, 5}, [], {"s": [0, 0, 0]}),
        ([1, 2, 3, 4, 5], {2, 5}, [], {"s": [0, 0]}),
    ],
}


@pytest.mark.parametrize(
    ("text", "value", "sizes", "needed", "least"),
    [(text, *case) for text, cases in HALVES.items() for case in cases],
)
def test_each_half_of_a_value_is_tried_alone(make_message, text, value, sizes, needed, least):
    def shows(_, value):
        return len(value["s"]) in sizes and all(each in value["s"] for each in needed)

    _, found = shrink(make_message, shows, text, {"s": value})
    assert found == least


@pytest.mark.parametrize(
    ("sizes", "needed", "kept"),
    [
        ({4, 8}, "a", "abcd"),
        ({4, 8}, "h", "efgh"),
        ({2, 4, 8}, "c", "cd"),
        # A quarter is taken out, and one field alone.
        ({6, 8}, "", "cdefgh"),
        ({6, 8}, "ac", "abcdgh"),
        ({7, 8}, "", "bcdefgh"),
        ({7, 8}, "abcdefg", "abcdefg"),
    ],
)
def test_each_half_and_quarter_of_the_fields_is_taken_out(make_message, sizes, needed, kept):
    def shows(all_, _):
        return len(all_) in sizes and {*needed} <= all_.keys()

    text = "\n".join(f"uint8 {name}" for name in "abcdefgh")
    lines, _ = shrink(make_message, shows, text, dict.fromkeys("abcdefgh", 1))
    assert lines == [f"uint8 {name}" for name in kept]


def test_an_element_keeps_the_type_that_it_needs(make_message):
    def shows(_, value):
        return any(isinstance(each, list) and len(each) > 1 for each in value.values())

    lines, value = shrink(make_message, shows, "uint8 a\nB[] many", {"a": 1, "many": [POINT] * 3})
    (items,) = value.values()
    assert len(items) == 2
    # One field of the element is left, because the type of an element needs a field.
    assert lines[0] == "B[] many" or lines[0].endswith("B[] many")
    assert all(len(each) <= 1 for each in items)


def test_fields_of_one_name_in_two_types_are_two_fields(make_message):
    message = make_message("Left l\nRight[] r", Left="uint8 x\nuint8 k", Right="uint8 x\nuint8 y")
    right = {"x": 3, "y": 4}
    value = {"l": {"x": 1, "k": 2}, "r": [right, right]}

    def again(message, what, value):
        is_shown = "k" in value.get("l", {}) and any("x" in each for each in value.get("r", []))
        return replace(finding, message=message, value=value) if is_shown else None

    finding = Finding(
        library="", reference="", wire="cdr", what="decode", message=message, value=value,
        packet=b"", expected=None, got=None,
    )  # fmt: skip
    found = shrunk(finding, again)
    assert found.value == {"l": {"k": 0}, "r": [{"x": 0}]}
    head, *others = full_text(found.message).split("=" * 80 + "\n")
    assert head == "p/Left l\np/Right[] r\n"
    assert sorted(others) == ["MSG: p/Left\nuint8 k\n", "MSG: p/Right\nuint8 x\n"]


def test_shrinking_ends_at_the_time_limit(make_message):
    message = make_message("uint8 a\nuint8 b")
    finding = Finding(
        library="", reference="", wire="cdr", what="decode", message=message,
        value={"a": 1, "b": 1}, packet=b"", expected=None, got=None,
    )  # fmt: skip
    same = lambda message, what, value: replace(finding, message=message, value=value)  # noqa: E731
    assert shrunk(finding, same, seconds=-1) is finding
    assert shrunk(finding, lambda *_: None) is finding
    # Candidates of the same size are refused; otherwise, shrinking would not end.
    assert shrunk(finding, lambda *_: replace(finding)) is finding


def test_times_stay_whole_and_values_keep_their_kinds(make_message):
    """A time has no definition of its own, so no part of one can be taken out."""
    message = make_message("uint8 a\ntime t\ntime[2] many\nB b", "noetic", B="duration d\nbool f")
    times = {"secs": 5, "nsecs": 6}
    value = {"a": 1, "t": times, "many": [times, times], "b": {"d": times, "f": True}}
    asked = []

    def again(message, what, value):
        asked.append(message)
        kept = [each for name, each in all_items(value) if name in ("t", "d")]
        is_shown = len(kept) > 0 and "f" in dict(all_items(value))
        return replace(finding, message=message, value=value) if is_shown else None

    finding = Finding(
        library="", reference="", wire="ros1", what="decode", message=message, value=value,
        packet=b"", expected=None, got=None,
    )  # fmt: skip
    found = shrunk(finding, again)
    assert repr(found.value) == repr({"d": times, "f": False})
    whole = message.fields[1].type
    for each in asked:
        assert each.package
        inner = [kind for kind in closure([each]) if kind.name in ("time", "duration")]
        assert all(len(kind.fields) == len(whole.fields) == 2 for kind in inner)
