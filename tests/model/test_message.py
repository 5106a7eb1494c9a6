"""What a message type says of itself: its names, its parts, its size."""

from __future__ import annotations

from dataclasses import replace

import pytest

from firm_hdl.errors import Source, Span
from firm_hdl.model import (
    PRIMITIVES,
    Action,
    Array,
    Field,
    Message,
    Sequence,
    Service,
    String,
    is_fixed_size,
)

INT8 = PRIMITIVES["ros2"]["int8"]


def message(name, **fields):
    parts = tuple(Field(name=field, type=kind) for field, kind in fields.items())
    return Message(name=name, dialect="ros2", fields=parts)


EMPTY = message("p/msg/Empty")
PAIR = message("p/msg/Pair", a=INT8, b=Array(element=INT8, count=7))
TEXT = message("p/msg/Text", a=String(), b=INT8)
OTHER_PAIR = message("q/msg/Pair", a=EMPTY)
DEEP = message(
    "p/msg/Deep",
    a=PAIR,
    b=Sequence(element=OTHER_PAIR),
    c=Array(element=PAIR, count=3),
    d=TEXT,
    e=Sequence(element=String()),
)
TOP = message("p/msg/Top", a=Array(element=DEEP, count=2), b=EMPTY, c=DEEP)


def test_names():
    assert [str(each) for each in (TOP, OTHER_PAIR)] == ["p/msg/Top", "q/msg/Pair"]
    assert (OTHER_PAIR.package, OTHER_PAIR.base_name) == ("q", "Pair")
    time = Message(name="time", dialect="ros1", fields=())
    assert (time.package, time.base_name, time.wire) == ("", "time", "ros1")
    assert PAIR.wire == "cdr"


def test_children_are_listed_once_in_the_order_of_the_fields():
    assert DEEP.children == (PAIR, OTHER_PAIR, TEXT)
    assert TOP.children == (DEEP, EMPTY)
    assert PAIR.children == ()


def test_depth_counts_the_levels_of_messages():
    assert [each.depth for each in (EMPTY, PAIR, OTHER_PAIR, DEEP, TOP)] == [1, 1, 2, 3, 4]


def test_leaves_are_fields_that_are_no_messages_and_messages_without_fields():
    assert [each.leaf_count for each in (EMPTY, PAIR, TEXT, OTHER_PAIR)] == [1, 2, 2, 1]
    # PAIR twice, OTHER_PAIR, TEXT, and the strings.
    assert DEEP.leaf_count == 2 + 1 + 2 + 2 + 1
    assert TOP.leaf_count == 8 + 1 + 8


@pytest.mark.parametrize(
    ("kind", "is_fixed"),
    [
        (INT8, True),
        (Array(element=INT8, count=3), True),
        (Sequence(element=INT8), False),
        (Sequence(element=INT8, bound=3), False),
        (String(), False),
        (String(bound=3), False),
        (Array(element=String(), count=3), False),
        (EMPTY, True),
        (PAIR, True),
        (Array(element=PAIR, count=3), True),
        (Sequence(element=PAIR), False),
        (Sequence(element=EMPTY), False),
        (TEXT, False),
        (Array(element=TEXT, count=3), False),
    ],
)
def test_size_is_fixed_without_sequences_and_strings_at_any_level(kind, is_fixed):
    assert is_fixed_size(kind) is is_fixed
    assert message("p/msg/M", a=INT8, b=kind).is_fixed_size is is_fixed
    assert message("p/msg/M", a=kind, b=INT8).is_fixed_size is is_fixed
    inner = message("p/msg/M", a=kind)
    assert message("p/msg/N", a=PAIR, b=inner, c=PAIR).is_fixed_size is is_fixed


@pytest.mark.parametrize("attribute", ["depth", "leaf_count", "is_fixed_size"])
def test_nesting_has_no_limit(attribute):
    """Some of the messages below have the attribute already."""
    top = PAIR
    for number in range(3000):
        top = message(f"p/msg/M{number}", a=top, b=PAIR)
        if number == 40:
            getattr(top, attribute)
    want = {"depth": 3001, "leaf_count": 2 * 3001, "is_fixed_size": True}
    assert getattr(top, attribute) == want[attribute]


def test_messages_of_different_contents_are_different():
    assert message("p/msg/Pair", a=INT8) != PAIR and PAIR != OTHER_PAIR
    again = message("p/msg/Pair", a=INT8, b=Array(element=INT8, count=7))
    assert again == PAIR and len({again, PAIR, OTHER_PAIR}) == 2
    # Texts and comments mean nothing.
    told = replace(PAIR, text="int8 a", comment="Two.")
    assert told == PAIR and len({told, PAIR}) == 1
    assert replace(PAIR, dialect="ros1") != PAIR


@pytest.mark.parametrize(
    ("kind", "text"),
    [
        (INT8, "int8"),
        (String(), "string"),
        (String(bound=5), "string<=5"),
        (String(wide=True), "wstring"),
        (String(wide=True, bound=5), "wstring<=5"),
        (Array(element=String(bound=5), count=2), "string<=5[2]"),
        (Sequence(element=PAIR), "p/msg/Pair[]"),
        (Sequence(element=INT8, bound=9), "int8[<=9]"),
    ],
)
def test_types_are_written_as_in_definitions(kind, text):
    assert str(kind) == text
    assert Field(name="a", type=kind).type_text == text


def test_length_of_an_array_is_written_as_in_the_text_of_its_own_line():
    text = "int8[003] x\nint8[3] a\nint8[010] b # [07]\nint8[010]\tc\n"
    source = Source(name="M.msg", text=text)

    def type_text(name, count, at):
        span = Span(source=source, start=at, end=at + 1)
        return Field(name=name, type=Array(element=INT8, count=count), span=span).type_text

    assert type_text("x", 3, text.index("x")) == "int8[003]"
    assert type_text("a", 3, text.index("a\n")) == "int8[3]"
    assert type_text("b", 10, text.index("b #")) == "int8[010]"
    assert type_text("c", 10, text.index("c\n")) == "int8[010]"


def test_messages_of_interfaces_are_all_that_are_on_a_wire():
    one, two, three, four, five, six, seven, eight = (message(f"p/msg/M{n}") for n in range(8))
    quiet = Service(name="p/srv/S", dialect="ros2", request=one, response=two)
    told = Service(name="p/srv/T", dialect="ros2", request=three, response=four, event=five)
    assert (str(quiet), quiet.messages, told.messages) == ("p/srv/S", (one, two),
                                                           (three, four, five))  # fmt: skip
    action = Action(name="p/action/A", dialect="ros2", goal=six, result=seven, feedback=eight,
                    services=(told, quiet), wrappers=(PAIR, TEXT))  # fmt: skip
    assert str(action) == "p/action/A"
    assert action.messages == (six, seven, eight, three, four, five, one, two, PAIR, TEXT)
    assert one.messages == (one,)
