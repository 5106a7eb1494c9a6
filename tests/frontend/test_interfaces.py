"""Services and actions: the parts of their files, and the messages that ROS derives."""

from __future__ import annotations

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import DISTROS, Library
from firm_hdl.model import Action, Array, Sequence, Service

from .workspace import make_files

DISTRO = {"ros1": "noetic", "ros2": "lyrical"}


def load(root, name, text, *, distro="lyrical", **others):
    """Load the interface of a package ``p`` that a text defines."""
    kind = name.split("/")[0]
    files = {f"p/{name}.{kind}": text} | {f"p/{k}/{n}": t for (k, n), t in others.items()}
    return Library(distro, [make_files(root, files)]).interface(f"p/{name}")


def fields(message):
    return [f"{item.type} {item.name}" for item in message.fields]


# Results of genmsg 0.6.0 with genaction.py, and of rosidl_adapter 3.3.1: the fields of each part,
# or None if they refuse the file.
SERVICES = [
    ("---", [], [], True),
    ("---\n", [], [], True),
    ("int8 a\n---\nint8 b", ["a"], ["b"], True),
    ("int8 a\r\n---\r\nint8 b\r\n", ["a"], ["b"], True),
    ("int8 a\r---\rint8 b\r", ["a"], ["b"], True),
    ("# c\n---\n# d\n\nint8 b # e\n", [], ["b"], True),
    ("#---\n---\nint8 b", [], ["b"], True),
    ("int8 a # ---\n---\nint8 b", ["a"], ["b"], True),
    ("", [], [], False),
    ("int8 a", ["a"], [], False),
    ("int8 a\n--- \nint8 b", ["a"], ["b"], False),
    ("int8 a\n---\t\nint8 b", ["a"], ["b"], False),
    ("int8 a\n----\nint8 b", ["a"], ["b"], False),
    ("int8 a\n--- # c\nint8 b", ["a"], ["b"], False),
    ("int8 a\n---int8 c\nint8 b", ["a"], ["b"], False),
    ("---\nint8 a\n---\nint8 b", [], ["a", "b"], False),
    ("---\n---\n---", [], [], False),
]


@pytest.mark.parametrize(("text", "request_", "response", "is_ros2"), SERVICES)
def test_services_are_cut_as_genmsg_does(tmp_path, text, request_, response, is_ros2):
    service = load(tmp_path, "srv/S", text, distro="noetic")
    assert [f.name for f in service.request.fields] == request_
    assert [f.name for f in service.response.fields] == response


@pytest.mark.parametrize(("text", "request_", "response", "is_ros2"), SERVICES)
def test_services_are_cut_as_rosidl_adapter_does(tmp_path, text, request_, response, is_ros2):
    if not is_ros2:
        with pytest.raises(DefinitionError):
            load(tmp_path, "srv/S", text)
        return
    service = load(tmp_path, "srv/S", text)
    assert [f.name for f in service.request.fields] == request_
    assert [f.name for f in service.response.fields] == response


ACTIONS = [
    ("---\n---", ([], [], []), "both"),
    ("int8 a\n---\nint8 b\n---\nint8 c\n", (["a"], ["b"], ["c"]), "both"),
    ("int8 a\r\n---\r\nint8 b\r\n---\r\nint8 c", (["a"], ["b"], ["c"]), "both"),
    ("---\n\n---\nint8 c\nint8 d", ([], [], ["c", "d"]), "both"),
    ("int8 a\n--- x\nint8 b\n----\nint8 c\n", (["a"], ["b"], ["c"]), "ros1"),
    ("int8 a\n---\nint8 b", None, None),
    ("int8 a", None, None),
    ("", None, None),
    ("---\n---\n---", None, None),
]


