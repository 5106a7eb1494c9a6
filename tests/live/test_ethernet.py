"""A node behind LiteEth's core for UDP, in Verilator, as a machine on a network of Linux.

Linux judges Ethernet, ARP, IP and UDP, and the board's process the frame check sequences.
"""

from __future__ import annotations

import json
import os
import shutil
import struct
import subprocess
import sys
from pathlib import Path

import pytest

from tests.live.peer import python_of
from tests.tools import need

pytestmark = pytest.mark.live

NODES = Path(__file__).parents[2] / "examples" / "nodes"
BOARD = "192.168.50.50"
SCANS = 60


@pytest.fixture(scope="module")
def tap():
    """Make a TAP device with an address, in the network of these tests."""
    need("/dev/net/tun", "there" if os.access("/dev/net/tun", os.R_OK | os.W_OK) else None)
    for command in (
        "ip tuntap add dev tap0 mode tap",
        "ip address add 192.168.50.1/24 dev tap0",
        "ip link set tap0 up",
    ):
        subprocess.run(command.split(), check=True, timeout=20)
    yield "tap0"
    subprocess.run("ip link delete tap0".split(), check=True, timeout=20)


@pytest.fixture
def board(tap, tmp_path):
    """Start a board; its process ends with the test."""
    need("Verilator", shutil.which("verilator"))
    folders = [Path(sys.executable).parent, Path(python_of("liteeth")).parent]
    paths = os.pathsep.join([*map(str, folders), os.environ["PATH"]])
    started = []

    def start(change=("", "")):
        nodes = tmp_path / "nodes"
        shutil.copytree(NODES, nodes, ignore=shutil.ignore_patterns("work"))
        settings = nodes / "ethernet" / "liteeth.yml"
        assert change[0] in settings.read_text()
        settings.write_text(settings.read_text().replace(*change))
        made = subprocess.run(
            ["make"],
            cwd=nodes / "ethernet",
            env={**os.environ, "PATH": paths},
            capture_output=True,
            text=True,
            timeout=600,
            check=False,
        )
        assert made.returncode == 0, made.stdout + made.stderr
        process = subprocess.Popen(
            [nodes / "ethernet" / "work" / "board", tap],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        started.append(process)
        assert process.stdout.readline() == "ready\n"
        return process

    yield start
    for process in started:
        process.kill()
        process.communicate()


def scan(number, limit=None):
    """Return a LaserScan in CDR, or what the node has to make of it: far ranges are infinite."""
    ranges = [number + 0.5, 2.5, -1.0, 30.0] * (1 + number * number % 977)
    if limit is not None:
        ranges = [float("inf") if each > limit else each for each in ranges]
    packet = struct.pack("<iI", number, 7) + struct.pack("<I2s2x", 2, b"l\0")
    packet += struct.pack("<7f", -1, 1, 0.1, 0, 0.02, 0.1, 30)
    packet += struct.pack(f"<I{len(ranges)}f", len(ranges), *ranges) + struct.pack("<I", 0)
    return b"\0\1\0\0" + packet


def exchange(seconds):
    """Send scans through a bridge; return what comes back, and the bridge's account."""
    lines = [json.dumps({"topic": "/scan", "packet": scan(n).hex()}) for n in range(SCANS)]
    with subprocess.Popen(
        [
            *(sys.executable, "-c", "import sys; from firm_hdl.cli import main; sys.exit(main())"),
            *("node", "run", str(NODES / "filter" / "near.yaml"), "--board", f"udp://{BOARD}"),
            *("--graph", "none", "--seconds", str(seconds)),
        ],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        said = []
        while "joined" not in (said or [""])[-1]:
            said.append(process.stderr.readline())
            assert said[-1], said
        packets = []
        for line in lines:
            process.stdin.write(line + "\n")
            process.stdin.flush()
            if not (answer := process.stdout.readline()):
                break
            packets.append(bytes.fromhex(json.loads(answer)["packet"]))
        process.stdin.close()
        assert process.wait(60) == 0
        return packets, process.stderr.read()


def test_scans_go_through_ethernet_and_back(board):
    running = board()
    packets, account = exchange(60)
    assert packets == [scan(number, limit=2.5) for number in range(SCANS)]
    assert "dropped" not in account.replace("dropped 0", ""), account
    running.kill()
    assert running.communicate()[1] == ""


def test_a_core_without_room_loses_messages_and_changes_none(board):
    board(change=("rx_cdc_depth: 64", "rx_cdc_depth: 32"))
    packets, account = exchange(15)
    assert packets == [scan(number, limit=2.5) for number in range(len(packets))]
    assert len(packets) < SCANS
    assert "on the board, link link: cut" in account and "link link: lost" in account
