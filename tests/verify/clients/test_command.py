"""``firm-hdl verify --sut``: its arguments, its output, and its exit status."""

from __future__ import annotations

import re

from firm_hdl.cli import main
from firm_hdl.verify.references.clients import CLIENTS, client, find_clients
from firm_hdl.verify.results.file import read_results
from tests.frontend.workspace import make_files


def test_libraries_are_judged_and_counted(capsys, library_here, tmp_path):
    for name in ("rosbags", "fastcdr", "firm-hdl", "genpy"):
        library_here(name)
    suts = ["--sut", "rosbags", "--sut", "firm-hdl", "--results", str(tmp_path / "r.jsonl")]
    arguments = ["verify", "--distro", "lyrical", "--distro", "noetic", "--jobs", "1", *suts]
    assert main([*arguments, "--cases", "5", "std_msgs/msg/Byte", "std_msgs/msg/Bool"]) == 0
    output = capsys.readouterr().out
    version = client("fastcdr").version()
    assert f"firm-hdl 0.1.0 on cdr: judged by fastcdr {version}\n" in output
    assert "firm-hdl 0.1.0 on ros1: judged by genpy " in output
    for library in ("rosbags", "firm-hdl"):
        _, _, own = output.partition(f"\n{library} {client(library).version()}: ")
        count, *lines = own.splitlines()[:4]
        assert int(count.split()[0]) > 80
        assert lines[:2] == [f"{each:8}    2 of    2 types agree" for each in ("noetic", "lyrical")]
        assert lines[2].startswith("4 of them with a known difference between libraries: ")
        assert ("rosbags-byte-signed" in lines[2]) == (library == "rosbags")
    found = read_results(tmp_path / "r.jsonl")
    assert {test.system for test in found.planned} == {"sut rosbags", "sut firm-hdl"}
    assert not found.missing and len(found.records) == 8


def test_new_differences_are_shown_with_their_smallest_value(
    capsys, library_here, monkeypatch, tmp_path
):
    library_here("fastcdr")
    make_files(tmp_path, {"p/msg/A.msg": "uint16 n\nuint8[] x\n"})
    kind = type(client("rosbags").open(_message(tmp_path), "cdr"))
    write = kind.write

    def wrong(self, value):
        value.n ^= 1
        return write(self, value)

    monkeypatch.setattr(kind, "write", wrong)
    arguments = ["verify", "--sut", "rosbags", "--path", str(tmp_path), "--cases", "9"]
    assert main([*arguments, "--jobs", "1", "p/msg/A"]) == 1
    output = capsys.readouterr().out
    (n,) = re.findall(
        r"FAIL p/msg/A \(lyrical\), sut rosbags\n    encode differs from fastcdr\n"
        r"    uint16 n\n    uint8\[\] x\n"
        r"    value: n: (\d+), x: \[\]\n",
        output,
    )
    right, other = ((int(n) ^ bit).to_bytes(2, "little").hex() for bit in (0, 1))
    assert (
        f"    fastcdr: 00010000{right}000000000000\n    rosbags: 00010000{other}000000000000\n"
        f"    again: firm-hdl verify --sut rosbags --distro lyrical --path {tmp_path} --cases 9 "
        "p/msg/A\n"
    ) in output
    assert "lyrical     0 of    1 types agree\n" in output


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
    why = "not judged: std_msgs/msg/Bool (noetic), sut cyclonedds: "
    assert f"{why}no reference for" in output or f"{why}cyclonedds does not speak" in output
    assert main([*call, "--distro", "noetic", "std_msgs/msg/Bool"]) == 1
    assert capsys.readouterr().out.endswith("no test was judged, so the run fails\n")
