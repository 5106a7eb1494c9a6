"""Plans that belong to a layout, and plans that nearly do."""

from __future__ import annotations

from dataclasses import replace

import pytest

from firm_hdl.plan import build_plan, check
from firm_hdl.wire import lay_out
from tests.strategies import make

BYTE = make("ros2", {"a": "uint8"})


def of_rows(kind):
    """Return the layout of a sequence of rows, each with one field."""
    return lay_out(make("ros2", {"rows": (make("ros2", {"x": kind}, "Row"), "[]")}))


@pytest.mark.parametrize(
    "layout",
    # Another type with the same fields, and another wire format with the same leaves.
    [lay_out(make("ros2", {"a": "uint8"}, "Other")), lay_out(BYTE, "ros1")],
)
def test_a_plan_of_another_type_or_wire_format_is_named(layout):
    plan = build_plan(lay_out(BYTE))
    assert check(plan, lay_out(BYTE)) == []
    assert check(plan, layout) == ["the plan is of p/msg/T on cdr"]


@pytest.mark.parametrize("bus_bytes", [1, 2, 4, 8])
@pytest.mark.parametrize("count", [1, 2, 3])
def test_an_array_of_items_wider_than_the_bus_is_a_loop_of_as_many(count, bus_bytes):
    layout = lay_out(make("ros2", {"w": f"uint64[{count}]"}))
    plan = build_plan(layout, bus_bytes=bus_bytes)
    assert check(plan, layout) == []
    more = lay_out(make("ros2", {"w": f"uint64[{count + 1}]"}))
    assert check(build_plan(more, bus_bytes=bus_bytes), layout)
    assert check(plan, more)


def test_counts_of_loops_are_compared_in_wire_order():
    """The loop after a sequence may follow its length at once, before the loops in its elements."""
    row = make("ros1", {"x": "uint8", "s": "string"}, "Row")

    def layout_of(*counts):
        first, second, third = (f"[{count}]" for count in counts)
        element = make("ros1", {"m": (row, first), "n": (row, second)}, "Element")
        return lay_out(make("ros1", {"e": (element, "[]"), "f": (row, third)}))

    layout = layout_of(2, 5, 3)
    assert check(build_plan(layout), layout) == []
    for counts in ((2, 3, 5), (5, 2, 3), (2, 5, 4)):
        assert check(build_plan(layout_of(*counts)), layout)


@pytest.mark.parametrize(
    ("kind", "counted"),
    # Lengths that may claim 4,096 bytes are counted; the NUL is one of them.
    [
        *(("string<=4095", True), ("string<=4094", False)),
        *(("uint8[<=4096]", True), ("uint8[<=4095]", False)),
        *(("float64[<=512]", True), ("float64[<=511]", False)),
    ],
)
def test_claims_are_those_of_the_layout(kind, counted):
    layout = of_rows(kind)
    plan = build_plan(layout)
    assert [begin.claim is not None for begin in plan.begins.values()] == [counted] * 2
    assert check(plan, layout) == []


def test_a_claim_that_the_layout_does_not_have_is_named():
    layout = of_rows("uint8[<=4096]")
    first, *others = build_plan(layout).steps
    claim = first.begin.claim
    for changes in (
        {"bytes": claim.bytes + 1, "least": -(-4096 // (claim.bytes + 1))},
        {"total": claim.total - 4},
    ):
        begin = replace(first.begin, limit=9, claim=replace(claim, **changes))
        plan = replace(build_plan(layout), steps=(replace(first, begin=begin), *others))
        assert check(plan) == [] and check(plan, layout) == [
            "rows claims other bytes than in the layout"
        ]
