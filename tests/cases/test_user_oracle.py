"""rosbags as the judge of user-defined types."""

from __future__ import annotations

from pathlib import Path

import pytest

from firm_hdl import load_message
from firm_hdl.cases import NotJudgedError
from firm_hdl.cases.oracle import distro_oracle
from firm_hdl.cases.user_oracle import judge_of, oracle_name
from firm_hdl.frontend import Library
from firm_hdl.model import Message
from firm_hdl.verify.systems.options import CaseOptions
from tests.verify.judged import accept, assert_passed


def own(folder: Path, text: str, distro: str = "lyrical", name: str = "Own") -> Message:
    """A function that loads a type of a user's package."""
    (folder / "own_msgs" / "msg").mkdir(parents=True, exist_ok=True)
    (folder / "own_msgs" / "msg" / f"{name}.msg").write_text(text)
    return load_message(f"own_msgs/{name}", distro=distro, paths=[folder])


@pytest.mark.sampled(3)
@pytest.mark.parametrize("distro", ["noetic", "foxy", "lyrical"])
def test_structure_is_that_of_the_distribution(distro):
    library = Library(distro)
    for name in library.names()[::5]:
        judge = judge_of(library.message(name))
        right = distro_oracle(distro)
        assert judge.oracle.structure(judge.name) == right.structure(judge.name)
        assert judge.note == ""
        assert judge_of(library.message(name), distro).oracle is right


@pytest.mark.parametrize(
    ("dialect", "name", "found"),
    [
        ("ros1", "p/A", "p/msg/A"),
        ("ros1", "time", "builtin_interfaces/msg/Time"),
        ("ros1", "duration", "builtin_interfaces/msg/Duration"),
        ("ros2", "p/msg/A", "p/msg/A"),
        ("ros2", "p/action/A_Goal", "p/action/A_Goal"),
        ("ros2", "p/srv/A_Request", "p/srv/msg/A_Request"),
    ],
)
def test_each_kind_of_name_is_that_of_rosbags(dialect, name, found):
    assert oracle_name(Message(name=name, dialect=dialect, fields=())) == found


def test_a_type_that_only_the_user_has_is_judged_by_its_fields(tmp_path):
    message = own(tmp_path, "std_msgs/Header h\nuint16[<=2] a\n")
    judge = judge_of(message, "lyrical")
    assert judge.oracle is not distro_oracle("lyrical") and judge.note == ""
    assert [name for name, _ in judge.oracle.fields("own_msgs/msg/Own")] == ["h", "a"]
    # The same type of a distribution is that of the distribution, if it is said to be of it.
    header = message.fields[0].type
    assert judge_of(header, "lyrical").oracle is distro_oracle("lyrical")
    assert judge_of(header).oracle is not distro_oracle("lyrical")


def test_times_of_ros1_are_those_of_ros2_to_rosbags(tmp_path):
    own(tmp_path, "time t\n", "noetic", "Inner")
    judge = judge_of(own(tmp_path, "time[] t\nduration d\nInner i\n", "noetic"))
    assert judge.oracle.dialect == "ros1" and judge.note == ""
    for name in ("Time", "Duration"):
        fields = judge.oracle.fields(f"builtin_interfaces/msg/{name}")
        assert [(field, kind[1][0]) for field, kind in fields] == [
            ("sec", "int32"),
            ("nanosec", "uint32"),
        ]


def test_a_field_that_no_wire_has_is_not_judged(tmp_path):
    (tmp_path / "own_msgs" / "msg").mkdir(parents=True)
    text = "module own_msgs { module msg { struct Own { octet a; long double x; }; }; };"
    (tmp_path / "own_msgs" / "msg" / "Own.idl").write_text(text)
    message = load_message("own_msgs/Own", paths=[tmp_path])
    with pytest.raises(NotJudgedError, match="long double"):
        judge_of(message)


def test_a_definition_that_rosbags_cannot_read_is_noted(tmp_path):
    message = own(tmp_path, "uint8 a 3\r\nstring s\r\n")
    assert judge_of(message).note == (
        "rosbags cannot read the definition, and was given the fields as they were resolved"
    )


def test_wide_strings_are_not_judged(tmp_path):
    message = (
        own(tmp_path, "Inner[2] inner\n")
        if own(tmp_path, "wstring<=3[] text\n", name="Inner")
        else None
    )
    assert message is not None
    with pytest.raises(
        NotJudgedError, match=r"^rosbags has no wstring, which own_msgs/msg/Inner\.text is$"
    ):
        judge_of(message)


def test_definition_that_rosbags_reads_in_another_way_is_noted(tmp_path):
    # rosbags reads the second line as a field instead of a constant.
    message = own(tmp_path, "uint8 a\nuint8 b=1\n", distro="noetic")
    judge = judge_of(message)
    assert [name for name, _ in judge.oracle.fields(judge.name)] == ["a"]
    assert judge.note.endswith("and was given the fields as they were resolved")


IDL = """\
module own_msgs { module msg {
  typedef char char__3[3];
  struct Chars { char one; char__3 three; sequence<char> many; wchar wide; octet byte; };
}; };
"""


def test_chars_of_idl_are_signed(tmp_path):
    (tmp_path / "own_msgs" / "msg").mkdir(parents=True)
    (tmp_path / "own_msgs" / "msg" / "Chars.idl").write_text(IDL)
    (tmp_path / "own_msgs" / "msg" / "Plain.msg").write_text("char one\n")
    judge = judge_of(load_message("own_msgs/Chars", paths=[tmp_path]))
    fields = dict(judge.oracle.fields(judge.name))
    assert fields["one"][1][0] == "int8" and fields["wide"][1][0] == "uint16"
    assert fields["three"][1][0][1][0] == fields["many"][1][0][1][0] == "int8"
    plain = judge_of(load_message("own_msgs/Plain", paths=[tmp_path]))
    assert dict(plain.oracle.fields(plain.name))["one"][1][0] == "char" and plain.note == ""
    result = accept("lyrical", "own_msgs/msg/Chars", CaseOptions(paths=(str(tmp_path),)))
    assert_passed(result)
