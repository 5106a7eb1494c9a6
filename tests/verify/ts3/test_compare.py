"""Every part of the comparison of a run: exactly the differences are reported."""

from __future__ import annotations

from dataclasses import replace

import pytest

from firm_hdl.gateware.signatures import Status
from firm_hdl.plan import build_plan
from firm_hdl.sim.harness import RunResult
from firm_hdl.verify.ts3.compare import Expected, run_differences
from firm_hdl.wire import lay_out
from tests.strategies import make

PLAN = build_plan(lay_out(make("ros1", {"x": "int8", "s": "string"})), bus_bytes=2)
PACKETS = [b"\1\3\0\0\0abc", b"\2\0\0\0\0", b""]
TRANSFERS = {
    0: [1, 2, 0],
    1: [3, 0, 0],
    2: [((97, 98), False), ((99, 0), True)],
}
SEEN = RunResult(
    packets=PACKETS,
    packet_errors=[False, False, True],
    statuses=[Status.OK, Status.OK, Status.TRUNCATED],
    sent_statuses=[Status.OK, Status.OK, Status.ITEMS],
    transfers=TRANSFERS,
)
WANTED = Expected(
    packets=PACKETS,
    transfers=[
        {("x",): [1], ("s", "length"): [3], ("s", "items"): TRANSFERS[2]},
        {("x",): [2], ("s", "length"): [0]},
        {("x",): [0], ("s", "length"): [0]},
    ],
    statuses=["OK", "OK", "TRUNCATED"],
    sent_statuses=["OK", "OK", "ITEMS"],
)
NAMES = ("one", "two", "three")


def differences_of(**changes):
    return list(run_differences("here", PLAN, replace(SEEN, **changes), WANTED, NAMES))


@pytest.mark.parametrize(
    ("packets", "output"),
    [
        # A bit, a byte more or fewer, a packet more or fewer, another order.
        ([*PACKETS[:1], b"\2\0\0\1\0", b""], "packet 1 of 3 differs at byte 3: 0200000100 instead"),
        ([PACKETS[0] + b"\0", *PACKETS[1:]], "packet 0 of 3 differs at byte 8: 010300000061626300"),
        (
            [PACKETS[0][:-1], *PACKETS[1:]],
            "packet 0 of 3 differs at byte 7: 01030000006162 instead",
        ),
        ([*PACKETS[:2], b"\0"], "packet 2 of 3 differs at byte 0: 00 instead of  (three)"),
        (PACKETS[:2], "2 packets instead of 3"),
        ([*PACKETS, b""], "4 packets instead of 3"),
        ([PACKETS[1], PACKETS[0], b""], "packet 0 of 3 differs at byte 0: "),
    ],
)
def test_packets(packets, output):
    (difference,) = differences_of(packets=packets)
    assert difference.startswith(f"here: {output}")


@pytest.mark.parametrize(
    ("leaf", "payloads", "output"),
    [
        (0, [1, 3, 0], "leaf x, transfer 1 of 3: [3] instead of [2] (two)"),
        (0, [1, 2], "leaf x, transfer 2 of 3: [] instead of [0] (three)"),
        (0, [1, 2, 0, 0], "leaf x, transfer 3 of 3: [0] instead of []"),
        (0, [], "leaf x, transfer 0 of 3: [] instead of [1] (one)"),
        # The last message is damaged, but its transfers count.
        (0, [1, 2, 3], "leaf x, transfer 2 of 3: [3] instead of [0] (three)"),
        (1, [3, 0, 1], "leaf s.length, transfer 2 of 3: [1] instead of [0] (three)"),
        (2, [((97, 98), False), ((99, 0), False)], "leaf s.items, transfer 1 of 2: [((99, 0), F"),
        (2, [((97, 98), False), ((99, 1), True)], "leaf s.items, transfer 1 of 2: [((99, 1), T"),
        (2, [*TRANSFERS[2], ((0, 0), True)], "leaf s.items, transfer 2 of 2: [((0, 0), True)] in"),
    ],
)
def test_transfers(leaf, payloads, output):
    (difference,) = differences_of(transfers={**TRANSFERS, leaf: payloads})
    assert difference.startswith(f"here: {output}")


@pytest.mark.parametrize("field", ["statuses", "sent_statuses"])
@pytest.mark.parametrize(
    ("change", "output"),
    [
        (lambda right: [Status.STRING, *right[1:]], " of packet 0 is STRING instead of OK (one)"),
        (lambda right: [*right[:2], Status.OK], " of packet 2 is OK instead of "),
        (lambda right: right[:2], ": 2 instead of 3"),
        (lambda right: [*right, Status.OK], ": 4 instead of 3"),
    ],
)
def test_statuses(field, change, output):
    (difference,) = differences_of(**{field: change(getattr(SEEN, field))})
    what = {"statuses": "status", "sent_statuses": "sent_status"}[field]
    assert difference.startswith(f"here: {what}{output}")


@pytest.mark.parametrize(
    "marked",
    [
        [True, False, True],
        [False, False, False],
        [False, False],
        [False, False, True, False],
        [],
    ],
)
def test_marks(marked):
    (difference,) = differences_of(packet_errors=marked)
    assert difference == f"here: packet_error is {marked} instead of [False, False, True]"


def test_leaves_that_are_missing_or_unknown():
    assert len(differences_of(transfers={})) == 3
    more = [{**WANTED.transfers[0], ("y",): [1]}, *WANTED.transfers[1:]]
    found = list(run_differences("here", PLAN, SEEN, replace(WANTED, transfers=more), NAMES))
    assert found == ["here: no leaves y"]