@pytest.mark.parametrize("dialect", DISTRO)
@pytest.mark.parametrize(("text", "parts", "legal"), ACTIONS)
def test_actions_are_cut_as_ros_does(tmp_path, dialect, text, parts, legal):
    if legal not in ("both", dialect):
        with pytest.raises(DefinitionError):
            load(tmp_path, "action/A", text, distro=DISTRO[dialect])
        return
    action = load(tmp_path, "action/A", text, distro=DISTRO[dialect])
    found = action.goal, action.result, action.feedback
    assert tuple([f.name for f in part.fields] for part in found) == parts


def test_every_part_has_its_comment_its_constants_and_spans_of_the_whole_file(tmp_path):
    text = "# Asks.\nint8 X=1\nint8 a # [m]\n---\n# Answers.\n\n# Why.\nstring b\n"
    service = load(tmp_path, "srv/S", text)
    assert (service.comment, service.response.comment) == ("Asks.", "Answers.")
    assert [c.name for c in service.request.constants] == ["X"]
    (a,), (b,) = service.request.fields, service.response.fields
    assert (a.unit, b.comment) == ("m", "Why.")
    assert (a.span.line, b.span.line, b.span.column) == (3, 8, 8)
    assert b.span.source.text == text == service.text
    (constant,) = service.request.constants
    assert (constant.span.line, constant.span.column) == (2, 6)


def test_every_part_has_its_own_text(tmp_path):
    text = "# Asks.\nint8 a # [m]\n---\n---\nint8 c"
    action = load(tmp_path, "action/A", text)
    parts = action.goal, action.result, action.feedback
    assert [part.text for part in parts] == ["# Asks.\nint8 a # [m]\n", "", "int8 c\n"]
    assert (action.text, action.comment) == (text, "Asks.")
    # What ROS derives has neither the text nor the comment of the file.
    assert [(each.text, each.comment) for each in action.services] == [("", "")] * 2
    assert action.wrappers[0].text == ("unique_identifier_msgs/UUID goal_id\nA_Feedback feedback\n")


def test_ros2_service(tmp_path):
    service = load(tmp_path, "srv/S", "int8 a\n---\nint8 b")
    assert isinstance(service, Service)
    assert (service.name, service.dialect) == ("p/srv/S", "ros2")
    assert service.messages == (service.request, service.response, service.event)
    assert [m.name for m in service.messages] == [
        "p/srv/S_Request", "p/srv/S_Response", "p/srv/S_Event",
    ]  # fmt: skip
    assert fields(service.event) == [
        "service_msgs/msg/ServiceEventInfo info",
        "p/srv/S_Request[<=1] request",
        "p/srv/S_Response[<=1] response",
    ]
    assert service.event.fields[1].type == Sequence(element=service.request, bound=1)


@pytest.mark.parametrize("distro", [name for name, d in DISTROS.items() if d.dialect == "ros2"])
def test_services_have_events_from_iron_on(tmp_path, distro):
    library = Library(distro, [make_files(tmp_path, {"p/srv/S.srv": "---"})])
    has_events = distro not in ("foxy", "humble")
    assert (library.interface("p/srv/S").event is not None) is has_events
    if not has_events:
        with pytest.raises(DefinitionError, match="type 'S_Event' is not defined in package 'p'"):
            library.message("p/srv/S_Event")


def test_ros1_service(tmp_path):
    service = load(tmp_path, "srv/S", "int8 a\n---\nint8 b\n", distro="noetic")
    assert (service.name, service.event) == ("p/S", None)
    assert [m.name for m in service.messages] == ["p/SRequest", "p/SResponse"]
    # genmsg joins the lines of each part again, and ends each with a line feed.
    assert [m.text for m in service.messages] == ["int8 a\n", "int8 b\n\n"]


FIBONACCI = "int32 order\n---\nint32[] sequence\n---\nint32[] partial\n"


