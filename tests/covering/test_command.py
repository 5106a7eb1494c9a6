"""The command ``firm-hdl cover``."""

from __future__ import annotations

import pytest

from firm_hdl.cli import main
from firm_hdl.covering.command import _share, read_chosen
from tests.frontend.recordings import make_recording
from tests.frontend.workspace import make_files

NAMES = ["geometry_msgs/msg/Point", "geometry_msgs/msg/Vector3", "std_msgs/msg/Bool"]


def test_types_and_what_they_add_are_printed(capsys):
    assert main(["cover", *NAMES]) == 0
    out, err = capsys.readouterr()
    assert [line.partition(":")[0] for line in out.splitlines()] == [NAMES[0], NAMES[2]]
    assert "definition: field bool" in out and "grammar: ros2 field: BOOL_TYPE FIELD_NAME" in out
    assert err.startswith("2 of 3 types have 100 % of the ")
    assert err.endswith("; 2 different circuits\n")


def test_written_file_passes_its_check(tmp_path, capsys):
    path = tmp_path / "new" / "chosen.txt"
    assert main(["cover", *NAMES, "--out", str(path)]) == 0
    assert read_chosen(path) == [NAMES[0], NAMES[2]]
    capsys.readouterr()
    assert main(["cover", *NAMES, "--check", str(path)]) == 0
    out, err = capsys.readouterr()
    assert out == "" and err.startswith("2 of 3 types have 100 % of the ")


def test_missing_features_are_named_with_a_type_that_has_them(tmp_path, capsys):
    path = tmp_path / "chosen.txt"
    path.write_text(f"# One.\n\n{NAMES[0]}\n")
    assert main(["cover", *NAMES, "--check", str(path)]) == 1
    out, err = capsys.readouterr()
    assert "missing: definition: field bool (in std_msgs/msg/Bool)\n" in out
    assert "float64" not in out
    assert "1 of 3 types have " in err and "100 %" not in err


def test_a_missing_feature_is_shown_by_the_simplest_type_that_has_it(tmp_path, capsys):
    path = tmp_path / "chosen.txt"
    path.write_text("std_msgs/msg/Bool\n")
    names = [
        "std_msgs/msg/Bool",
        "std_msgs/msg/Header",
        "std_msgs/msg/String",
        "sensor_msgs/msg/Imu",
    ]
    for order in (names, names[::-1]):
        assert main(["cover", *order, "--check", str(path)]) == 1
        found = capsys.readouterr().out
        assert "missing: definition: field string (in std_msgs/msg/String)\n" in found


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("# nothing\n", "error: '{path}' names no types"),
        ("x/msg/Y\n", "error: '{path}' names types that are not among the given ones: x/msg/Y"),
        (
            f"{NAMES[1]}\nx/msg/Z\nx/msg/Y\n",
            "error: '{path}' names types that are not among the given ones: x/msg/Z, x/msg/Y",
        ),
        ("\xff", "error: '{path}' is not UTF-8 text"),
        (None, "error: '{path}': No such file or directory"),
    ],
)
def test_a_wrong_file_is_explained(tmp_path, capsys, text, message):
    path = tmp_path / "chosen.txt"
    if text is not None:
        path.write_text(text, encoding="latin-1")
    assert main(["cover", *NAMES, "--check", str(path)]) == 1
    assert capsys.readouterr().err == message.format(path=path) + "\n"


def test_a_type_that_cannot_be_used_does_not_keep_the_others_out(tmp_path, capsys):
    folder = tmp_path / "own_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "Good.msg").write_text("wstring<=3[4] text\n")
    (folder / "Bad.msg").write_text("int32 a\nint32 a\n")
    (folder / "Large.msg").write_text("uint8[20000000] a\n")
    assert main(["cover", "--path", str(tmp_path)]) == 0
    out, err = capsys.readouterr()
    assert "own_msgs/msg/Good: " in out and "own_msgs/msg/Bad" not in out
    assert "left out: own_msgs/msg/Bad: " in err and "left out: own_msgs/msg/Large: " in err
    # A type that the user names is an error.
    assert main(["cover", "--path", str(tmp_path), "own_msgs/msg/Bad"]) == 1
    for names in (["Large"], ["Large", "Good"], ["Good", "Large"]):
        words = [f"own_msgs/msg/{name}" for name in names]
        capsys.readouterr()
        assert main(["cover", "--path", str(tmp_path), *words]) == 1
        assert "left out" not in capsys.readouterr().err


