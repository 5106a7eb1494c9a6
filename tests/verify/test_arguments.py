"""``firm-hdl verify``: each argument reaches the request, and wrong combinations are refused."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import firm_hdl.verify.command as command
import firm_hdl.verify.run as run
from firm_hdl.cli import main
from firm_hdl.verify import ros2_wheels
from firm_hdl.verify.ros2_wheels import RELEASES
from firm_hdl.verify.systems.options import Request


@pytest.fixture
def request_of(monkeypatch):
    """A function that returns the request of a call, which is not run."""

    def asked(*arguments):
        found = []
        monkeypatch.setattr(command, "resolve", found.append)
        monkeypatch.setattr(run, "run_workload", lambda work: 7)
        assert main(["verify", *arguments]) == 7
        return found[0]

    return asked


SHARED = "--jobs 3 --seed 4 --results r.jsonl --report r.html"
CASES = "--cases 9 --no-broken --vcd waves --simulator iverilog"


def test_a_call_without_options_tests_all_types_as_usual(request_of):
    assert request_of("--all") == Request()


def test_every_option_of_a_run_of_own_types_reaches_the_request(request_of):
    words = f"p/A q/B --path one --path two --depends three {SHARED} {CASES} --wire ros1 "
    words += "--distro noetic --distro lyrical --systems ts2,ts1,ts2 --bus-bytes 16 --bus-bytes 2 "
    words += "--bus-bytes 16 --oracle genmsg --oracle ros2 --golden plans "
    words += "--share-circuits --reference genpy --reference fastcdr --reference genpy"
    assert request_of(*words.split()) == Request(
        types=("p/A", "q/B"),
        distros=("noetic", "lyrical"),
        paths=("one", "two"),
        depends=("three",),
        systems=("ts2", "ts1"),
        wire="ros1",
        widths=(16, 2),
        seed=4,
        jobs=3,
        oracles=("genmsg", "ros2"),
        golden="plans",
        simulator="iverilog",
        most_cases=9,
        stalled=True,
        broken=False,
        references=("genpy", "fastcdr"),
        vcd="waves",
        share_circuits=True,
        results="r.jsonl",
        report="r.html",
    )


def test_every_option_of_a_replay_reaches_the_request(request_of):
    words = "--bag one.mcap --bag two.mcap --max-message-bytes 12 --no-share-circuits --no-stalls"
    expected = Request(
        bags=("one.mcap", "two.mcap"),
        longest=12,
        share_circuits=False,
        stalled=False,
        references=(),
    )
    assert request_of(*words.split(), "--reference", "none") == expected
    types = ["p/A", "--bag", "one.mcap"]
    assert request_of(*types) == Request(types=("p/A",), bags=("one.mcap",))


def test_every_option_of_a_board_reaches_the_request(request_of):
    words = "--board sim --node node.yaml --engine amaranth --silent-seconds 2.5 p/A"
    expected = Request(
        types=("p/A",),
        distros=("lyrical",),
        systems=("board",),
        board="sim",
        node="node.yaml",
        engine="amaranth",
        silent_seconds=2.5,
    )
    assert request_of(*words.split()) == expected
    # All types of a node need not be named.
    assert request_of(*words.split()[:-1]).types == ()


def test_libraries_under_test_are_each_asked_once(request_of):
    words = "--all --sut genpy --sut rosbags --sut genpy --cases 2"
    assert request_of(*words.split()) == Request(libraries=("genpy", "rosbags"), most_cases=2)


BAG = ["--bag", "x.mcap"]


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        ([*BAG, "--all", "p/A"], "name types, or all of them with --all"),
        (["--all", "--report", "r.html"], "--report needs --results"),
        (["p/A", "--depends", "x"], "--depends needs --path"),
        (["--all", "--max-message-bytes", "9"], "--max-message-bytes needs --bag"),
        ([*BAG, "--path", "x"], "argument --bag: not allowed with argument --path"),
        ([*BAG, "--systems", "ts2"], "--bag requires --systems ts3"),
        ([*BAG, "--systems", "ts3,ts2"], "--bag requires --systems ts3"),
        ([*BAG, "--share-circuits"], "not with --share-circuits"),
        ([*BAG, "--distro", "noetic", "--distro", "lyrical"], "--bag takes one --distro"),
        ([*BAG, "--sut", "rosbags"], "not for --sut"),
        ([*BAG, "--max-message-bytes", "0"], "must be from 1 to 2147483647, not 0"),
        ([*BAG, "--max-message-bytes", "0x80000000"], "to 2147483647, not 2147483648"),
        (["--all", "--reference", "none", "--reference", "genpy"], "none excludes other"),
        (["--all", "--reference", "genpy", "--reference", "none"], "none excludes other"),
        (["--all", "--sut", "rosbags", "--no-stalls"], "do not go with --sut"),
        (["--all", "--sut", "rosbags", "--no-broken"], "do not go with --sut"),
        (["--all", "--systems", "ts1,ts4"], "no test system 'ts4'"),
        (["--all", "--systems", ""], "no test system ''"),
        ([], "name types, or all of them with --all"),
        (["--all", "std_msgs/msg/Bool"], "name types, or all of them with --all"),
        (["--all", "--jobs", "0"], "must be at least 1, not 0"),
        (["--all", "--cases", "few"], "'few' is not a number"),
        (["--all", "--simulator", "abacus"], "invalid choice: 'abacus'"),
        (["--all", "--sut", "abacus"], "invalid choice: 'abacus'"),
        (["--sut", "rosbags"], "name types, or all of them with --all"),
    ],
)
def test_wrong_combinations_are_refused(capsys, arguments, reason):
    with pytest.raises(SystemExit) as left:
        main(["verify", *arguments])
    assert left.value.code == 2
    assert reason in capsys.readouterr().err


OTHERS = {
    "bag": "x",
    "board": "sim",
    "bus-bytes": "4",
    "golden": "x",
    "oracle": "genmsg",
    "node": "x",
    "reference": "none",
    "simulator": "ghdl",
    "systems": "ts1",
    "vcd": "x",
    "write-node": "x",
}


@pytest.mark.parametrize("name", OTHERS)
def test_options_of_test_systems_are_refused_beside_libraries(capsys, name):
    with pytest.raises(SystemExit) as left:
        main(["verify", "--sut", "rosbags", "p/A", f"--{name}", OTHERS[name]])
    assert left.value.code == 2
    assert "--sut" in capsys.readouterr().err


def test_releases_have_the_versions_of_their_packages(monkeypatch, tmp_path):
    """The lists beside the module pin them."""
    assert [release.name for release in RELEASES] == ["jazzy", "kilted"]
    for release in RELEASES:
        text = Path(ros2_wheels.__file__).with_name(f"{release.name}.txt").read_text()
        for package, version in (("rosidl-parser", "rosidl"), ("fastcdr", "fastcdr")):
            (pinned,) = re.findall(rf"^ros-{package}==(\d+\.\d+)\.", text, re.MULTILINE)
            assert getattr(release, version) == pinned
    monkeypatch.setenv("FIRM_HDL_ROS2_WHEELS", str(tmp_path))
    assert RELEASES[0].python == tmp_path / "jazzy" / "bin" / "python"
    monkeypatch.setenv("FIRM_HDL_ROS2_WHEELS", "")
    assert RELEASES[1].folder.parts[-2:] == ("ros2", "kilted")


def test_a_node_is_written_instead_of_a_run(tmp_path, capsys):
    path = tmp_path / "node.yaml"
    assert main(["verify", "std_msgs/msg/Bool", "--write-node", str(path)]) == 0
    assert path.exists() and capsys.readouterr().out == f"wrote   {path}\n"
