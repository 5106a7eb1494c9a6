"""The command `firm-hdl node run`: mistakes, signals, and its account at the end."""

from __future__ import annotations

import io
import os
import shutil
import signal
import subprocess
import sys
import threading
import time

import pytest

from firm_hdl.cli import main
from firm_hdl.node.boards import Board
from firm_hdl.node.boards.simulated import SimulatedBoard
from firm_hdl.node.bridge import Bridge, bridge, command
from firm_hdl.node.bridge.command import StatusPrinter
from tests.node.accelerators import echo_text
from tests.node.boards.test_boards import UdpNode
from tests.node.bridge.fakes import ECHO, FakeBoard, FakeGraph, FakeNode
from tests.node.samples import PACKAGES, read


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "echo.yaml"
    path.write_text(echo_text(link="udp", paths=f"'{PACKAGES}'") + "\n")
    return str(path)


@pytest.fixture
def line_file(tmp_path):
    path = tmp_path / "line.yaml"
    path.write_text(echo_text(link="uart", paths=f"'{PACKAGES}'") + "\n")
    return str(path)


@pytest.fixture
def board():
    node = UdpNode()
    yield node
    node.stop()


def test_lines_go_to_a_board_and_back(file, board, capsys, monkeypatch):

    line = '{"topic": "/heard", "packet": "0102"}\n'
    monkeypatch.setattr(sys, "stdin", io.StringIO(line * 3))
    address = f"udp://127.0.0.1:{board.port}"
    assert main(["node", "run", file, "--board", address, "--graph", "none"]) == 0
    out, err = capsys.readouterr()
    assert out == '{"topic": "/said", "packet": "0102"}\n' * 3
    lines = err.splitlines()
    assert lines[:2] == [f"board {address}: ready", "graph none: joined"]
    rows = [each.split() for each in lines]
    assert ["/heard", "subscribe", "3", "0"] in rows and ["/said", "publish", "0", "3"] in rows


@pytest.mark.parametrize("stdin", [b'\xff\xfe\n{"topic": "/heard", "packet": "01"}\n', None])
def test_standard_input_may_be_anything(file, board, capsys, monkeypatch, stdin):
    """Bytes that are no text are one bad line; without standard input, there is no line."""
    # Nothing comes back that may be late.
    if stdin is None:
        monkeypatch.setattr(bridge, "_LINGER_SECONDS", 0.1)
    wrapped = None if stdin is None else io.TextIOWrapper(io.BytesIO(stdin), encoding="utf-8")
    monkeypatch.setattr(sys, "stdin", wrapped)
    address = f"udp://127.0.0.1:{board.port}"
    assert main(["node", "run", file, "--board", address, "--graph", "none"]) == 0
    out, err = capsys.readouterr()
    assert out == ("" if stdin is None else '{"topic": "/said", "packet": "01"}\n')
    lost = "dropped: 1 in the graph: a line that is no object of JSON"
    assert (lost in err) == (stdin is not None) and "Traceback" not in err


def test_a_board_that_never_answers_ends_with_an_error(line_file, capsys):
    options = ["--board", "tcp://127.0.0.1:1", "--graph", "none", "--seconds", "0.3"]
    assert main(["node", "run", line_file, *options]) == 1
    err = capsys.readouterr().err
    assert "the board has never answered" in err
    assert "error: the board tcp://127.0.0.1:1 did not answer in 0.3 s" in err


def test_a_clock_that_is_none_is_an_error(file, capsys):
    for device, error in {
        "/dev/null": "cannot read '/dev/null' as a PTP hardware clock: Invalid argument",
        "/nowhere": "cannot open the clock '/nowhere': No such file or directory",
    }.items():
        assert main(["node", "run", file, "--graph", "none", "--phc", device]) == 1
        assert f"error: {error}" in capsys.readouterr().err


