"""rosbags as the judge of user-defined types."""

from __future__ import annotations

from pathlib import Path

import pytest

from firm_hdl import load_message
from firm_hdl.frontend import Library
from firm_hdl.model import Message
from firm_hdl.verify import Options, accept
from firm_hdl.verify.references import user_oracle as module
from firm_hdl.verify.references.oracle import distro_oracle
from firm_hdl.verify.references.user_oracle import judge_of, oracle_name
from firm_hdl.verify.results.verdict import NotJudgedError
from tests.verify.judged import assert_passed


def own(folder: Path, text: str, distro: str = "lyrical", name: str = "Own") -> Message:
    """A function that loads a type of a user's package."""
    (folder / "own_msgs" / "msg").mkdir(parents=True, exist_ok=True)
    (folder / "own_msgs" / "msg" / f"{name}.msg").write_text(text)
    return load_message(f"own_msgs/{name}", distro=distro, paths=[folder])


@pytest.mark.parametrize("distro", ["noetic", "foxy", "lyrical"])
def test_structure_is_that_of_the_distribution(distro):
    library = Library(distro)
    for name in library.names()[::5]:
        judge = judge_of(library.message(name))
        right = distro_oracle(distro)
        assert judge.oracle.structure(judge.name) == right.structure(judge.name)
        assert judge.note == ""
        assert judge_of(library.message(name), distro).oracle is right


def test_names_are_those_of_rosbags(tmp_path):
    assert oracle_name(load_message("std_msgs/Header", distro="noetic")) == "std_msgs/msg/Header"
    assert oracle_name(load_message("std_msgs/msg/Header")) == "std_msgs/msg/Header"


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


def test_definition_that_rosbags_reads_alike_has_no_note(tmp_path):
    message = own(tmp_path, "uint8 B=1\nHeader head\ntime[] times\nstring s # text\n", "noetic")
    assert judge_of(message).note == ""


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
    result = accept("lyrical", "own_msgs/msg/Chars", Options(paths=(str(tmp_path),)))
    assert_passed(result)


@pytest.mark.parametrize(
    ("error", "output"),
    [
        (KeyError("gone"), "'gone'"),
        (ValueError("first\nsecond"), "first"),
        (RecursionError(), "RecursionError"),
    ],
)
def test_types_that_rosbags_refuses_are_not_judged(tmp_path, monkeypatch, error, output):
    def refuse(*given: object) -> None:
        raise error

    message = own(tmp_path, "uint8 a\n")
    monkeypatch.setattr(module, "get_types_from_msg", refuse)
    with pytest.raises(NotJudgedError) as raised:
        module._oracle(message, {message.name: "uint8 a\n"})
    assert str(raised.value) == f"rosbags refuses the definition: {output}"
