"""The closure of a type: parts before the whole, each once, at any depth."""

from __future__ import annotations

from firm_hdl.model import Field, Message, Sequence, closure


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
