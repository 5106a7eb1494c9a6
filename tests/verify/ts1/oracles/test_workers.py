"""Everything that the readers of ROS tell of a definition, and the types that it needs.

Facts that an oracle leaves out are not compared. So these tests count them.
"""

from __future__ import annotations

import pytest

from firm_hdl.verify.ts1.oracles.oracle import Refused
from tests.verify.judged import assert_passed

FILES = {
    "p/msg/A.msg": "# Whole.\n\n# Of x.\nint8 x 3  # More [m].\nq/B[2] bs\nint16 K=-7 # Of K.\n",
    "p/srv/S.srv": "int8 a\n---\nq/B b\nstring C='c'\n",
    "p/action/Do.action": "int8 g\n---\nint16 r\n---\nq/B[] f\n",
    "q/msg/B.msg": "float32[] x [1.5, 2]\n",
}
ROS1 = {
    "p/msg/A.msg": "int8 K=-7 # Of K.\nq/B[2] bs\ntime t\n",
    "p/srv/S.srv": "int8 a\n---\nq/B b\nstring C=c # d\n",
    "p/action/Do.action": "int8 g\n--- more\nint16 r\n---\nq/B[] f\n",
    "q/msg/B.msg": "float32[] x\n",
}


def fields_of(answer):
    """Names and types of all fields, by message."""
    return {
        name: [f"{each['type']} {each['name']}" for each in message["fields"]]
        for name, message in answer.facts["structure"].items()
    }


def test_rosidl_adapter_tells_of_each_part(court):
    here = court("lyrical", FILES)
    assert fields_of(here.answer("rosidl_adapter", "p/Do")) == {
        "p/action/Do_Goal": ["int8 g"],
        "p/action/Do_Result": ["int16 r"],
        "p/action/Do_Feedback": ["q/msg/B[] f"],
    }
    service = here.answer("rosidl_adapter", "p/S")
    assert fields_of(service) == {
        "p/srv/S_Request": ["int8 a"],
        "p/srv/S_Response": ["q/msg/B b"],
    }
    (constant,) = service.facts["structure"]["p/srv/S_Response"]["constants"]
    assert (constant["name"], constant["value"]) == ("C", "c")
    whole = here.answer("rosidl_adapter", "p/A").facts["structure"]["p/msg/A"]
    assert whole["comment"] == "Whole."
    remarks = [
        (e["name"], e["comment"], e["unit"]) for e in (*whole["fields"], *whole["constants"])
    ]
    assert remarks == [("x", "Of x.\nMore.", "m"), ("bs", "", None), ("K", "Of K.", None)]
    assert [each["default"] for each in whole["fields"]] == [3, None]


UUID, TIME = "unique_identifier_msgs/msg/UUID goal_id", "builtin_interfaces/msg/Time stamp"


def test_rosidl_parser_tells_of_each_part_and_of_derived_messages(court):
    here = court("humble", FILES)
    assert fields_of(here.answer("rosidl_parser", "p/Do")) == {
        "p/action/Do_Goal": ["int8 g"],
        "p/action/Do_Result": ["int16 r"],
        "p/action/Do_Feedback": ["q/msg/B[] f"],
        "p/action/Do_SendGoal_Request": [UUID, "p/action/Do_Goal goal"],
        "p/action/Do_SendGoal_Response": ["bool accepted", TIME],
        "p/action/Do_GetResult_Request": [UUID],
        "p/action/Do_GetResult_Response": ["int8 status", "p/action/Do_Result result"],
        "p/action/Do_FeedbackMessage": [UUID, "p/action/Do_Feedback feedback"],
    }
    assert list(fields_of(here.answer("rosidl_parser", "p/S"))) == [
        "p/srv/S_Request",
        "p/srv/S_Response",
    ]
    (field,) = here.answer("rosidl_parser", "q/B").facts["structure"]["q/msg/B"]["fields"]
    assert field == {"name": "x", "type": "float32[]", "default": [1.5, 2.0]}
    (constant,) = here.answer("rosidl_parser", "p/A").facts["structure"]["p/msg/A"]["constants"]
    assert constant == {"name": "K", "type": "int16", "value": -7}


