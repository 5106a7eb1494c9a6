"""A node with its own Ethernet, in Verilator, as a machine on a network of Linux.

Linux judges ARP, IP, ICMP and UDP, and the board's process the frame check sequences.
"""

from __future__ import annotations

import json
import os
import shutil
import socket
import struct
import subprocess
import sys
from pathlib import Path

import pytest

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


@pytest.fixture(scope="module")
def board(tap, tmp_path_factory):
    """Build the example, and start it; its process ends with the tests."""
    need("Verilator", shutil.which("verilator"))
    nodes = tmp_path_factory.mktemp("board") / "nodes"
    shutil.copytree(NODES, nodes, ignore=shutil.ignore_patterns("work"))
    made = subprocess.run(
        ["make"],
        cwd=nodes / "ethernet",
        env={**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"},
        capture_output=True,
        text=True,
        timeout=900,
        check=False,
    )
    assert made.returncode == 0, made.stdout + made.stderr
    process = subprocess.Popen(
        [nodes / "ethernet" / "work" / "board", tap],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout.readline() == "ready\n"
    yield nodes / "ethernet" / "near.yaml"
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


def checksum(data):
    data += bytes(len(data) % 2)
    total = sum(struct.unpack(f">{len(data) // 2}H", data))
    while total >> 16:
        total = (total & 0xFFFF) + (total >> 16)
    return 0xFFFF ^ total


@pytest.mark.usefixtures("board")
def test_the_board_answers_ping_also_in_fragments():
    with socket.socket(socket.AF_INET, socket.SOCK_RAW, socket.IPPROTO_ICMP) as host:
        host.settimeout(20)
        for number, size in enumerate((0, 56, 1472, 1473, 4000, 20_000)):
            body = struct.pack(">HH", 77, number) + os.urandom(size)
            total = checksum(b"\x08\0\0\0" + body)
            host.sendto(struct.pack(">BBH", 8, 0, total) + body, (BOARD, 0))
            answer = host.recv(65_535)[20:]
            assert answer[:2] == b"\0\0" and answer[4:] == body and checksum(answer) == 0
