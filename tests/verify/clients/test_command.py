"""``firm-hdl verify --sut``: its arguments, its output, and its exit status."""

from __future__ import annotations

import pytest

from firm_hdl.cli import main
from firm_hdl.verify.references.clients import CLIENTS, client, find_clients
from tests.frontend.workspace import make_files


@pytest.mark.parametrize(
    ("arguments", "output"),
    [
        (["--sut", "abacus", "--all"], "invalid choice: 'abacus'"),
        (["--sut", "rosbags"], "name types, or all of them with --all"),
        (["--sut", "rosbags", "--all", "--systems", "ts1"], "--systems does not go with --sut"),
        (["--sut", "rosbags", "--all", "--bus-bytes", "1"], "--bus-bytes does not go with --sut"),
        (["--sut", "rosbags", "--all", "--results", "x"], "--results does not go with --sut"),
        (["--sut", "rosbags", "--all", "--no-stalls"], "--no-stalls and --no-broken do not go"),
        (
            ["--all", "--reference", "none", "--reference", "genpy"],
            "none excludes other references",
        ),
    ],
)
def test_wrong_calls_are_refused(capsys, arguments, output):
    with pytest.raises(SystemExit) as left:
        main(["verify", *arguments])
    assert left.value.code == 2
    assert output in capsys.readouterr().err


def test_libraries_are_judged_and_counted(capsys, library_here):
    for name in ("rosbags", "fastcdr", "firm-hdl", "genpy"):
        library_here(name)
    suts = ["--sut", "rosbags", "--sut", "firm-hdl"]
    arguments = ["verify", "--distro", "lyrical", "--distro", "noetic", "--jobs", "1", *suts]
    assert main([*arguments, "--cases", "5", "std_msgs/msg/Byte", "std_msgs/msg/Bool"]) == 0
    output = capsys.readouterr().out
    version = client("fastcdr").version()
    assert f"firm-hdl 0.1.0 on cdr: judged by fastcdr {version}\n" in output
    assert "firm-hdl 0.1.0 on ros1: judged by genpy " in output
    rows = {line.split()[0]: line.split() for line in output.splitlines() if line[:1].isalpha()}
    assert rows["rosbags"][2:6] == ["0", "4", "0", "0"]
    assert int(rows["rosbags"][6]) > 80
    assert "\nknown, rosbags: rosbags-byte-signed: " in output
    assert output.endswith(" 0 differ\n")


def test_new_differences_are_shown_with_their_smallest_case(
    capsys, library_here, monkeypatch, tmp_path
):
    library_here("fastcdr")
    make_files(tmp_path, {"p/msg/A.msg": "string s\nuint16 n\nfloat64 x\n"})
    kind = type(client("rosbags").open(_message(tmp_path), "cdr"))
    write = kind.write

    def wrong(self, value):
        if hasattr(value, "n"):
            value.n ^= 1
        return write(self, value)

    monkeypatch.setattr(kind, "write", wrong)
    arguments = ["verify", "--sut", "rosbags", "--path", str(tmp_path), "--cases", "3"]
    assert main([*arguments, "--jobs", "1", "p/msg/A"]) == 1
    output = capsys.readouterr().out
    assert (
        "DIFFERS rosbags, encode: p/msg/A (lyrical)\n    uint16 n\n    value: n: 0\n"
        "    fastcdr: 000100000000\n    rosbags: 000100000100\n"
        f"    again: firm-hdl verify --sut rosbags --distro lyrical --path {tmp_path} --cases 3 "
        "p/msg/A\n"
    ) in output
    assert output.endswith(" 1 differ\n")


def _message(folder):
    from firm_hdl.frontend import Library

    return Library("lyrical", [folder]).message("p/msg/A")


def test_a_library_that_is_not_installed_is_an_error(capsys, monkeypatch):
    monkeypatch.setattr(CLIENTS["cyclonedds"], "missing", lambda self: "cyclonedds is not there")
    arguments = ["verify", "--sut", "cyclonedds", "--distro", "lyrical", "std_msgs/msg/Bool"]
    assert main(arguments) == 1
    assert capsys.readouterr().err == "error: cyclonedds is not there\n"


def test_without_ros_s_own_rosbags_judges(capsys, monkeypatch):
    monkeypatch.setattr(CLIENTS["fastcdr"], "missing", lambda self: "no Fast CDR")
    arguments = ["verify", "--sut", "firm-hdl", "--distro", "lyrical", "--cases", "2", "--jobs"]
    assert main([*arguments, "1", "std_msgs/msg/Bool"]) == 0
    output = capsys.readouterr().out
    assert "fastcdr, which is ROS's own on cdr, is not installed: no Fast CDR\n" in output
    assert "firm-hdl 0.1.0 on cdr: judged by rosbags " in output
    versions, missing = find_clients(["fastcdr", "rosbags"])
    assert missing == {"fastcdr": "no Fast CDR"} and list(versions) == ["rosbags"]


def test_library_is_not_asked_about_unnamed_wires(library_here, capsys):
    for name in ("cyclonedds", "fastcdr"):
        library_here(name)
    call = ["verify", "--sut", "cyclonedds", "--cases", "2", "--jobs", "1"]
    assert main([*call, "std_msgs/msg/Bool"]) == 0
    assert main([*call, "--distro", "noetic", "--distro", "lyrical", "std_msgs/msg/Bool"]) == 1
    output = capsys.readouterr().out
    assert "not judged: std_msgs/msg/Bool (noetic), cyclonedds: no reference for" in output or (
        "not judged: std_msgs/msg/Bool (noetic), cyclonedds: cyclonedds does not speak" in output
    )
    assert main([*call, "--distro", "noetic", "std_msgs/msg/Bool"]) == 1
    assert capsys.readouterr().out.endswith("no test was judged, so the run fails\n")