def test_genmsg_tells_of_each_part_and_of_derived_messages(court):
    here = court("noetic", ROS1)
    action = here.answer("genmsg", "p/Do")
    header, goal_id = "std_msgs/Header header", "actionlib_msgs/GoalID goal_id"
    status = "actionlib_msgs/GoalStatus status"
    assert fields_of(action) == {
        "p/DoGoal": ["int8 g"],
        "p/DoResult": ["int16 r"],
        "p/DoFeedback": ["q/B[] f"],
        "p/DoActionGoal": [header, goal_id, "p/DoGoal goal"],
        "p/DoActionResult": [header, status, "p/DoResult result"],
        "p/DoActionFeedback": [header, status, "p/DoFeedback feedback"],
        "p/DoAction": [
            "p/DoActionGoal action_goal",
            "p/DoActionResult action_result",
            "p/DoActionFeedback action_feedback",
        ],
    }
    assert set(action.facts) == {"structure", "md5"}
    assert list(action.facts["md5"]) == list(action.facts["structure"])
    assert len(set(action.facts["md5"].values())) == 7
    service = here.answer("genmsg", "p/S").facts
    assert list(service["structure"]) == ["p/SRequest", "p/SResponse"]
    assert list(service["md5"]) == ["p/S"]
    assert "int8 a\n---\nstring C=c # d\nq/B b\n  float32[] x" in service["show"]
    for type_ in ("p/A", "p/S", "p/Do"):
        assert_passed(here.outcome("genmsg", type_))


PLACES = {
    "msg": ["int8 x\n{} n\n", "int8 x\n{}[] n\n", "{}[2] n\n"],
    "srv": ["{} n\n---\nint8 x\n", "int8 x\n---\n{}[] n\n"],
    "action": ["{} n\n---\n---\n", "---\n{}[] n\n---\n", "---\n---\n{} n\n"],
}


@pytest.mark.parametrize(
    ("distro", "oracle"),
    [("noetic", "genmsg"), ("humble", "rosidl_adapter"), ("humble", "rosidl_parser")],
)
def test_a_missing_type_is_refused_wherever_it_is(court, distro, oracle):
    files = {"q/msg/B.msg": "int8 x\n"}
    for kind, places in PLACES.items():
        for number, place in enumerate(places):
            files[f"p/{kind}/Good{number}.{kind}"] = place.format("q/B")
            files[f"p/{kind}/Bad{number}.{kind}"] = place.format("q/C")
    here = court(distro, files)
    cases = here.universe.select([])
    assert len(cases) == len(files) == 17
    judge = here.oracle(oracle)
    for case in cases:
        answer = judge.judge(case)
        assert isinstance(answer, Refused) == case.name.startswith("Bad"), (case.text, answer)


def test_genmsg_reads_utf_8(court):
    text = "string S=\xe9\nint8[0] a\nint8[] b\n"
    here = court("noetic", {"p/msg/A.msg": text, "p/msg/B.msg": "int8 x\n"})
    answer = here.answer("genmsg", "p/A")
    assert fields_of(answer) == {"p/A": ["int8[0] a", "int8[] b"]}
    (constant,) = answer.facts["structure"]["p/A"]["constants"]
    assert constant == {"name": "S", "type": "string", "value": "\xe9", "text": "\xe9"}


def test_a_needed_type_is_that_of_the_msg_file_if_there_are_two(court):
    idl = "module q {{ module msg {{ struct B {{ {} }}; }}; }};"
    files = {"p/msg/A.msg": "q/B b\n", "q/msg/B.msg": "int8 x\n", "q/msg/B.idl": idl.format("?")}
    assert fields_of(court("lyrical", files).answer("rosidl_adapter", "p/A"))
    bad = court("lyrical", {**files, "q/msg/B.msg": "?\n", "q/msg/B.idl": idl.format("long x;")})
    answer = bad.answer("rosidl_adapter", "p/A")
    assert isinstance(answer, Refused) and "q/msg/B: " in answer.message


def test_messages_of_idl_are_named_by_their_file(court):
    parts = "struct S_Request { long a; }; struct S_Response { long b; };"
    text = f"module x {{ module y {{ {parts} }}; }};"
    files = {"p/srv/S.idl": text, "p/msg/A.idl": "struct A { long a; };"}
    here = court("lyrical", files)
    service = here.answer("rosidl_parser-4.9", "p/S").facts
    assert fields_of(here.answer("rosidl_parser-4.9", "p/S"))["p/srv/S_Event"][1:] == [
        "p/srv/S_Request[<=1] request",
        "p/srv/S_Response[<=1] response",
    ]
    assert (service["scope"], next(iter(service["hash"]))) == ("x/y", "p/srv/S")
    message = here.answer("rosidl_parser-4.9", "p/A").facts
    assert (message["scope"], list(message["structure"])) == ("", ["p/msg/A"])
