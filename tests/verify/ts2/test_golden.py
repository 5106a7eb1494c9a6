"""Golden plans (TS2): the plans of the project, and the tool that compares them.

To accept a change of plans: ``firm-hdl golden accept tests/verify/golden``.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from firm_hdl.errors import UserError
from firm_hdl.frontend import Library
from firm_hdl.plan import build_plan
from firm_hdl.verify.results.verdict import Failed, Passed
from firm_hdl.verify.ts2.golden import add, check_golden, read_golden, summarise
from firm_hdl.wire import lay_out
from tests.verify.judged import assert_passed

FOLDER = Path(__file__).parents[1] / "golden"


@pytest.mark.snapshot
def test_todays_plans_are_the_golden_ones():
    results = check_golden(read_golden(FOLDER))
    assert len(results) > 25
    wrong = [
        f"{result.golden.path.name}: {line}"
        for result in results
        for line in result.verdict.details
    ]

    assert wrong == [], "accept with: firm-hdl golden accept tests/verify/golden"
    assert {result.verdict for result in results} == {Passed(1)}


@pytest.fixture
def folder(tmp_path):
    library = Library("lyrical")
    for name in ("sensor_msgs/msg/Imu", "std_msgs/msg/String", "geometry_msgs/msg/Twist"):
        message = library.message(name)
        add(tmp_path, "lyrical", message, build_plan(lay_out(message)))
    return tmp_path


def test_a_plan_that_was_just_added_is_the_same(folder):
    assert [assert_passed(each) for each in check_golden(read_golden(folder))] == [1, 1, 1]


def test_a_changed_plan_is_named_with_all_types_that_it_touches(folder):
    for path in (folder / "lyrical").iterdir():
        text = path.read_text()
        path.write_text(re.sub(r"limit: 1677\d+", "limit: 9", text))
    results = check_golden(read_golden(folder))
    changed = [result for result in results if isinstance(result.verdict, Failed)]
    assert [str(change) for change in changed[-1].changes] == [
        "plan[run of data.items].limit: 9 -> 16777207"
    ]
    assert summarise(results) == {"plan[*].limit": ["sensor_msgs/msg/Imu", "std_msgs/msg/String"]}


def test_a_removed_type_is_a_problem(folder):
    path = next((folder / "lyrical").glob("*String*"))
    path.write_text(path.read_text().replace("std_msgs/msg/String", "std_msgs/msg/Strong"))
    wrong = [result for result in check_golden(read_golden(folder)) if result.problems]
    assert len(wrong) == 1
    assert "type 'Strong' is not defined" in wrong[0].problems[0]


def test_a_file_that_is_no_plan_is_refused(folder):
    (folder / "lyrical" / "x.yaml").write_text("leaves: 3\n")
    with pytest.raises(UserError, match=r"x\.yaml': Not a plan: "):
        read_golden(folder)
    (folder / "mars").mkdir()
    (folder / "mars" / "y.yaml").write_text("")
    (folder / "lyrical" / "x.yaml").unlink()
    with pytest.raises(UserError, match="not below a distribution's name"):
        read_golden(folder)


def test_each_plan_is_made_by_its_own_distribution_bus_and_limit(tmp_path):
    for distro, name in (("noetic", "std_msgs/String"), ("lyrical", "std_msgs/msg/String")):
        message = Library(distro).message(name)
        for width in (2, 8):
            plan = build_plan(lay_out(message), bus_bytes=width, max_message_bytes=4000 + width)
            add(tmp_path, distro, message, plan)
    found = check_golden(read_golden(tmp_path))
    assert [assert_passed(each) for each in found] == [1, 1, 1, 1]
    assert [(each.golden.distro, each.golden.plan.bus_bytes) for each in found] == [
        ("lyrical", 2),
        ("lyrical", 8),
        ("noetic", 2),
        ("noetic", 8),
    ]