def test_ros2_action(tmp_path):
    action = load(tmp_path, "action/F", FIBONACCI)
    assert isinstance(action, Action)
    uuid = "unique_identifier_msgs/msg/UUID goal_id"
    info = "service_msgs/msg/ServiceEventInfo info"
    assert {m.name: fields(m) for m in action.messages} == {
        "p/action/F_Goal": ["int32 order"],
        "p/action/F_Result": ["int32[] sequence"],
        "p/action/F_Feedback": ["int32[] partial"],
        "p/action/F_SendGoal_Request": [uuid, "p/action/F_Goal goal"],
        "p/action/F_SendGoal_Response": ["bool accepted", "builtin_interfaces/msg/Time stamp"],
        "p/action/F_SendGoal_Event": [
            info,
            "p/action/F_SendGoal_Request[<=1] request",
            "p/action/F_SendGoal_Response[<=1] response",
        ],
        "p/action/F_GetResult_Request": [uuid],
        "p/action/F_GetResult_Response": ["int8 status", "p/action/F_Result result"],
        "p/action/F_GetResult_Event": [
            info,
            "p/action/F_GetResult_Request[<=1] request",
            "p/action/F_GetResult_Response[<=1] response",
        ],
        "p/action/F_FeedbackMessage": [uuid, "p/action/F_Feedback feedback"],
    }
    assert [s.name for s in action.services] == ["p/action/F_SendGoal", "p/action/F_GetResult"]
    assert action.wrappers[0].fields[1].type is action.feedback
    goal_id = action.wrappers[0].fields[0].type
    assert [str(f.type) for f in goal_id.fields] == ["uint8[16]"]


GENERATED = "# ====== DO NOT MODIFY! AUTOGENERATED FROM AN ACTION DEFINITION ======\n"


def test_ros1_action(tmp_path):
    action = load(tmp_path, "action/F", FIBONACCI, distro="noetic")
    assert {m.name: m.text for m in action.messages} == {
        "p/FGoal": f"{GENERATED}int32 order\n",
        "p/FResult": f"{GENERATED}int32[] sequence\n",
        "p/FFeedback": f"{GENERATED}int32[] partial\n\n",
        "p/FActionGoal": (
            f"{GENERATED}\nHeader header\nactionlib_msgs/GoalID goal_id\nFGoal goal\n"
        ),
        "p/FActionResult": (
            f"{GENERATED}\nHeader header\nactionlib_msgs/GoalStatus status\nFResult result\n"
        ),
        "p/FActionFeedback": (
            f"{GENERATED}\nHeader header\nactionlib_msgs/GoalStatus status\nFFeedback feedback\n"
        ),
        "p/FAction": (
            f"{GENERATED}\nFActionGoal action_goal\nFActionResult action_result\n"
            "FActionFeedback action_feedback\n"
        ),
    }
    whole = action.wrappers[-1]
    assert [str(f.type) for f in whole.fields] == [
        "p/FActionGoal", "p/FActionResult", "p/FActionFeedback",
    ]  # fmt: skip
    assert [str(f.type) for f in whole.fields[0].type.fields] == [
        "std_msgs/Header", "actionlib_msgs/GoalID", "p/FGoal",
    ]  # fmt: skip


def test_ros1_definitions_may_use_the_messages_of_actions_once_they_are_files(tmp_path):
    # genmsg reads files only; genaction.py writes them when the package is built.
    files = {"p/action/F.action": FIBONACCI, "q/msg/M.msg": "p/FGoal a\np/FActionFeedback[2] b"}
    library = Library("noetic", [make_files(tmp_path, files)])
    with pytest.raises(DefinitionError) as error:
        library.message("q/M")
    assert error.value.diagnostics[0].message == (
        "type 'FGoal' is not defined in package 'p'; the build of the package makes it from the "
        "action 'F': name the built folder"
    )
    texts = {f"p/msg/{m.base_name}.msg": m.text for m in library.interface("p/F").messages}
    library = Library("noetic", [make_files(tmp_path, texts)])
    one, two = library.message("q/M").fields
    assert one.type == library.interface("p/F").goal
    assert two.type == Array(element=library.message("p/FActionFeedback"), count=2)


