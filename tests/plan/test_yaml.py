"""Plans as text: the printed form, and error messages for mistakes in it."""

from __future__ import annotations

import re

import pytest
import yaml

from firm_hdl.plan import Pad, build_plan, from_yaml, to_yaml
from firm_hdl.wire import RULES, lay_out
from tests.depth import by_depth
from tests.plan.check.broken_plans import PLANS, damaged
from tests.steps import calls_at_most
from tests.strategies import BUS_WIDTHS, make

POINT = make("ros2", {"x": "uint8", "name": "string"}, "Point")
MESSAGE = make("ros2", {"stamp": "uint32", "points": (POINT, "[<=5]"), "grid": "float32[5]"})

BODY = """\
message: p/msg/T
wire: cdr
bus_bytes: 8
max_message_bytes: 280
header_bytes: 4
max_trailing_bytes: 3
levels: 1
leaves:
  stamp: uint32
  points.length: length
  points.item.x: uint8
  points.item.name.length: length
  points.item.name.items: uint8 x 8
  grid.items: float32 x 2
runs:
  points.item.name.items: [counted, with NUL]
  grid.items: [constant count, with tail]
start: step 0
steps:
  step 0:  # packet bytes 0..11
    0..1: (00 01 checked)
    2..3: (00 00 ignored)
    4..7: stamp
    8..11: points.length
    starts: {loop: 0, count: points.length, limit: 5, body: step 1}
    next: step 4
  step 1:  # in loop 0 (points.length)
    rest of: points.item.name.items
    0: points.item.x
    next: step 2
  step 2:  # in loop 0 (points.length)
    align: 4
    0..3: points.item.name.length
    starts: {run: points.item.name.items, count: points.item.name.length, limit: 247, body: step 3}
    next: {loop 0 again: step 1, else: step 4}
  step 3:  # in loop 0 (points.length)
    words of: points.item.name.items
    next: {loop 0 again: step 1, else: step 4}
  step 4:
    rest of: points.item.name.items
    next: step 5 with run = 4
  step 5:
    align: 4
    words of: grid.items
    next: step 6
  step 6:
    0..3: grid.items, 1 item, last
    next: end
"""


def text_of(message, **options):
    return to_yaml(build_plan(lay_out(message), **options))


def body_of(text):
    return "".join(line for line in text.splitlines(True) if not line.startswith("#"))


def test_a_plan_prints_as_an_engineer_reads_it():
    assert body_of(text_of(MESSAGE, max_message_bytes=280)) == BODY


@pytest.mark.parametrize("bus_bytes", BUS_WIDTHS)
def test_reading_gives_the_same_plan(bus_bytes):
    plan = build_plan(lay_out(MESSAGE), bus_bytes=bus_bytes)
    text = to_yaml(plan)
    assert from_yaml(text) == plan
    assert from_yaml(body_of(text)) == plan
    assert to_yaml(from_yaml(text)) == text


@pytest.mark.parametrize("bus_bytes", [1, 8])
def test_names_that_yaml_takes_for_values_stay_names(bus_bytes):
    names = ["yes", "no", "on", "off", "true", "null", "y", "NO", "pad", "x1", "e1"]
    message = make("ros1", dict.fromkeys(names, "uint16"))
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
    text = to_yaml(plan)
    assert from_yaml(text) == plan
    # The quotes make other readers of YAML see names, too.
    assert list(yaml.safe_load(text)["leaves"]) == names
    if bus_bytes == 8:
        assert list(yaml.safe_load(text)["steps"]["step 0"].values())[:4] == names[:4]


def test_what_lengths_claim_is_printed_and_read():
    names = make("ros1", {"names": "string[]"}, "Names")
    plan = build_plan(lay_out(names), max_message_bytes=65_536)
    text = to_yaml(plan)
    assert "claims: 4 from 1024 of 65532" in text
    assert "claims: 1 from 4096" in text
    assert from_yaml(text) == plan
    # Only plans with claims explain them.
    assert "#   claims: " in text
    assert "#   claims: " not in text_of(make("ros1", {"a": "string"}))
    with pytest.raises(ValueError, match=r"^Line \d+: '4 of 9' is not what a length claims$"):
        from_yaml(text.replace("4 from 1024 of 65532", "4 of 9"))


PAIRS = make("ros1", {"p": (make("ros1", {"x": "uint8"}, "X"), "[2]")}, "Pairs")


