"""A node with its own Ethernet, in Verilator, as a machine on a network of Linux.

Linux judges ARP, IP, ICMP and UDP, and the board's process the frame check sequences.
"""

from __future__ import annotations

import json
import struct
import subprocess
import sys

import pytest

from tests.live.boards import build_board, make_tap, ping

pytestmark = pytest.mark.live

BOARD = "192.168.50.50"
SCANS = 60


@pytest.fixture(scope="module")
def board(tmp_path_factory):
    """Build the example, and start it behind a TAP device; its process ends with the tests."""
    make_tap("tap0", "192.168.50.1/24")
    program = build_board(tmp_path_factory.mktemp("board"), "ethernet")
    process = subprocess.Popen(
        [program, "tap0"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout.readline() == "ready\n"
    yield program.parents[1] / "near.yaml"
    process.kill()
    assert process.communicate()[1] == ""


def scan(number, limit=None):
    """Return a LaserScan in CDR, or what the node has to make of it: far ranges are infinite."""
    ranges = [number + 0.5, 2.5, -1.0, 30.0] * (1 + number * number % 977)
    if limit is not None:
        ranges = [float("inf") if each > limit else each for each in ranges]
    packet = struct.pack("<iI", number, 7) + struct.pack("<I2s2x", 2, b"l\0")
    packet += struct.pack("<7f", -1, 1, 0.1, 0, 0.02, 0.1, 30)
    packet += struct.pack(f"<I{len(ranges)}f", len(ranges), *ranges) + struct.pack("<I", 0)
    return b"\0\1\0\0" + packet


def exchange(description, seconds):
    """Send scans through a bridge; return what comes back, and the bridge's account."""
    lines = [json.dumps({"topic": "/scan", "packet": scan(n).hex()}) for n in range(SCANS)]
    with subprocess.Popen(
        [
            *(sys.executable, "-c", "import sys; from firm_hdl.cli import main; sys.exit(main())"),
            *("node", "run", str(description), "--board", f"udp://{BOARD}"),
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
    packets, account = exchange(board, 60)
    assert packets == [scan(number, limit=2.5) for number in range(SCANS)]
    assert "dropped" not in account.replace("dropped 0", ""), account


@pytest.mark.usefixtures("board")
def test_the_board_answers_ping_also_in_fragments():
    ping(BOARD, 0, 56, 1472, 1473, 4000, 20_000)
