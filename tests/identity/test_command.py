"""The commands ``md5``, ``hash`` and ``proto``: exact output, exact error messages."""

from __future__ import annotations

import hashlib

import pytest

from firm_hdl.cli import main

from ..frontend.workspace import make_files

DEFINITIONS = {
    "p/msg/A.msg": "int32 a\n",
    "p/srv/S.srv": "int8 a\n---\nint8 b\n",
    "p/action/Do.action": "int8 a\n---\nint8 b\n---\nint8 c\n",
    "p/msg/Bad.msg": "int33 a\n",
    "p/msg/Worse.msg": "int34 a\n",
    "p/msg/AsBad.msg": "int33 a\n",
    "p/msg/Both.msg": "int8 x\n",
    "p/srv/Both.srv": "int8 y\n---\n",
    "p/msg/Do_SendGoal.msg": "int8 z\n",
}


@pytest.fixture
def run(tmp_path, monkeypatch, capsys):
    """Run the command in a folder with packages; return status, output and errors."""
    make_files(tmp_path, DEFINITIONS)
    monkeypatch.chdir(tmp_path)

    def run(*arguments):
        status = main([*arguments, "--path", "."])
        return status, *capsys.readouterr()

    return run


def test_md5_is_of_ros1_unless_told_otherwise(run):
    assert run("md5", "std_msgs/String", "p/A") == (
        0,
        "992ce8a1687cec8c8bd883ec73ca41d1  std_msgs/String\n"
        "5c9fb1a886e81e3162a5c87bf55c072b  p/A\n",
        "",
    )
    status, out, err = run("md5", "std_msgs/msg/String", "--distro", "humble")
    assert (status, out) == (1, "")
    assert err == "error: humble: md5 sums are for ROS 1; for ROS 2, use 'firm-hdl hash'\n"


def test_md5_of_an_action_is_that_of_its_messages(run):
    status, out, err = run("md5", "p/Do")
    assert (status, err) == (0, "")
    parts = ["Goal", "Result", "Feedback", "ActionGoal", "ActionResult", "ActionFeedback", "Action"]
    assert [line.split("  ")[1] for line in out.splitlines()] == [f"p/Do{part}" for part in parts]


def digest(text):
    return hashlib.md5(text.encode()).hexdigest()


def test_message_and_service_of_one_name_are_two_types_in_ros1(run):
    two = f"{digest('int8 x')}  p/Both\n{digest('int8 y')}  p/Both\n"
    assert run("md5", "p/msg/Both", "p/srv/Both") == (0, two, "")
    # Each type is listed once, by whatever name it is asked for.
    assert run("md5", "p/Both", "p/srv/Both", "p/msg/Both", "p/srv/Both") == (0, two, "")


def test_services_of_actions_are_those_of_ros2(run):
    names = ["p/action/Do_SendGoal", "p/action/Do_GetResult"]
    status, out, err = run("hash", *names, "p/Do_GetResult")
    assert (status, err) == (0, "")
    found = [line.split("  ") for line in out.splitlines()]
    assert [name for _, name in found] == names
    assert len({hashed for hashed, _ in found}) == 2
    # In ROS 1, such a name is one like any other.
    assert run("md5", "p/Do_SendGoal") == (0, f"{digest('int8 z')}  p/Do_SendGoal\n", "")


@pytest.mark.parametrize("name", ["p/srv/S_SendGoal", "p/msg/A_GetResult", "p/Nothing_SendGoal"])
def test_only_actions_have_services_of_their_own(run, name):
    status, out, err = run("hash", name)
    assert (status, out) == (1, "")
    base = name.rpartition("/")[2]
    assert err.startswith(f"error: type '{base}' is not defined in package 'p'")


def test_hash_of_all_types_that_have_one(run):
    names = ["p/msg/A", "p/srv/S", "p/srv/S_Event", "p/action/Do", "p/action/Do_SendGoal"]
    status, out, err = run("hash", *names, "p/action/Do_GetResult_Request", "p/A")
    assert (status, err) == (0, "")
    hashes, found = zip(*(line.split("  ") for line in out.splitlines()), strict=True)
    assert [*found] == [*names, "p/action/Do_GetResult_Request"]
    assert len({*hashes}) == len(names) + 1
    assert all(h.startswith("RIHS01_") and len(h) == 7 + 64 for h in hashes)


def test_hash_refuses_types_without_one(run):
    assert run("hash", "p/A", "--distro", "noetic") == (
        1,
        "",
        "error: noetic: type hashes are for ROS 2; for ROS 1, use 'firm-hdl md5'\n",
    )
    status, out, err = run("hash", "p/msg/A", "p/srv/S", "--distro", "foxy")
    assert (status, err, out.splitlines()[0].partition("  ")[2]) == (
        1,
        "error: foxy: p/srv/S has no type hash: services have hashes from iron on, where they have "
        "an event message, too\n",
        "p/msg/A",
    )


@pytest.mark.parametrize("command", ["md5", "hash"])
def test_all_errors_are_reported_at_once(run, command):
    status, out, err = run(command, "p/Bad", "p/A", "p/Worse", "p/Nothing")
    # Good types are processed all the same.
    assert (status, len(out.splitlines())) == (1, 1)
    assert out.endswith(("  p/msg/A\n", "  p/A\n"))
    for word in ("'int33'", "'int34'", "'Nothing'"):
        assert word in err


def test_proto_prints_quotes_unless_told_otherwise(run):
    assert run("proto", "p/msg/A") == (0, '"a: 0\n"\n', "")
    assert run("proto", "p/srv/S", "--no-quotes") == (0, "a: 0\n\n", "")
    assert run("proto", "p/A", "--distro", "noetic") == (0, '"a: 0"\n', "")
    assert run("proto", "p/Do", "--distro", "noetic", "--no-quotes") == (0, "a: 0\n", "")


def test_proto_of_too_long_examples_is_no_traceback(run, tmp_path):
    make_files(tmp_path, {"p/msg/Huge.msg": "float64[4000000000] data\n"})
    assert run("proto", "p/Huge") == (
        1,
        "",
        "error: p/msg/Huge has an example of 24000000006 characters, which is more than "
        "268435456\n",
    )