def test_a_jump_into_loops_names_each_counter():
    plan = build_plan(lay_out(make("ros1", {"s": "string", "grid": (PAIRS, "[3]"), "a": "byte"})))
    text = to_yaml(plan)
    assert "    next: step 3 with loop 0 = 3; loop 1 = 2\n" in text
    again = "{loop 1 again: step 3, loop 0 again: step 3 with loop 1 = 2, else: step 4}"
    assert f"    next: {again}\n" in text
    assert from_yaml(text) == plan


@pytest.mark.parametrize(
    ("which", "changes"),
    [
        ("pair", {"steps.0.bytes": 11}),
        ("pair", {"steps.0.bytes": 13}),
        ("pair", {"steps.0.slices.1.size": 12}),
        ("pair", {"steps.0.slices.1.size": 4}),
        ("pair", {"steps.0.slices.0.first": 1}),
        ("cut", {"steps.1.slices.0.first": 3}),
        ("cut", {"steps.1.slices.0.bytes": 1}),
        ("side", {"steps.0.slices.1.at": 5}),
        ("side", {"steps.0.align": 4}),
        ("last", {"start.step": None}),
        ("last", {"start.enter": ((0, 2), ("run", 3), (1, 4))}),
        ("last", {"leaves.1.kind": "items"}),
        ("trigger", {"steps.0.slices.0": Pad(at=0, bytes=3)}),
        ("nested", {"steps.1.begin.claim.saved": 14}),
        ("nested", {"steps.0.begin.claim.saved": 14}),
        ("nested", {"steps.1.begin.claim.total": 9}),
        ("nested", {"steps.0.begin.claim": None}),
        ("gap", {"steps.2.begin.align": 4}),
        ("text", {"runs.0.last": False}),
        ("text", {"runs.0.counted": False}),
        ("text", {"runs.0.terminated": True}),
    ],
)
def test_a_plan_that_is_not_sound_is_printed_and_read_too(which, changes):
    """What a user has edited is shown as it is; `check` reports it."""
    plan = PLANS[which]
    for path, new in changes.items():
        plan = damaged(plan, path.split("."), new)
    assert plan != PLANS[which]
    assert from_yaml(to_yaml(plan)) == plan


