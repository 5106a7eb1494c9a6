"""Resolution of names to types."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import Library
from firm_hdl.model import PRIMITIVES, Array, Constant, Field, Message, Sequence, String
from tests.depth import by_depth
from tests.steps import calls_at_most
from tests.strategies import definitions

from .workspace import errors_of, library, make_files


def load(root, text, dialect="ros2", **others):
    files = {"p/T": text} | {f"p/{name}": other for name, other in others.items()}
    return library(root, files, dialect).message("p/T")


def test_every_primitive(tmp_path):
    for dialect in ("ros1", "ros2"):
        names = PRIMITIVES[dialect]
        message = load(tmp_path, "".join(f"{n} {n}\n" for n in names), dialect)
        assert {f.name: f.type for f in message.fields} == names


def test_byte_is_signed_in_ros1_only(tmp_path):
    signed = {d: load(tmp_path, "byte b\nchar c", d).fields for d in ("ros1", "ros2")}
    assert [f.type.signed for f in signed["ros1"]] == [True, False]
    assert [f.type.signed for f in signed["ros2"]] == [False, False]


def test_a_whole_message(tmp_path):
    text = (
        "# head\n\nint8 MAX=0x7F # most [m]\nstring<=3[<=2] a ['x', y]\n"
        "wstring b\nU[2] c # [s]\np/U[] d\nfloat32 e 1\n"
    )
    message = load(tmp_path, text, U="")
    u = Message(name="p/msg/U", dialect="ros2", fields=())
    int8, float32 = PRIMITIVES["ros2"]["int8"], PRIMITIVES["ros2"]["float32"]
    assert message == Message(
        name="p/msg/T",
        dialect="ros2",
        fields=(
            Field(name="a", type=Sequence(element=String(bound=3), bound=2), default=("x", "y")),
            Field(name="b", type=String(wide=True)),
            Field(name="c", type=Array(element=u, count=2)),
            Field(name="d", type=Sequence(element=u)),
            Field(name="e", type=float32, default=1.0),
        ),
        constants=(Constant(name="MAX", type=int8, value=127),),
    )
    assert (message.comment, message.text) == ("head", text)
    assert [(f.comment, f.unit) for f in message.fields][2] == ("", "s")
    (most,) = message.constants
    assert (most.comment, most.unit, most.text) == ("most", "m", "0x7F")
    assert message.fields[2].span.source.name == f"{tmp_path}/p/msg/T.msg"
    assert (message.fields[2].span.line, message.fields[2].span.column) == (6, 6)


def test_ros1_lets_a_constant_be_declared_again_and_called_like_a_field(tmp_path):
    message = load(tmp_path, "int8 a\nint8 a=1\nint8 a=2\n", "ros1")
    assert [c.value for c in message.constants] == [1, 2]


def test_limits_of_values_are_legal(tmp_path):
    for dialect in ("ros1", "ros2"):
        lines = []
        for kind in PRIMITIVES[dialect].values():
            if kind.kind == "int":
                bits = 8 * kind.bytes
                low, high = (-(1 << bits - 1), (1 << bits - 1) - 1)
                low, high = (low, high) if kind.signed else (0, (1 << bits) - 1)
                lines += [f"{kind} {kind.name.upper()}_{i}={v}" for i, v in enumerate((low, high))]
        constants = load(tmp_path, "\n".join(lines), dialect).constants
        assert len(constants) == 20
        for constant in constants[::2]:
            beyond = f"{constant.type} X={constant.value - 1}"
            with pytest.raises(DefinitionError, match=f"the value of {constant.type} must be in"):
                load(tmp_path, beyond, dialect)


def test_mistakes_in_a_lattice_are_reported_once(tmp_path):
    files = {f"p/T{i}": f"T{i + 1} a\nT{i + 1}[] b\n" for i in range(40)} | {"p/T40": "int8 X"}
    with pytest.raises(DefinitionError) as error:
        library(tmp_path, files).message("p/T0")
    assert len(error.value.diagnostics) == 1


def test_mistake_in_a_dependency_is_reported_there(tmp_path):
    lib = library(tmp_path, {"p/T": "q/U a\nq/U b", "q/U": "int32 B", "r/V": "p/T t"})
    for name in ("r/V", "p/T", "q/U", "r/V"):
        with pytest.raises(DefinitionError) as error:
            lib.message(name)
        assert errors_of(error.value, tmp_path).startswith("q/msg/U.msg:1:7: error: 'B' is not")
        assert len(error.value.diagnostics) == 1


@pytest.mark.parametrize(
    ("dialect", "type_", "message"),
    [
        (
            "ros1",
            "flaot32",
            "type 'flaot32' is not defined in package 'p'; did you mean 'float32'?",
        ),
        # A type with a package is no builtin one.
        ("ros1", "q/flaot32", "type 'flaot32' is not defined in package 'q'"),
        ("ros1", "Unti", "type 'Unti' is not defined in package 'p'; did you mean 'Unit'?"),
        ("ros2", "Othre", "type 'Othre' is not defined in package 'p'"),
        ("ros2", "q/Othre", "type 'Othre' is not defined in package 'q'; did you mean 'q/Other'?"),
        ("ros2", "Other", "type 'Other' is not defined in package 'p'; did you mean 'q/Other'?"),
        # In ROS 2, no field has a type of an action, built or not.
        ("ros2", "Do_Goal", "type 'Do_Goal' is not defined in package 'p'"),
    ],
)
def test_what_is_said_of_a_type_that_is_not_defined(tmp_path, dialect, type_, message):
    files = {"p/msg/T.msg": f"{type_} a\n", "p/msg/Unit.msg": "", "q/msg/Other.msg": ""}
    files["p/action/Do.action"] = "---\n---\n"
    distro = "noetic" if dialect == "ros1" else "lyrical"
    ours = Library(distro, [make_files(tmp_path, files)], origins=())
    with pytest.raises(DefinitionError) as error:
        ours.message("p/T")
    (found,) = error.value.diagnostics
    assert (found.message, found.span.line, found.span.column) == (message, 1, 1)
    assert found.span.end - found.span.start == len(type_)


def test_cycle_through_a_sequence_is_a_cycle(tmp_path):
    with pytest.raises(DefinitionError) as error:
        load(tmp_path, "U[] u", U="V v", V="T[<=1] t")
    assert errors_of(error.value, tmp_path) == (
        "p/msg/V.msg:1:1: error: type 'p/msg/T' contains itself: "
        "p/msg/T -> p/msg/U -> p/msg/V -> p/msg/T\nT[<=1] t\n^^^^^^"
    )


def test_unreadable_dependency_is_reported(tmp_path):
    make_files(tmp_path, {"p/msg/T.msg": "U u\nint8 x"})
    (tmp_path / "p/msg/U.msg").write_bytes(b"\xff")
    with pytest.raises(DefinitionError, match="byte 0xff is not UTF-8 text"):
        Library("lyrical", [tmp_path]).message("p/T")


def test_a_thousand_unknown_types_are_reported_in_no_time(tmp_path):
    with calls_at_most(1_000_000):
        with pytest.raises(DefinitionError) as error:
            load(tmp_path, "".join(f"Nothing{i} x{i}\n" for i in range(1000)))
        assert len(error.value.diagnostics) == 1000


@settings(max_examples=by_depth(40, 200), deadline=None, suppress_health_check=list(HealthCheck))
@given(definition=definitions("ros1") | definitions("ros2", wide=True))
def test_random_definitions_come_back_from_their_texts(tmp_path_factory, definition):
    root = tmp_path_factory.mktemp("ws")
    for name, text in definition.texts.items():
        make_files(root, {f"{name}.msg": text.replace("p/msg/", "p/")})
    message = definition.message
    lib = Library("noetic" if message.dialect == "ros1" else "lyrical", [root])
    assert lib.message(message.name) == message


def test_errors_after_a_cycle_are_reported(tmp_path):
    """The other types of a type that contains itself are checked, too."""
    with pytest.raises(DefinitionError) as caught:
        load(tmp_path, "T a\nNope b\nU c\nint8 d\nT e\n", U="Never x\n")
    found = [(each.span.line, each.message.partition(":")[0]) for each in caught.value.diagnostics]
    cycle = "type 'p/msg/T' contains itself"
    missing = "type '{}' is not defined in package 'p'"
    # An error in a type that is used twice is reported once.
    assert found == [(1, cycle), (2, missing.format("Nope")), (1, missing.format("Never"))]


def test_mistakes_of_a_file_with_several_messages_are_reported_once(tmp_path):
    """A message in IDL may have both parts of a service."""
    idl = "module p { module msg { struct T { p::srv::S_Request a; p::srv::S_Response b; }; }; };"
    make_files(tmp_path, {"p/msg/T.idl": idl, "p/srv/S.srv": "int8 A\n---\nint8 B\n"})
    with pytest.raises(DefinitionError) as error:
        Library("lyrical", [tmp_path]).message("p/T")
    assert [each.span.line for each in error.value.diagnostics] == [1, 3]


def test_mistakes_of_a_type_come_in_the_order_of_its_files(tmp_path):
    """What an included file says comes first; that errors are left out comes last."""
    wrong = "".join(f"any a{i}; " for i in range(1000))
    text = f"module p {{ module msg {{ struct T {{ long ok; Late late; {wrong} }}; }}; }};"
    late = "module p { module msg {" + " " * 5000 + "typedef Nope Late; }; };"
    make_files(tmp_path, {"p/msg/T.idl": f'#include "C.idl"\n{text}', "p/msg/C.idl": late})
    with pytest.raises(DefinitionError) as error:
        Library("lyrical", [tmp_path]).message("p/T")
    first, second, *_, last = error.value.diagnostics
    assert [Path(each.span.source.name).name for each in (first, second)] == ["C.idl", "T.idl"]
    assert last.message == "too many errors; the others are not listed"


def test_the_first_twenty_unknown_types_get_suggestions(tmp_path):
    names = [f"Gadget{letter}" for letter in "ABCDEFGHIJKLMNOPQRSTUVWXYZ"]
    text = "".join(f"{name} {name.lower()}\n" for name in names)
    with pytest.raises(DefinitionError) as error:
        load(tmp_path, text, Gadget="int8 x")
    found = [each.message.partition("; ")[2] for each in error.value.diagnostics]
    assert found == ["did you mean 'Gadget'?"] * 20 + [""] * 6


def test_a_type_that_a_derived_message_needs_is_missing_in_its_line(tmp_path):
    make_files(tmp_path, {"p/action/A.action": "int8 a\n---\n---\n"})
    with pytest.raises(DefinitionError) as error:
        Library("humble", [tmp_path], origins=()).interface("p/A")
    found = [str(each).splitlines() for each in error.value.diagnostics]
    uuid = ["unique_identifier_msgs/UUID goal_id", "^" * len("unique_identifier_msgs/UUID")]
    stamp = ["builtin_interfaces/Time stamp", "^" * len("builtin_interfaces/Time")]
    lines = {"SendGoal_Request": (1, uuid), "SendGoal_Response": (2, stamp),
             "GetResult_Request": (1, uuid), "FeedbackMessage": (1, uuid)}  # fmt: skip
    for (part, (line, shown)), (message, *words) in zip(lines.items(), found, strict=True):
        place = f"<made from p/action/A>/A_{part}.msg:{line}:1: error: package '"
        assert message.startswith(place + shown[0].partition("/")[0])
        assert words == shown
