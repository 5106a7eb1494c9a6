"""``python -m lab.ethernet fuzz`` and ``tap``; ``make -C lab fuzz-ethernet`` runs the first."""

from __future__ import annotations

import argparse
import os
import socket
import subprocess
import sys
import tempfile
import time
import zlib
from collections import Counter
from pathlib import Path

from firm_hdl.ethernet.drops import DROPS
from lab.ethernet.board import compile_board
from lab.ethernet.frames import Judge, traffic

_STRICT = ("damaged", "runt", "giant", "malformed")
"""Causes whose number is known. What is answered may find no room, or no address."""

_SHORT = ("checksum", "other", "port")
"""Causes of datagrams that are shorter than their header; which of them is not known."""


def fuzz(program: Path, seed: int, count: int) -> list[str]:
    """Send frames through the board; return what is wrong."""
    judge = Judge()
    with tempfile.TemporaryFile() as records:
        for sent in traffic(seed, count):
            records.write(sent.record())
            judge.judge(sent)
        records.seek(0)
        command = [str(program), "frames", str(seed)]
        done = subprocess.run(command, stdin=records, capture_output=True, text=True, check=True)
    lines = done.stdout.splitlines()
    bad = [line for line in lines if line.startswith("bad")]
    values = dict(zip(DROPS, map(int, lines[-1].split()[1:]), strict=True))
    came = [line for line in lines if line.startswith("d ")]
    whole = Counter(judge.datagrams)
    put_together = [line for line in came if line not in whole]
    problems = [f"sent: {line[:200]}" for line in bad]
    problems += [f"came: {line[:200]}" for line in put_together if line not in judge.trains]
    if [line for line in came if line in whole] != judge.datagrams:
        missing = whole - Counter(came)
        problems.append(f"{missing.total()} datagrams are missing, or the order is another one")
        problems += [f"missing: {line[:200]}" for line in list(missing)[:3]]
    for cause in _STRICT:
        if values[cause] != judge.drops[cause]:
            problems.append(f"{cause}: {values[cause]} instead of {judge.drops[cause]}")
    lost = judge.drops["short"]
    for cause in _SHORT:
        if not 0 <= values[cause] - judge.drops[cause] <= lost:
            problems.append(f"{cause}: {values[cause]} instead of {judge.drops[cause]}")
    answers = sum(line.startswith("f ") for line in lines)
    print(
        f"seed {seed}: {len(came)} datagrams came, {len(put_together)} of {len(judge.trains)} in "
        f"fragments; {answers} frames were sent; drops {values}; judged {dict(judge.drops)}"
    )
    return problems


def tap(program: Path) -> list[str]:
    """Exchange datagrams with the kernel, in a network of its own; return what is wrong."""
    for command in (
        "ip link set lo up",
        "ip tuntap add dev tap0 mode tap",
        "ip address add 192.168.50.1/24 dev tap0",
        "ip link set tap0 up",
    ):
        subprocess.run(command.split(), check=True)
    problems = []
    board = subprocess.Popen([program, "tap", "tap0"], stdout=subprocess.PIPE, text=True)
    try:
        assert board.stdout is not None
        board.stdout.readline()
        host = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        host.settimeout(10)
        for size in (1, 2, 63, 1471, 1472, 1473, 4000, 20000, 65507):
            for port, to in ((7400, "192.168.50.50"), (7411, "192.168.50.50")):
                payload = os.urandom(size)
                start = time.monotonic()
                host.sendto(payload, (to, port))
                try:
                    answer, source = host.recvfrom(2000)
                except TimeoutError:
                    problems.append(f"no answer to {size} bytes for port {port}")
                    continue
                seconds = time.monotonic() - start
                if answer != f"{zlib.crc32(payload):08x} {size}\n".encode() or source[1] != port:
                    problems.append(f"{size} bytes: {answer!r} from {source}")
                print(f"{size} bytes to port {port}: {1000 * seconds:.1f} ms")
    finally:
        board.kill()
    return problems


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m lab.ethernet", description=__doc__)
    parser.add_argument("what", choices=("fuzz", "tap"))
    parser.add_argument("--frames", type=int, default=200_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--passes", action="store_true", help="the edge has no memory")
    parser.add_argument("--program", type=Path, help="a harness that was compiled before")
    args = parser.parse_args()
    if args.what == "tap" and os.environ.get("IN_NETWORK") != "1":
        command = ["unshare", "-rn", sys.executable, "-m", "lab.ethernet", *sys.argv[1:]]
        return subprocess.run(
            command, env={**os.environ, "IN_NETWORK": "1"}, check=False
        ).returncode
    with tempfile.TemporaryDirectory(prefix="firm-hdl-ethernet-") as folder:
        program = args.program or compile_board(Path(folder), not args.passes)
        problems = tap(program) if args.what == "tap" else []
        if args.what == "fuzz":
            step = 20_000
            for number, first in enumerate(range(0, args.frames, step)):
                seed = args.seed + number
                problems += fuzz(program, seed, min(step, args.frames - first))
    for problem in problems[:40]:
        print(problem)
    print("FAIL" if problems else "PASS")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