MISTAKES = [
    ("", "", "Line 1: a plan must be a mapping, not empty"),
    (BODY, "[1, 2]", "Line 1: a plan must be a mapping"),
    ("wire: cdr\n", "", "Line 1: the plan has no 'wire'"),
    ("wire: cdr", "wire: can", f"Line 2: wire must be {' or '.join(map(repr, RULES))}, not 'can'"),
    ("wire: cdr", "wire: cdr\nwires: 2", "Line 3: a plan has no 'wires'"),
    ("bus_bytes: 8", "bus_bytes: wide", "Line 3: bus_bytes must be a number, not 'wide'"),
    ("bus_bytes: 8", "bus_bytes: -8", "Line 3: bus_bytes must be a number, not '-8'"),
    ("bus_bytes: 8", "bus_bytes: \u00b2", "Line 3: bus_bytes must be a number, not '\u00b2'"),
    ("bus_bytes: 8", "bus_bytes: [8]", "Line 3: bus_bytes must be a single value"),
    ("stamp: uint32", "stamp: uint31", "Line 9: 'uint31' is not a primitive"),
    ("stamp: uint32", "stamp: a b c", "Line 9: 'a b c' is not a leaf"),
    ("stamp: uint32", "stamp: signed bool", "Line 9: 'bool' cannot be signed"),
    ("  points.length: length", "  stamp: uint8", "Line 10: leaves has 'stamp' twice"),
    ("4..7: stamp", "4..7: stomp", "Line 23: the plan has no leaf 'stomp'"),
    ("4..7: stamp", "4..6: stamp", "Line 23: 'stamp' has 4 bytes, not 3"),
    ("4..7: stamp", "4..7: stamp?", "Line 23: 'stamp?' is not a leaf, padding or fixed bytes"),
    ("4..7: stamp", "four: stamp", "Line 23: a step has no 'four'"),
    ("(00 01 checked)", "(00 checked)", "Line 21: 1 fixed bytes do not fill a slice of 2"),
    ("next: step 4\n", "next: stop 4\n", "Line 26: 'stop 4' is not a jump (next)"),
    ("    next: step 4\n", "", "Line 21: the step has no 'next'"),
    ("with run = 4", "with run 4", "Line 41: 'run 4' is not a counter and a number"),
    ("with run = 4", "with run = 4 of 5", "Line 41: 'run = 4 of 5' is not a counter and a number"),
    ("with run = 4", "with a run = 4", "Line 41: 'a run = 4' is not a counter and a number"),
    ("  step 2:", "  step 9:", "Line 32: expected step 2, not 'step 9'"),
    ("limit: 5, ", "", "Line 25: starts needs 'count', 'limit' and 'body'"),
    ("count: points.length, ", "", "Line 25: starts needs 'count', 'limit' and 'body'"),
    (", body: step 1}", "}", "Line 25: starts needs 'count', 'limit' and 'body'"),
    ("limit: 247, body: step 3", "limit: 967",
     "Line 34: starts needs 'count', 'limit' and 'body'"),
    ("limit: 5, ", "limit: 5, most: 5, ", "Line 25: starts has no 'most'"),
    ("{loop: 0, ", "{", "Line 25: starts has one of 'run' and 'loop'"),
    ("{loop: 0, ", "{loop: 0, run: grid.items, ", "Line 25: starts has one of 'run' and 'loop'"),
    ("limit: 5, ", "limit: 5, align: 4, ", "Line 25: a loop that starts has no 'align'"),
    ("limit: 247, ", "limit: 967, align: four, ", "Line 34: align must be a number, not 'four'"),
    ("run: points.item.name.items, ", "run: points, ", "Line 34: the plan has no run 'points'"),
    ("rest of: points.item.name.items", "rest of: points.item.x",
     "Line 28: the plan has no run 'points.item.x'"),
    ("words of: grid.items\n", "words of: grid\n", "Line 44: the plan has no run 'grid'"),
    *[
        ("words of: grid.items\n", f"words of: grid.items\n    {entry}\n",
         "Line 43: a step with 'words of' has no rest, bytes or start of its own")
        for entry in ("0: points.item.x", "bytes: 1", "starts: {limit: 1}", "rest of: grid.items")
    ],
    (", else: step 4}\n  step 3", "}\n  step 3", "Line 35: next has no 'else'"),
    ("next: {loop 0 again: step 1, else: step 4}", "next: {loops: step 1, else: step 4}",
     "Line 35: next has no 'loops'"),
    ("grid.items, 1 item, last", "grid.items, 1 item, bytes 0..2 of 4, last",
     "Line 47: the bytes of 'grid.items' are not as many as those of the slice"),
    ("grid.items, 1 item, last", "grid.items, 1 item, bytes 2 of 4, last",
     "Line 47: the bytes of 'grid.items' are not as many as those of the slice"),
    ("grid.items, 1 item, last", "grid.items, 1 item, last, last of loop 0",
     "Line 47: 'grid.items, 1 item, last, last of loop 0' is not a leaf, padding or fixed bytes"),
    ("[counted, with NUL]", "[counted, NUL there]",
     "Line 16: run 'points.item.name.items' has no 'NUL there'"),
    ("[counted, with NUL]", "[with NUL]",
     "Line 16: run 'points.item.name.items' must have one of 'counted' and 'constant count'"),
    ("[counted, with NUL]", "[counted, constant count]",
     "Line 16: run 'points.item.name.items' must have one of 'counted' and 'constant count'"),
    ("wire: cdr", "wire: [cdr", "Line 3: not YAML: "),
    ("wire: cdr", "wire: \0cdr", "Line 2: not YAML: "),
    ("wire: cdr", "wire: &a [*a]", "Line 2: a plan has no aliases"),
    ("stamp: uint32", "stamp: &a uint32\n  also: *a", "Line 9: a plan has no aliases"),
    ("wire: cdr", f"wire: {'[' * 99}{']' * 99}", "Line 2: a plan is not nested so deep"),
    ("bus_bytes: 8", f"bus_bytes: {'8' * 5000}",
     f"Line 3: bus_bytes must be a number, not '{'8' * 367}..."),
    ("4..7: stamp", f"4..{'7' * 30}: stamp", f"Line 23: a step has no '4..{'7' * 30}'"),
    ("next: step 4\n", f"next: step {'4' * 5000}\n", f"Line 26: 'step {'4' * 394}..."),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "message"), MISTAKES)
def test_mistake_is_reported_with_its_line(old, new, message):
    text = BODY.replace(old, new, 1) if old else new
    assert text != BODY
    with pytest.raises(ValueError, match="^" + re.escape(message)) as caught:
        from_yaml(text)
    if not message.endswith(": "):
        assert str(caught.value) == message


def test_a_large_plan_is_read_in_time():
    inner = make("ros2", {f"f{n}": ["uint8", "float64", "string"][n % 3] for n in range(60)}, "I")
    fields = by_depth(50, 150)
    message = make("ros2", {f"field{n}": inner for n in range(fields)})
    plan = build_plan(lay_out(message))
    assert len(plan.leaves) == 80 * fields
    with calls_at_most(10_000_000 * fields // 150):
        assert from_yaml(to_yaml(plan)) == plan