@pytest.mark.parametrize(
    ("distro", "type_"),
    [
        ("noetic", "p/SRequest"),
        ("lyrical", "p/S_Request"),
        ("lyrical", "p/F_Goal"),
        ("lyrical", "S"),
        ("noetic", "F"),
    ],
)
def test_definitions_cannot_use_types_without_a_message_file(tmp_path, distro, type_):
    files = {"p/srv/S.srv": "---", "p/action/F.action": FIBONACCI, "p/msg/M.msg": f"{type_} a"}
    with pytest.raises(DefinitionError, match="is not defined in package 'p'") as error:
        Library(distro, [make_files(tmp_path, files)]).message("p/M")
    # In ROS 2, no build makes them.
    assert "build" not in str(error.value)


def test_file_with_a_derived_name_wins_over_later_origins(tmp_path):
    # noetic has actionlib/TestGoal as a message.
    make_files(tmp_path, {"actionlib/action/Test.action": "string mine\n---\n---\n"})
    library = Library("noetic", [tmp_path])
    assert fields(library.message("actionlib/TestGoal")) == ["string mine"]
    assert fields(library.interface("actionlib/TestGoal")) == ["string mine"]
    assert library.source("actionlib/TestGoal").text.startswith("string mine\n")
    assert fields(Library("noetic").message("actionlib/TestGoal")) == ["int32 goal"]
    make_files(tmp_path, {"actionlib/msg/TestGoal.msg": "int8 file"})
    assert fields(Library("noetic", [tmp_path]).message("actionlib/TestGoal")) == ["int8 file"]


@pytest.mark.parametrize(("kind", "legal"), [("srv", 1), ("action", 2)])
def test_mistakes_behind_a_separator_that_is_too_many_are_reported(tmp_path, kind, legal):
    with pytest.raises(DefinitionError) as error:
        load(tmp_path, f"{kind}/A", "---\n" * (legal + 1) + "int8 B\n---\nint8 D\n")
    found = [(each.span.line, "'" in each.message[:3]) for each in error.value.diagnostics]
    lines = [legal + 1, legal + 2, legal + 3, legal + 4]
    assert sorted(found) == list(zip(lines, [False, True, False, True], strict=True))


def test_an_idl_that_cannot_be_read_is_not_said_to_lack_its_structs(tmp_path):
    make_files(
        tmp_path, {"p/srv/A.idl": "module p { module srv { struct A_Request { any a; }; }; };"}
    )
    with pytest.raises(DefinitionError) as error:
        Library("lyrical", [tmp_path]).interface("p/srv/A")
    assert [each.message for each in error.value.diagnostics] == ["type 'any' is not supported"]


@pytest.mark.parametrize("kind", ["msg", "srv", "action"])
def test_ros1_has_no_definitions_in_idl(tmp_path, kind):
    structs = {"msg": ["A"], "srv": ["A_Request", "A_Response"],
               "action": ["A_Goal", "A_Result", "A_Feedback"]}[kind]  # fmt: skip
    text = " ".join(f"struct {name} {{ long a; }};" for name in structs)
    make_files(tmp_path, {f"p/{kind}/A.idl": f"module p {{ module {kind} {{ {text} }}; }};"})
    assert Library("lyrical", [tmp_path]).interface("p/A").name == f"p/{kind}/A"
    with pytest.raises(DefinitionError, match="ROS 1 has no definitions in IDL"):
        Library("noetic", [tmp_path]).interface(f"p/{kind}/A")


def test_long_suffixes_are_tried_first(tmp_path):
    files = {"p/action/F.action": "int8 f\n---\n---", "p/action/FAction.action": "int8 g\n---\n---"}
    library = Library("noetic", [make_files(tmp_path, files)])
    assert [f.name for f in library.message("p/FActionGoal").fields] == [
        "header",
        "goal_id",
        "goal",
    ]
    assert fields(library.message("p/FActionActionGoal"))[-1] == "p/FActionGoal goal"
