"""The closure of a type: parts before the whole, each once, at any depth; and changed messages."""

from __future__ import annotations

from dataclasses import replace

from firm_hdl.model import (
    PRIMITIVES,
    Array,
    Constant,
    Field,
    Message,
    Sequence,
    String,
    closure,
    map_messages,
)


def message(name, *parts):
    fields = tuple(
        Field(name=f"f{index}", type=Sequence(element=part) if index % 2 else part)
        for index, part in enumerate(parts)
    )
    return Message(name=f"p/msg/{name}", dialect="ros2", fields=fields)


def test_parts_come_first_and_once():
    a = message("A")
    b, c = message("B", a), message("C", a, a)
    d = message("D", c, b)
    assert [m.base_name for m in closure([d])] == ["A", "C", "B", "D"]
    assert [m.base_name for m in closure([b, d, a])] == ["A", "B", "C", "D"]
    assert closure([]) == []


def test_nesting_may_be_deeper_than_pythons_recursion_limit():
    top = message("L0")
    for level in range(1, 5000):
        top = message(f"L{level}", top)
    assert [m.base_name for m in closure([top])] == [f"L{level}" for level in range(5000)]


def test_types_can_come_before_their_parts_in_the_order_of_the_fields():
    x, d = message("X"), message("D")
    b = message("B", d, x)
    a = message("A", b, x, d)
    assert [m.base_name for m in closure([a], parts_first=False)] == ["A", "B", "D", "X"]
    assert [m.base_name for m in closure([x, a], parts_first=False)] == ["X", "A", "B", "D"]


def test_every_message_is_rebuilt_once_and_after_its_parts():
    int8 = PRIMITIVES["ros2"]["int8"]
    limit = Constant(name="MAX", type=int8, value=3)
    a = message("A")
    b = Message(name="p/msg/B", dialect="ros2", constants=(limit,), fields=(
        Field(name="a", type=a),
        Field(name="some", type=Sequence(element=a, bound=5)),
        Field(name="three", type=Array(element=a, count=3)),
        Field(name="number", type=int8, default=7),
        Field(name="texts", type=Array(element=String(bound=4), count=2)),
    ))  # fmt: skip
    top = message("Top", b, a)
    seen = []

    def change(part):
        seen.append((part.base_name, [str(field.type) for field in part.fields]))
        return replace(part, name=f"{part.name}2")

    found = map_messages(top, change)
    assert seen == [
        ("A", []),
        ("B", ["p/msg/A2", "p/msg/A2[<=5]", "p/msg/A2[3]", "int8", "string<=4[2]"]),
        ("Top", ["p/msg/B2", "p/msg/A2[]"]),
    ]
    assert [part.name for part in closure([found])] == ["p/msg/A2", "p/msg/B2", "p/msg/Top2"]
    new = found.fields[0].type
    assert (new.constants, new.fields[3]) == ((limit,), b.fields[3])
    # The type that was given stays as it was.
    assert str(top.fields[0].type) == "p/msg/B" and map_messages(top, lambda part: part) == top
