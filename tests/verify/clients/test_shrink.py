"""Shrinking a difference to the smallest type and value that still show it."""

from __future__ import annotations

from dataclasses import replace

import pytest

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
