"""Missing transfers of a message, leaf by leaf, and boundaries between messages."""

from __future__ import annotations

import numpy as np
import pytest

from firm_hdl.plan import build_plan
from firm_hdl.sim.record import RunResult
from firm_hdl.sim.transfers import PendingTransfers, split_transfers, transfer_table
from firm_hdl.sim.values import to_transfers
from firm_hdl.wire import lay_out
from tests.strategies import make

POINT = make("ros1", {"x": "uint8", "tags": "uint16[]"}, "Point")
FIELDS = {"a": "uint8", "s": "string", "f": "uint16[5]", "ps": (POINT, "[]"), "two": (POINT, "[2]")}
MESSAGE = make("ros1", FIELDS)
PLAN = build_plan(lay_out(MESSAGE), bus_bytes=4)
TABLE = transfer_table(PLAN, MESSAGE)
NUMBER = {str(leaf): index for index, leaf in enumerate(PLAN.leaves)}


def named(left):
    return {str(PLAN.leaves[leaf]): count for leaf, count in left.items()}


def taken(*steps):
    pending = PendingTransfers(TABLE)
    for name, payload in steps:
        pending.take(NUMBER[name], payload)
    return named(pending.counts)


START = {"a": 1, "s.length": 1, "f.items": 3, "ps.length": 1}
TWO = {"two.item.x": 2, "two.item.tags.length": 2}


def test_a_message_begins_with_what_every_message_has():
    # Five items, two per transfer.
    assert taken() == {**START, **TWO}


@pytest.mark.parametrize(
    ("steps", "changes"),
    [
        ([("a", 7)], {"a": 0}),
        ([("f.items", ((1, 2), False))], {"f.items": 2}),
        # Four characters per transfer: no character, a full transfer, and one character more.
        ([("s.length", 0)], {"s.length": 0}),
        ([("s.length", 4)], {"s.length": 0, "s.items": 1}),
        ([("s.length", 5)], {"s.length": 0, "s.items": 2}),
        ([("s.length", 5), ("s.items", ((0,) * 4, False))], {"s.length": 0, "s.items": 1}),
        # Elements add their own leaves.
        ([("ps.length", 0)], {"ps.length": 0}),
        ([("ps.length", 3)], {"ps.length": 0, "ps.item.x": 3, "ps.item.tags.length": 3}),
        (
            [("ps.length", 3), ("ps.item.tags.length", 3), ("ps.item.tags.length", 1)],
            {"ps.length": 0, "ps.item.x": 3, "ps.item.tags.length": 1, "ps.item.tags.items": 3},
        ),
        ([("two.item.x", 1)], {"two.item.x": 1}),
    ],
)
def test_each_transfer_changes_what_is_left(steps, changes):
    expected = {**START, **TWO, **changes}
    assert taken(*steps) == {name: count for name, count in expected.items() if count}


def test_arrays_in_arrays_multiply_their_transfers():
    cell = make("ros1", {"x": "uint8", "w": "uint16[5]"}, "Cell")
    row = make("ros1", {"cells": (cell, "[2]"), "raw": "uint8[6]"}, "Row")
    grid = make("ros1", {"rows": (row, "[3]"), "more": (row, "[]")})
    plan = build_plan(lay_out(grid), bus_bytes=4)
    number = {str(leaf): index for index, leaf in enumerate(plan.leaves)}
    pending = PendingTransfers(transfer_table(plan, grid))

    def rows(name, count):
        # Two items of two bytes, or four of one byte, per transfer.
        return {
            f"{name}.item.cells.item.x": 2 * count,
            f"{name}.item.cells.item.w.items": 3 * 2 * count,
            f"{name}.item.raw.items": 2 * count,
        }

    def counts():
        return {str(plan.leaves[leaf]): count for leaf, count in pending.counts.items()}

    assert counts() == {**rows("rows", 3), "more.length": 1}
    pending.take(number["more.length"], 5)
    assert counts() == {**rows("rows", 3), **rows("more", 5)}


def message(number):
    point = {"x": number, "tags": [number] * number}
    return {
        "a": number,
        "s": "x" * number,
        "f": [number, number + 1, number + 2, number + 3, number + 4],
        "ps": [point] * number,
        "two": [point, {"x": 9, "tags": []}],
    }


def test_transfers_are_cut_into_the_messages_that_they_make():
    parts = [to_transfers(PLAN, MESSAGE, message(number)) for number in (3, 0, 5)]
    leaves = range(len(PLAN.leaves))
    joined = {n: [each for part in parts for each in part.get(n, [])] for n in leaves}
    messages, rest = split_transfers(TABLE, joined)
    assert messages == [{n: each for n, each in part.items() if each} for part in parts]
    # The next transfer begins another message.
    assert named(rest.counts) == {**START, **TWO}


def test_missing_transfers_of_a_cut_message_are_named():
    part = to_transfers(PLAN, MESSAGE, message(3))
    assert part[NUMBER["a"]] == [3]
    part[NUMBER["a"]] = []
    part[NUMBER["ps.item.x"]].pop()
    messages, rest = split_transfers(TABLE, part)
    assert messages == [] and named(rest.counts) == {"a": 1, "ps.item.x": 1}


def test_records_of_two_runs_share_nothing():
    one, other = RunResult(), RunResult()
    for name in ("packets", "packet_errors", "statuses", "sent_statuses", "transfers"):
        assert getattr(one, name) is not getattr(other, name)


@pytest.mark.parametrize("value", [True, np.bool_(True), 1])
def test_a_truth_value_may_be_of_numpy(value):
    kind = make("ros1", {"b": "bool"})
    plan = build_plan(lay_out(kind), bus_bytes=4)
    assert to_transfers(plan, kind, {"b": value}) == {0: [1]}
    for wrong in (2, -1, 1.0, "1", None):
        with pytest.raises(TypeError, match="must be a bool"):
            to_transfers(plan, kind, {"b": wrong})