# Both links, with lines and without.
@pytest.mark.parametrize(("link", "lines"), [("udp", 0), ("tcp", 3)])
def test_the_end_of_the_input_ends_it_without_a_board(
    file, line_file, capsys, monkeypatch, link, lines
):
    monkeypatch.setattr(Board, "silent_seconds", 0.5)
    monkeypatch.setattr(bridge, "_LINGER_SECONDS", 0.1)
    monkeypatch.setattr(sys, "stdin", io.StringIO('{"topic": "/heard", "packet": "01"}\n' * lines))
    address = f"{link}://127.0.0.1:1"
    options = ["--board", address, "--graph", "none"]
    assert main(["node", "run", file if link == "udp" else line_file, *options]) == 1
    err = capsys.readouterr().err
    assert (f"dropped: {lines} of /heard: no board" in err) == (lines > 0)
    assert f"error: the board {address} did not answer" in err


class SlowBoard(SimulatedBoard):
    """A simulation that takes a minute to compile; a signal comes meanwhile."""

    def __init__(self, number):
        super().__init__(ECHO)
        self.number = number

    def open(self):
        os.kill(os.getpid(), self.number)
        time.sleep(60)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_the_start_of_a_board(file, capsys, monkeypatch, number):
    monkeypatch.setattr(command, "board_of", lambda name, *_, **__: SlowBoard(number))
    before = time.monotonic()
    assert main(["node", "run", file, "--graph", "none"]) == 0
    # Nothing else would end it within a minute.
    assert time.monotonic() - before < 50
    assert "the board has never answered" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("engine", "compiler", "message"),
    [
        (
            "auto",
            "",
            "board sim: starts; to compile a new node takes a minute or more",
        ),
        ("auto", "nothing-there", "a few messages per second (CXX is 'nothing-there' in the"),
        ("auto", "'g++", "a few messages per second (CXX is no command: No closing quotation"),
        ("amaranth", "", "board sim: starts; Amaranth's simulator takes a few messages per second"),
        (
            "verilator",
            "nothing-there",
            "error: CXX is 'nothing-there' in the environment, but there",
        ),
    ],
)
def test_the_engine_is_named(file, capsys, monkeypatch, engine, compiler, message):
    if compiler:
        monkeypatch.setenv("CXX", compiler)
    elif engine == "auto" and shutil.which("g++") is None:
        pytest.skip("there is no g++")
    monkeypatch.setattr(Bridge, "run", lambda self, **_: (self.stop(), self.close()))
    main(["node", "run", file, "--graph", "none", "--engine", engine])
    assert message in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--board", "usb"], "error: 'usb' is no board; boards are sim, udp://"),
        (["--graph", "ros1"], "error: messages of jazzy are those of cdr, which the graph 'ros1'"),
    ],
)
def test_wrong_names(file, capsys, options, message):
    assert main(["node", "run", file, *options]) == 1
    assert message in capsys.readouterr().err


def test_another_board_ends_the_command(file, board, capsys):
    board.node = FakeNode(fingerprint=1)
    options = ["--board", f"udp://127.0.0.1:{board.port}", "--graph", "none"]
    assert main(["node", "run", file, *options]) == 1
    assert "error: the board's fingerprint is 0000000000000001" in capsys.readouterr().err


def test_signals_end_it(file, board, capsys, monkeypatch):
    report = StatusPrinter.report

    def said(self, line):
        report(self, line)
        if line.endswith("joined"):
            os.kill(os.getpid(), signal.SIGTERM)

    monkeypatch.setattr(StatusPrinter, "report", said)
    before = signal.getsignal(signal.SIGTERM)
    options = ["--board", f"udp://127.0.0.1:{board.port}", "--graph", "rtps", "--interface", "lo"]
    assert main(["node", "run", file, *options, "--domain", "161", "--quiet"]) == 0
    assert signal.getsignal(signal.SIGTERM) is before
    assert "ready" in capsys.readouterr().err


def test_a_second_ctrl_c_ends_the_last_questions(file, board, capsys, monkeypatch):
    """The board answers no more; without the second one, it is gone after 5 s."""
    monkeypatch.setattr(Board, "end_seconds", 60)
    report = StatusPrinter.report

    def said(self, line):
        report(self, line)
        if line.endswith("joined"):
            board.node.is_mute = True
            for seconds in (0.3, 0.6):
                threading.Timer(seconds, lambda: os.kill(os.getpid(), signal.SIGINT)).start()

    monkeypatch.setattr(StatusPrinter, "report", said)
    options = ["--board", f"udp://127.0.0.1:{board.port}", "--graph", "rtps", "--interface", "lo"]
    assert main(["node", "run", file, *options, "--domain", "162"]) == 0
    err = capsys.readouterr().err
    assert "joined" in err and "no answer" not in err and "Traceback" not in err
    assert "not all counters on the board could be read at the end" in err


