"""The semantic difference of plans."""

from __future__ import annotations

from dataclasses import replace

import pytest

from firm_hdl import load_message
from firm_hdl.plan import build_plan, to_yaml
from firm_hdl.plan.compare import Head, compare, head_of
from firm_hdl.wire import MAX_LEVELS, lay_out
from tests.strategies import make


def plan(name, **options):
    return build_plan(lay_out(load_message(name)), **options)


def differences(one, other):
    return [str(change) for change in compare(to_yaml(one), to_yaml(other))]


def test_equal_plans_have_no_difference():
    imu = plan("sensor_msgs/msg/Imu")
    assert differences(imu, imu) == []


def test_comments_and_layout_of_the_text_do_not_count():
    text = to_yaml(plan("sensor_msgs/msg/JointState"))
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    plain = "".join(f"{line.partition('  # ')[0]}\n" for line in lines)
    assert plain != text
    assert compare(text, plain) == []


def test_a_limit_is_one_change_with_its_place():
    old = plan("sensor_msgs/msg/Imu")
    new = plan("sensor_msgs/msg/Imu", max_message_bytes=4096)
    assert differences(old, new) == [
        "max_message_bytes: 16777216 -> 4096",
        "plan[run of header.frame_id.items].limit: 16776903 -> 3783",
    ]


def test_inserted_step_renumbers_no_other():
    old, new = plan("geometry_msgs/msg/Point"), plan("geometry_msgs/msg/Quaternion")
    assert differences(old, new) == [
        "message: geometry_msgs/msg/Point -> geometry_msgs/msg/Quaternion",
        "leaves.w: new: float64",
        "plan[y, bytes 4..7 of 8].4..7: new: z, bytes 0..3 of 8",
        "plan[z, bytes 4..7 of 8]: new: 0..3: z, bytes 4..7 of 8; 4..11: w",
        "plan[y, bytes 4..7 of 8].4..11: gone: z",
    ]


def test_leaves_in_another_order_are_a_change():
    old = plan("geometry_msgs/msg/Vector3", bus_bytes=32)
    first, second, third = old.leaves
    # The same leaves and the same steps: only two indexes are exchanged.
    new = replace(old, leaves=(second, first, third))
    changes = differences(old, new)
    assert [change for change in changes if change.startswith("order of leaves")]


def test_steps_in_another_order_are_a_change():
    first, second = "- step: {0..3: b}\n", "- step: {0..3: a}\n"
    old, new = f"plan:\n{first}{second}", f"plan:\n{second}{first}"
    assert [str(change) for change in compare(old, new)] in (
        ["order of plan: b -> (nothing here)", "order of plan: (nothing here) -> b"],
        ["order of plan: (nothing here) -> a", "order of plan: a -> (nothing here)"],
    )


def test_what_only_one_plan_has_is_one_change():
    row = make("ros1", {"x": "uint8", "t": "string"}, "Row")
    old, new = (
        build_plan(lay_out(make("ros1", {"a": "uint8", **more, "z": "uint8"})))
        for more in ({}, {"rows": (row, "[2]")})
    )
    changes = differences(old, new)
    assert [change.split(": new: ")[0] for change in changes] == [
        *(f"leaves.rows.item.{name}" for name in ("x", "t.length", "t.items")),
        *("plan[loop of 2]", "plan[z]", "plan[a].1: gone: z"),
    ]
    assert changes[3].endswith("body[run of rows.item.t.items].limit: 16777204")


def test_a_change_in_a_loop_has_the_place_of_the_loop():
    one, other = (
        build_plan(lay_out(make("ros1", {"r": (make("ros1", {"x": kind}, "Row"), "[]")})))
        for kind in ("uint16[<=3]", "uint16[<=4]")
    )
    assert differences(one, other) == [
        "plan[loop of r.length].body[run of r.item.x.items].limit: 3 -> 4"
    ]


@pytest.mark.parametrize(
    "change",
    [
        lambda p: replace(p, items=(replace(p.items[0], align=4), *p.items[1:])),
        lambda p: replace(p, leaves=(replace(p.leaves[0], type="uint32"), *p.leaves[1:])),
        lambda p: replace(p, items=p.items[:-1]),
        lambda p: replace(p, items=(*p.items, p.items[0])),
    ],
)
def test_any_change_of_meaning_is_found(change):
    old = plan("sensor_msgs/msg/JointState")
    assert differences(old, change(old))
    assert differences(change(old), old)


