# amaranth: UnusedElaboratable=no
"""``firm-hdl verify --board``: arguments, descriptions, simulation, UDP, and results."""

from __future__ import annotations

import os
import pty
import re
import tty

import pytest

from firm_hdl.cli import main
from firm_hdl.node import read_description
from firm_hdl.verify.board.description import loop_text
from firm_hdl.verify.results.file import read_results
from firm_hdl.verify.results.verdict import Failed, Passed
from tests.node.boards.test_boards import ByteNode, UdpNode
from tests.verify.board.fakes import BOTH, STRING, LoopNode, described

BOOL = BOTH[0]
FEW = ["--cases", "4", "--reference", "none"]
SIM = ["verify", "--board", "sim", "--engine", "amaranth", *FEW]


@pytest.mark.thorough
def test_a_node_in_simulation_passes(tmp_path, capsys):
    path = tmp_path / "r.jsonl"
    assert main([*SIM, "--results", str(path), BOOL]) == 0
    assert "12 packets, 0 failures in " in capsys.readouterr().out
    (record,) = read_results(path).records.values()
    assert record.verdict == Passed(4) and record.packets == 12 and record.cases == 4
    assert record.test.system == "board" and record.test.wire == "cdr"
    assert record.command == (
        "firm-hdl verify --board sim --engine amaranth --distro lyrical --bus-bytes 8 --seed 0 "
        f"--cases 4 --reference none {BOOL}"
    )
    # A run that goes on with its file has nothing to do, and opens no board.
    assert main([*SIM, "--results", str(path), BOOL]) == 0


def test_a_node_in_simulation_with_a_fault_fails(tmp_path, capsys):
    """The accelerator is the user's, so it may do anything; the bytes decide."""
    node = tmp_path / "node.yaml"
    text = loop_text([BOOL], "lyrical", board="sim")
    own = "tests.verify.board.accelerators:Flips"
    node.write_text(text.replace("firm_hdl.node.loop:Loop", own))
    assert main([*SIM, "--node", str(node)]) == 1
    output = capsys.readouterr().out
    assert "board: packet 2 of 4 differs at byte 4: 0001000001 instead of 0001000000" in output
    assert f"again: firm-hdl verify --board sim --node {node} --engine amaranth" in output


@pytest.fixture
def served():
    """Serve nodes behind UDP; they end with the test."""
    nodes = []

    def serve(node):
        nodes.append(UdpNode(node=node))
        return f"udp://127.0.0.1:{nodes[-1].port}"

    yield serve
    for each in nodes:
        each.stop()


def test_a_board_behind_udp_with_a_description_of_its_own(served, tmp_path, capsys):
    node = tmp_path / "node.yaml"
    assert main(["verify", "--write-node", str(node), *BOTH]) == 0
    board = served(LoopNode(read_description(node)))
    command = ["verify", "--board", board, "--silent-seconds", "60", *FEW]
    assert main([*command, "--node", str(node)]) == 0
    assert main([*command, "--node", str(node), STRING]) == 0
    # Without the file, the description is the same; the order of the types does not count.
    assert main([*command, *reversed(BOTH)]) == 0
    assert re.findall(r"(\d+) packets, 0 failures", capsys.readouterr().out) == ["25", "13", "25"]
    # One type alone is another node.
    assert main([*command, BOOL]) == 1
    assert "its node is another one" in capsys.readouterr().out


def test_a_board_behind_a_serial_line(capsys):
    master, slave = pty.openpty()
    tty.setraw(master)
    name = f"serial://{os.ttyname(slave)}?baud=115200"
    node = ByteNode(master, node=LoopNode(described(STRING, board=name)))
    try:
        assert main(["verify", "--board", name, "--silent-seconds", "60", *FEW, STRING]) == 0
        # Half of the bytes have a flipped bit.
        node.flips = 0.5
        assert main(["verify", "--board", name, "--silent-seconds", "0.3", *FEW, STRING]) == 1
    finally:
        node.stop()
        os.close(slave)
        os.close(master)
    output = capsys.readouterr().out
    assert "13 packets, 0 failures" in output
    assert re.search(r"the board does not answer for 0\.3 s", output)


def test_a_board_that_is_not_there_fails(tmp_path, capsys):
    path = tmp_path / "r.jsonl"
    arguments = ["--silent-seconds", "0.1", "--results", str(path), *FEW, BOOL]
    # Port 9 discards what comes, if anyone listens there.
    assert main(["verify", "--board", "udp://127.0.0.1:9", *arguments]) == 1
    assert "udp://127.0.0.1:9: the board does not answer for 0.1 s" in capsys.readouterr().out
    (record,) = read_results(path).records.values()
    assert isinstance(record.verdict, Failed)
    assert main(["verify", "--board", "serial:///dev/no-such-tty", *FEW, BOOL]) == 1
    assert "cannot open '/dev/no-such-tty': No such file or directory" in capsys.readouterr().out


NO_LOOP = "node: n\nsubscribe:\n  /a: {type: std_msgs/msg/Bool}\n"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--board", "carrier-pigeon", BOOL], "'carrier-pigeon' is no board; boards are sim, udp"),
        (["--board", "udp://a:99999", BOOL], "'udp://a:99999' has no port from 1 to 65535"),
        (["--board", "sim", "--bus-bytes", "64", BOOL], "the bus of a node has 1, 2, 4, 8, 16"),
        (["--board", "sim", "no_msgs/msg/A"], "No distribution has no_msgs/msg/A"),
        (["--board", "sim", "--node", "no.yaml"], "cannot read 'no.yaml': No such file"),
        (["--board", "sim", "--node", "n.yaml"], "'n.yaml' has no subscription with a publication"),
    ],
)
def test_boards_and_nodes_that_cannot_be_used(arguments, message, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "n.yaml").write_text(NO_LOOP)
    assert main(["verify", *arguments]) == 1
    err = capsys.readouterr().err
    assert err.startswith(f"error: {message}"), err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--board", "sim"], "name types, or all of them with --all"),
        (["--board", "sim", "--all"], "a board takes named types, or those of --node"),
        (["--board", "sim", "--bag", "x"], "a board takes named types, or those of --node"),
        (["--board", "sim", "--systems", "ts3", BOOL], "--systems board needs --board, and the"),
        (["--systems", "ts3,board", BOOL], "--systems board needs --board, and the reverse"),
        (["--node", "n.yaml"], "--node needs --board"),
        (["--engine", "amaranth", BOOL], "--engine needs --board"),
        (["--silent-seconds", "1", BOOL], "--silent-seconds needs --board"),
        (["--board", "sim", "--silent-seconds", "0", BOOL], "must be above 0, not 0"),
        (["--board", "sim", "--wire", "ros1", BOOL], "a board has the wire format of its"),
        (["--board", "sim", "--bus-bytes", "1", "--bus-bytes", "2", BOOL], "a board has one"),
        (["--board", "sim", "--node", "n", "--distro", "noetic"], "are those of --node"),
        (["--board", "sim", "--node", "n", "--write-node", "m", BOOL], "--write-node: not allowed"),
        (["--board", "sim", "--node", "n", "--systems", "ts3,board"], "is for the test system"),
        (["--board", "sim", "--sut", "rosbags", BOOL], "--board does not go with --sut"),
    ],
)
def test_wrong_arguments(arguments, message, capsys):
    with pytest.raises(SystemExit) as left:
        main(["verify", *arguments])
    assert left.value.code == 2
    assert message in capsys.readouterr().err