def test_folders_are_chosen_from_with_services_and_without_the_distribution(tmp_path, capsys):
    for kind, text in (("msg", "uint8 a\n"), ("srv", "---\nstring b\n")):
        (tmp_path / "p" / kind).mkdir(parents=True)
        (tmp_path / "p" / kind / f"T.{kind}").write_text(text)
    assert main(["cover", "--path", str(tmp_path), "--out", str(tmp_path / "chosen.txt")]) == 0
    assert all(name.startswith("p/srv/T_") for name in read_chosen(tmp_path / "chosen.txt"))
    assert " of 4 types have 100 % " in capsys.readouterr().err


def test_the_file_is_sorted_and_names_the_bus(tmp_path, capsys):
    path = tmp_path / "chosen.txt"
    names = ["sensor_msgs/msg/Imu", "std_msgs/msg/Bool", "std_msgs/msg/String"]
    assert main(["cover", *names, "--bus-bytes", "2", "--out", str(path)]) == 0
    # The types are chosen, and printed, by what they add.
    printed = [line.partition(":")[0] for line in capsys.readouterr().out.splitlines()]
    assert printed != names and sorted(printed) == names
    head, *_ = text = path.read_text().splitlines()
    assert head.endswith("; bus of 2 bytes.")
    assert text[2:] == names


@pytest.mark.parametrize(
    ("options", "feature"),
    [
        (["--bus-bytes", "1"], "plan: first part of scalar, 8 bytes each"),
        (["--wire", "ros1"], "plan: wire ros1"),
    ],
)
def test_features_are_those_of_the_plan_that_is_asked_for(capsys, options, feature):
    assert main(["cover", "geometry_msgs/msg/Point", *options]) == 0
    assert feature in capsys.readouterr().out


def test_a_limit_that_a_type_exceeds_is_an_error(capsys):
    assert main(["cover", "geometry_msgs/msg/Point", "--max-message-bytes", "27"]) == 1
    assert "28 bytes" in capsys.readouterr().err


def test_types_on_which_others_depend_are_found_and_not_chosen_from(tmp_path, capsys):
    make_files(tmp_path, {"src/p/msg/A.msg": "q/B b\n", "more/q/msg/B.msg": "int16 c\nint8 d\n"})
    words = ["--path", str(tmp_path / "src"), "--depends", str(tmp_path / "more")]
    assert main(["cover", *words]) == 0
    out, err = capsys.readouterr()
    assert out.startswith("p/msg/A: ") and "definition: field int16" in out
    assert err.startswith("1 of 1 types ")


@pytest.mark.parametrize("option", ["--out", "--check"])
def test_nothing_is_no_covering_set(tmp_path, capsys, option):
    make_files(tmp_path / "src", {"p/msg/Bad.msg": "int33 a\n"})
    file = tmp_path / "chosen.txt"
    if option == "--check":
        file.write_text("std_msgs/msg/Bool\n")
    assert main(["cover", "--path", str(tmp_path / "src"), option, str(file)]) == 1
    told = capsys.readouterr().err.splitlines()
    assert told[0].startswith("left out: p/msg/Bad: ")
    assert told[-1] == "error: there are no types to choose from"
    assert file.exists() == (option == "--check")


def test_types_of_a_recording_are_chosen_from(tmp_path, capsys):
    bag = str(make_recording(tmp_path, "bag"))
    assert main(["cover", "--bag", bag]) == 0
    out, err = capsys.readouterr()
    assert "my_msgs/Wheel: " in out and " of 4 types " in err


def test_a_share_is_rounded_down_so_that_only_all_is_100_percent():
    few = frozenset(f"plan: {number}" for number in range(299))
    types = {"a": few, "b": frozenset({"plan: 299"})}
    assert " have 99 % of the 300 features (plan 299 of 300)" in _share(types, ["a"])
    assert " have 100 % of the 300 features (plan 300 of 300)" in _share(types, ["a", "b"])