def test_ctrl_c_ends_it_while_there_is_no_board(line_file):
    """As a process, as Ctrl-C is one's own in a terminal."""
    code = "import sys; from firm_hdl.cli import main; sys.exit(main())"
    options = ["--board", "tcp://127.0.0.1:1", "--graph", "none"]
    command = [sys.executable, "-c", code, "node", "run", line_file, *options]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    try:
        assert "cannot reach tcp://127.0.0.1:1: Connection refused" in process.stderr.readline()
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=60)
    finally:
        process.kill()
        process.communicate()
    assert process.returncode == 0 and "Traceback" not in said
    assert ["/heard", "subscribe", "0", "0"] in [line.split() for line in said.splitlines()]


@pytest.fixture
def started(monkeypatch):
    """Let bridges end at once; return what board and graph were made of, and how it ran."""
    found = {}

    def board_of(name, description, **options):
        found["board"] = (name, description, options)
        return FakeBoard()

    def graph_of(name, description, **options):
        found["graph"] = (name, description, options)
        return FakeGraph()

    def run(self, *, seconds, each_second):
        found["seconds"] = seconds
        self.on_message(ECHO.topics[0], b"\0", None)
        each_second()
        self.stop()
        self.close()

    monkeypatch.setattr(command, "board_of", board_of)
    monkeypatch.setattr(command, "graph_of", graph_of)
    monkeypatch.setattr(Bridge, "run", run)
    return found


def test_each_option_gets_where_it_belongs(started, tmp_path):
    file = tmp_path / "echo.yaml"
    file.write_text(echo_text(link="udp"))
    words = ["node", "run", str(file), "--path", str(PACKAGES), "--board", "udp://a:1"]
    assert main(words) == 0
    assert started["board"][::2] == ("udp://a:1", {"engine": "auto"})
    assert started["graph"][::2] == (None, {"domain": None, "interface": None})
    assert started["seconds"] is None
    words += ["--graph", "rtps", "--domain", "7", "--interface", "lo", "--seconds", "2.5"]
    assert main([*words, "--engine", "amaranth"]) == 0
    assert started["board"][::2] == ("udp://a:1", {"engine": "amaranth"})
    assert started["graph"][::2] == ("rtps", {"domain": 7, "interface": "lo"})
    assert started["seconds"] == 2.5
    assert {started[each][1].node for each in ("board", "graph")} == {ECHO.node}


def test_a_quiet_one_prints_no_figures(started, capsys, monkeypatch):
    """Neither the line of each second nor the account at the end; what happens, it says."""
    monkeypatch.setattr(command, "_LOG_SECONDS", 0.0)
    command.run_bridge(ECHO, "udp://a:1")
    lines = capsys.readouterr().err.splitlines()
    assert lines[0].startswith("echo, waits for the board, to board 0/s")
    assert "dropped: 1 of /heard: bridge ended" in lines
    command.run_bridge(ECHO, "sim", engine="amaranth", quiet=True)
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("board sim: starts; Amaranth's simulator")


def test_what_a_link_cannot_carry_is_said_at_the_start(capsys, monkeypatch):
    text = echo_text(link="{kind: uart, baud: 115200}").replace("256}", "256, rate_hz: 1000}", 1)
    board = "serial:///dev/no-such-tty?baud=9600"
    monkeypatch.setattr(Bridge, "run", lambda self, **_: (self.stop(), self.close()))
    command.run_bridge(read(text), board, graph="none", quiet=True)
    assert capsys.readouterr().err.splitlines() == [
        "warning: /heard at 1000 Hz: at least 32,000 bytes/s to the node, and the link carries "
        "11,520 (115200 baud)",
        f"warning: board {board} has 9600 baud, and the link of the description has 115200",
    ]


def test_only_a_simulation_says_what_it_starts(started, capsys):
    command.run_bridge(ECHO, "udp://a:1", quiet=True)
    assert capsys.readouterr().err == ""
