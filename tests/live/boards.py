"""Boards as processes: examples of nodes, compiled by Verilator."""

from __future__ import annotations

import os
import shutil
import socket
import struct
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

from tests.tools import need

__all__ = ["NODES", "build_board", "make_tap", "ping"]

NODES = Path(__file__).parents[2] / "examples" / "nodes"


def build_board(
    folder: Path, example: str, name: str = "", text: str = "", more: Mapping[str, str] = {}
) -> Path:
    """Build an example in a copy of its folder, or a node of the test; return its program."""
    need("Verilator", shutil.which("verilator"))
    shutil.copytree(NODES, folder / "nodes", ignore=shutil.ignore_patterns("work"))
    place = folder / "nodes" / example
    options = []
    if name:
        for file, content in {f"{name}.yaml": text, **more}.items():
            (place / file).parent.mkdir(parents=True, exist_ok=True)
            (place / file).write_text(content)
        options = [f"FILE={name}.yaml", f"NAME={name}"]
    paths = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    made = subprocess.run(
        ["make", *options],
        cwd=place,
        env={**os.environ, "PATH": paths, "PYTHONPATH": str(Path(__file__).parents[2])},
        capture_output=True,
        text=True,
        timeout=1800,
        check=False,
    )
    assert made.returncode == 0, made.stdout + made.stderr
    return place / "work" / "board"


def make_tap(name: str, address: str) -> None:
    """Make a TAP device with an address, in the network of the tests, which ends with them."""
    need("/dev/net/tun", "there" if os.access("/dev/net/tun", os.R_OK | os.W_OK) else None)
    for command in (
        f"ip tuntap add dev {name} mode tap",
        f"ip address add {address} dev {name}",
        f"ip link set {name} up",
    ):
        subprocess.run(command.split(), check=True, timeout=20)


def ping(address: str, *sizes: int) -> None:
    """Send echo requests with so many bytes, and judge the answers."""
    with socket.socket(socket.AF_INET, socket.SOCK_RAW, socket.IPPROTO_ICMP) as host:
        host.settimeout(20)
        for number, size in enumerate(sizes):
            body = struct.pack(">HH", 77, number) + os.urandom(size)
            total = _checksum(b"\x08\0\0\0" + body)
            host.sendto(struct.pack(">BBH", 8, 0, total) + body, (address, 0))
            answer = host.recv(65_535)[20:]
            assert answer[:2] == b"\0\0" and answer[4:] == body and _checksum(answer) == 0


def _checksum(data: bytes) -> int:
    data += bytes(len(data) % 2)
    total = sum(struct.unpack(f">{len(data) // 2}H", data))
    while total >> 16:
        total = (total & 0xFFFF) + (total >> 16)
    return 0xFFFF ^ total
