"""Plans as text."""

from __future__ import annotations

import pytest
import yaml

from firm_hdl.plan import build_plan, to_yaml
from firm_hdl.plan.compare import compare
from firm_hdl.wire import lay_out
from tests.plan.broken_plans import PLANS, damaged
from tests.strategies import make

POINT = make("ros2", {"x": "uint8", "name": "string"}, "Point")
MESSAGE = make("ros2", {"stamp": "uint32", "points": (POINT, "[<=5]"), "grid": "float32[5]"})

BODY = """\
message: p/msg/T
wire: cdr
bus_bytes: 8
max_message_bytes: 280
leaves:
  stamp: uint32
  points.length: length
  points.item.x: uint8
  points.item.name.length: length
  points.item.name.items: uint8 x 8
  grid.items: float32 x 2
plan:
  - step:  # 0: packet bytes 0..11
      0..1: (00 01 checked)
      2..3: (00 00 ignored)
      4..7: stamp
      8..11: points.length
  - loop:
      count: points.length
      limit: 5
      body:
      - step:  # 1
          rest of: points.item.name.items
          0: points.item.x
      - step:  # 2
          align: 4
          0..3: points.item.name.length
      - run: points.item.name.items  # 3
        count: points.item.name.length, with NUL
        limit: 247
  - step:  # 4
      rest of: points.item.name.items
  - run: grid.items  # 5
    count: 4
    align: 4
    tail: follows
  - step:  # 6
      0..3: grid.items, 1 item, last
"""


def text_of(message, **options):
    return to_yaml(build_plan(lay_out(message), **options))


def body_of(text):
    return "".join(line for line in text.splitlines(True) if not line.startswith("#"))


def test_a_plan_prints_as_an_engineer_reads_it():
    assert body_of(text_of(MESSAGE, max_message_bytes=280)) == BODY


def test_names_that_yaml_takes_for_values_stay_names():
    names = ["yes", "no", "on", "off", "true", "null", "y", "NO", "pad", "x1", "e1"]
    document = yaml.safe_load(text_of(make("ros1", dict.fromkeys(names, "uint16"))))
    assert list(document["leaves"]) == names
    assert list(document["plan"][0]["step"].values()) == names[:4]


def test_what_lengths_claim_is_printed():
    text = text_of(make("ros1", {"names": "string[]"}, "Names"), max_message_bytes=65_536)
    assert "charge: 4 from 1024 of 65532\n" in text
    assert "charge: 1 from 4096\n" in text
    # Only plans with charges explain them.
    assert "#   charge: " in text
    assert "#   charge: " not in text_of(make("ros1", {"a": "string"}))


def test_loops_inside_each_other_are_lists_inside_each_other():
    pairs = make("ros1", {"p": (make("ros1", {"x": "uint8"}, "X"), "[2]")}, "Pairs")
    loop = yaml.safe_load(text_of(make("ros1", {"grid": (pairs, "[3]"), "a": "byte"})))["plan"][0]
    step = {"step": {0: "grid.item.p.item.x"}}
    assert loop == {"loop": {"count": 3, "body": [{"loop": {"count": 2, "body": [step]}}]}}


@pytest.mark.parametrize(
    ("which", "changes"),
    [
        ("pair", {"items.0.slices.1.size": 12}),
        ("pair", {"items.0.slices.0.first": 1}),
        ("pair", {"items.1.slices.0.last": None}),
        ("pair", {"items.1.slices.0.last": "in loop"}),
        ("cut", {"items.1.slices.0.first": 3}),
        ("side", {"items.0.align": 4}),
        ("last", {"leaves.1.lanes": 2, "leaves.1.kind": "items"}),
        ("trigger", {"items.0.slices.0.bytes": 3}),
        ("nested", {"items.1.count.charge.padding_credit": 14}),
        ("nested", {"items.1.count.charge.budget": 9}),
        ("nested", {"items.1.count.charge": None}),
        ("nested", {"items.1.count.limit": 9}),
        ("gap", {"items.3.align": 4}),
        ("rows", {"items.0.count.number": 4}),
        ("texts", {"items.2.rest": 3}),
        ("text", {"items.1.has_tail": True}),
        ("text", {"items.1.count.nul": True}),
        ("text", {"items": PLANS["text"].items[:2]}),
    ],
)
def test_plans_that_differ_have_texts_that_differ_in_meaning(which, changes):
    plan = PLANS[which]
    other = damaged(plan, changes)
    assert plan != other
    assert compare(to_yaml(plan), to_yaml(other))
    assert compare(to_yaml(other), to_yaml(plan))