EMPTY = "plan: []"
NO_PLAN = "Not a plan: it has no list of steps, 'plan'"
NO_ITEM = "Not a plan: each of its items must be a step, a run or a loop"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", NO_PLAN),
        ("[]", NO_PLAN),
        ("message: x", NO_PLAN),
        ("plan: 5", NO_PLAN),
        ("plan:", NO_PLAN),
        # As firm-hdl wrote plans before they were trees.
        ("steps: {}", NO_PLAN),
        *[
            (f"plan: [{item}]", NO_ITEM)
            for item in (
                *("5", "a", "{}", "{step: 5}", "{step: {}, loop: {}}", "{run: {}}"),
                *("{loop: {count: 1}}", "{loop: {count: 1, body: x}}", "{loop: {body: []}}"),
            )
        ],
        ("plan: [{loop: {count: 1, body: [x]}}]", NO_ITEM),
        ("plan: []\na: 1\na: 1", "Line 1: the mapping has 'a' twice"),
        ("plan:\n- step:\n    0: a\n    0: b", "Line 3: the mapping has '0' twice"),
        ("plan: []\n? [a]\n: b", "Line 1: the mapping has a key that is no text"),
        ("a: [", "Line 2: not YAML: .*"),
        ("plan: []\n\0", "Line 2: not YAML: control characters are not allowed"),
        ("plan: []\n\ud800", "Line 2: not YAML that a plan can have"),
        ("plan: []\nwire: &a [x]\nruns: *a", "Line 2: a plan has no aliases"),
        ("plan: []\nwire: &a [*a]", "Line 2: a plan has no aliases"),
        ("plan: []\n<<: &a {b: *a}", "Line 2: a plan has no aliases"),
        (f"plan: []\nwire: {'[' * 300}{']' * 300}", "Line 2: a plan is not nested so deep"),
        (f"plan: []\nwire: {'[' * 99999}", "Line 2: not YAML: exceeded maximum nesting depth"),
    ],
)
@pytest.mark.parametrize("is_old", [True, False])
def test_texts_that_are_no_plans_are_refused(text, message, is_old):
    with pytest.raises(ValueError, match=f"^{message}$"):
        compare(*([text, EMPTY] if is_old else [EMPTY, text]))


@pytest.mark.parametrize(
    "value", ["!!int ''", "!!timestamp x", "!!python/name:os.system x", "9" * 5000]
)
def test_values_are_texts_whatever_yaml_takes_them_for(value):
    text = f"plan: []\nwire: {value}"
    assert compare(text, text) == []


def test_few_aliases_do_not_stand_for_billions_of_lines():
    lines = ["a0: &a0 [x, x]", *(f"a{n}: &a{n} [*a{n - 1}, *a{n - 1}]" for n in range(1, 40))]
    text = "\n".join([*lines, EMPTY])
    with pytest.raises(ValueError, match=r"^Line \d+: a plan has no aliases$"):
        compare(text, text)


def test_loops_as_deep_as_a_message_may_have_are_compared():
    inner = make("ros1", {"x": "uint8", "y": "string"}, "T0")
    for level in range(1, MAX_LEVELS):
        inner = make("ros1", {"x": "uint8", "e": (inner, "[]")}, f"T{level}")
    text = to_yaml(build_plan(lay_out(inner)))
    assert compare(text, text) == []
    (change,) = compare(text, text.replace("e.item.y.length\n", "e.item.z.length\n", 1))
    assert str(change).endswith("e.item.y.length -> " + change.new)


def test_the_head_says_what_a_plan_is_of():
    head = head_of(to_yaml(plan("std_msgs/msg/String", bus_bytes=2, max_message_bytes=99)))
    assert head == Head(
        message="std_msgs/msg/String", wire="cdr", bus_bytes=2, max_message_bytes=99
    )


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("message: ", "m: "),
        ("message: ", "message: [x]\nm: "),
        ("wire: cdr", "wire: can"),
        ("wire: cdr", "wire: [cdr]"),
        ("bus_bytes: 8", "bus_bytes: wide"),
        ("bus_bytes: 8", f"bus_bytes: {'8' * 5000}"),
        ("max_message_bytes: ", "max_message_bytes: -"),
    ],
)
def test_a_plan_that_does_not_say_what_it_is_of_is_refused(old, new):
    text = to_yaml(plan("std_msgs/msg/String"))
    assert old in text
    with pytest.raises(ValueError, match=r"^Not a plan: it has no "):
        head_of(text.replace(old, new, 1))
