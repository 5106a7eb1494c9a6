"""The semantic difference of plans."""

from __future__ import annotations

from dataclasses import replace

import pytest

from firm_hdl import load_message
from firm_hdl.plan import build_plan, from_yaml, to_yaml
from firm_hdl.plan.compare import compare
from firm_hdl.wire import lay_out


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
        "steps[header.stamp.nanosec].starts.limit: 16776903 -> 3783",
    ]


def test_inserted_step_renumbers_no_other():
    old, new = plan("geometry_msgs/msg/Point"), plan("geometry_msgs/msg/Quaternion")
    assert differences(old, new) == [
        "message: geometry_msgs/msg/Point -> geometry_msgs/msg/Quaternion",
        "leaves.w: new: float64",
        "steps[y, bytes 4..7 of 8].4..7: new: z, bytes 0..3 of 8",
        "steps[y, bytes 4..7 of 8].next: end -> step [z, bytes 4..7 of 8]",
        "steps[z, bytes 4..7 of 8]: new: 0..3: z, bytes 4..7 of 8; 4..11: w; next: end",
        "steps[y, bytes 4..7 of 8].4..11: gone: z",
    ]


def test_leaves_in_another_order_are_a_change():
    old = plan("geometry_msgs/msg/Vector3", bus_bytes=32)
    first, second, third = old.leaves
    # The same leaves and the same steps: only two indexes are exchanged.
    new = replace(old, leaves=(second, first, third))
    changes = differences(old, new)
    assert [change for change in changes if change.startswith("order of leaves")]


def test_steps_in_another_order_are_a_change():
    first, second = "0..3: b\n    next: step {}\n", "0..3: a\n    next: end\n"
    old = f"steps:\n  step 0:\n    {first.format(1)}  step 1:\n    {second}"
    new = f"steps:\n  step 0:\n    {second}  step 1:\n    {first.format(0)}"
    assert [str(change) for change in compare(old, new)] in (
        ["order of steps: b -> (nothing here)", "order of steps: (nothing here) -> b"],
        ["order of steps: (nothing here) -> a", "order of steps: a -> (nothing here)"],
    )


@pytest.mark.parametrize(
    "change",
    [
        lambda p: replace(p, max_trailing_bytes=0),
        lambda p: replace(p, steps=(replace(p.steps[0], align=4), *p.steps[1:])),
        lambda p: replace(p, leaves=(replace(p.leaves[0], type="uint32"), *p.leaves[1:])),
        lambda p: replace(p, runs=(replace(p.runs[0], terminated=False), *p.runs[1:])),
        lambda p: replace(p, start=replace(p.start, step=1)),
        lambda p: replace(p, steps=p.steps[:-1]),
    ],
)
def test_any_change_of_meaning_is_found(change):
    old = plan("sensor_msgs/msg/JointState")
    assert differences(old, change(old))
    assert differences(change(old), old)


@pytest.mark.parametrize(
    "text", ["", "a: [", "[]", "message: x", "steps: 5", "steps: []", "steps:"]
)
@pytest.mark.parametrize("is_old", [True, False])
def test_texts_that_are_no_plans_are_refused(text, is_old):
    texts = [text, "steps: {}"] if is_old else ["steps: {}", text]
    with pytest.raises(ValueError, match=r"^(Line 2: not YAML|Not a plan: it has no steps)"):
        compare(*texts)


@pytest.mark.parametrize(
    ("line", "again", "where", "key"),
    [
        ("  x: float64\n", "  x: float64\n", "leaves", "x"),
        ("    next: end\n", "    next: end\n", "step 2", "next"),
        # The last one alone would be the same plan.
        ("  step 1:", "  step 1:\n    next: end\n", "steps", "step 1"),
    ],
)
def test_a_key_that_is_there_twice_is_no_plan(line, again, where, key):
    text = to_yaml(plan("geometry_msgs/msg/Point"))
    twice = text.replace(line, again + line)
    assert twice.count(line) == text.count(line) + 1 == 2
    first = next(n for n, each in enumerate(twice.splitlines(), 1) if f"{where}:" in each) + 1
    message = rf"^Not a plan: the mapping in line {first} has '{key}' twice$"
    for texts in ((text, twice), (twice, text)):
        with pytest.raises(ValueError, match=message):
            compare(*texts)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("steps: {}\nwire: !!int ''", ""),
        ("steps: {}\nwire: !!timestamp x", ""),
        ("steps: {}\nwire: !!python/name:os.system x", ""),
        (f"steps: {{}}\nlevels: {'9' * 5000}", ""),
        ("steps: {}\n? [a]\n: b", "Not a plan: the mapping in line 1 has a key that is no text"),
        ("steps: {}\n\0", "Line 2: not YAML: control characters are not allowed"),
        ("steps: {}\n\ud800", "Line 2: not YAML that a plan can have"),
        ("steps: {}\nwire: &a [x]\nruns: *a", "Line 2: a plan has no aliases"),
        ("steps: {}\nwire: &a [*a]", "Line 2: a plan has no aliases"),
        ("steps: {}\n<<: &a {b: *a}", "Line 2: a plan has no aliases"),
        (f"steps: {{}}\nwire: {'[' * 99}{']' * 99}", "Line 2: a plan is not nested so deep"),
        (f"steps: {{}}\nwire: {'[' * 99999}", "Line 2: not YAML: exceeded maximum nesting depth"),
    ],
)
def test_damaged_texts_have_errors_of_our_own(text, message):
    # What both texts have is no change, whatever it is.
    if not message:
        assert compare(text, text) == []
        return
    with pytest.raises(ValueError, match=f"^{message}$"):
        compare("steps: {}", text)


def test_few_aliases_do_not_stand_for_billions_of_lines():
    lines = ["a0: &a0 [x, x]", *(f"a{n}: &a{n} [*a{n - 1}, *a{n - 1}]" for n in range(1, 40))]
    for read in (from_yaml, lambda text: compare(text, text)):
        with pytest.raises(ValueError, match=r"^Line \d+: a plan has no aliases$"):
            read("\n".join([*lines, "steps: {}"]))


@pytest.mark.parametrize("content", ["", "5", "words of", "[a]"])
def test_steps_that_are_no_mappings_are_refused(content):
    with pytest.raises(ValueError, match=r"^Not a plan: a step must be a mapping$"):
        compare("steps: {}", f"steps: {{step 0: {{next: end}}, step 1: {content}}}")
