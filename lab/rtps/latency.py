"""``python -m lab.rtps.latency``: where a message is, cycle by cycle, on its way through a node.

A node at the pins of a GMII sends strings back, with 125 MHz. It runs in Verilator, with a peer of
`firm_hdl.rtps`; nothing else is under way when a string comes. Cycles are counted from the last
byte of its frame at the pins, to the preamble of the answer.
"""

from __future__ import annotations

import argparse
import re
import statistics
import struct
import subprocess
import sys
import tempfile
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
from lab.ethernet.frames import ADDRESS, MAC, group_mac, ipv4, on_wire, udp

HOST, BOARD, GROUP = "192.168.50.1", "192.168.50.50", "239.255.0.1"
HOST_MAC = bytes.fromhex("021100000001")
NODE = """
node: echo
distro: kilted
clock_mhz: 125
link: {kind: rtps, ethernet: gmii, mac: "02:00:00:00:00:50", address: 192.168.50.50/24}
accelerator: firm_hdl.node.loop:Loop
subscribe:
  /text_in: {type: std_msgs/msg/String, memory_bytes: 2048}
publish:
  /text_out: {type: std_msgs/msg/String, memory_bytes: 2048}
"""
STAGES = {
    "edge, of the frame": "link.network.ipv4.datagrams_bytes_valid",
    "datagram from the edge": "link.rtps.datagrams_in_valid",
    "datagram to the reader": "link.rtps.reader.packets_valid",
    "event for the engine": "link.rtps.reader.events_valid",
    "payload of the reader": "link.rtps.reader.payload_valid",
    "message from the link": "link.received_valid",
    "message from its gate": "core.gate_text_in.packets_out_valid",
    "text of the accelerator": "converters.subscribe_text_in_in.message_data_items_valid",
    "message from its converter": "converters.publish_text_out_out.packets_valid",
    "message to the link": "core.sent_valid",
    "message into the history": "link.rtps.history.writes",
    "datagram of the transmitter": "link.rtps.datagrams_out_valid",
    "frame of the sender": "link.network.sender.frames_valid",
    "frame at the pins": "link.phy.pins_tx_en",
}
"""Signals that are high while a part of the node has, or passes on, a byte of the message."""


def compile_node(folder: Path) -> Path:
    """Compile the node into a folder, and return the program."""
    (folder / "echo.yaml").write_text(NODE)
    build = ("node", "build", str(folder / "echo.yaml"), "--out", str(folder))
    subprocess.run([sys.executable, "-m", "firm_hdl", *build], check=True, capture_output=True)
    options = ("--cc", "--exe", "--build", "--trace", "-O3", "--x-assign", "fast")
    quiet = ("-Wno-fatal", "-Wno-lint", "-Wno-style", "-MAKEFLAGS", "CFG_CXXFLAGS_PCH_I=-include")
    names = ("--top-module", "echo_verilog", "--prefix", "Vnode", "--Mdir", "model", "-o", "board")
    files = (str(Path(__file__).with_suffix(".cpp")), "echo/echo_verilog.v")
    run_tool([*find_verilator("The node"), *options, *quiet, *names, *files], folder, timeout=900)
    return folder / "model" / "board"


class Node:
    """The node in Verilator, and a peer on its network."""

    def __init__(self, program: Path, trace: Path) -> None:
        self._process = subprocess.Popen(
            [program, trace], stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )
        own = ParticipantData(
            prefix=b"\x01\xff" + bytes(9) + b"\1",
            discovery=(Address(HOST, 7410),),
            user=(Address(HOST, 7411),),
            lease=100.0,
            domain=0,
        )
        self.core = Core(Settings(own=own, host=HOST, targets=(Address(GROUP, 7400),)))
        self.cycles = 0
        self.came: list[tuple[int, bytes]] = []  # Cycle and payload of messages of the node.

    def close(self) -> None:
        """End the process."""
        self._process.kill()
        self._process.communicate()

    def exchange(self, frames: list[bytes], cycles: int, traced: bool = False) -> list[int]:
        """Send frames and run; take what the node sends. Return the last cycles of frames."""
        parts = [struct.pack("<III", len(frames), cycles, traced)]
        parts += [struct.pack("<I", len(each)) + each for each in frames]
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(b"".join(parts))
        self._process.stdin.flush()
        read, ends = self._process.stdout.read, []
        while kind := read(1)[0]:
            cycle = int.from_bytes(read(8), "little")
            if kind == 2:
                ends.append(cycle)
                continue
            frame = read(int.from_bytes(read(4), "little"))[8:-4]
            self._take(cycle, frame)
        self.cycles = int.from_bytes(read(8), "little")
        return ends

    def _take(self, cycle: int, frame: bytes) -> None:
        if frame[12:14] == b"\x08\0" and frame[23] == 17:
            size = int.from_bytes(frame[38:40], "big")
            self.core.receive(frame[42 : 34 + size], self.now, BOARD)
            while (event := self.core.next_event()) is not None:
                if isinstance(event, Arrived):
                    self.came.append((cycle, event.sample.payload))

    @property
    def now(self) -> float:
        # Timers of the peer run faster than those of the node, or it would take long.
        return self.cycles / 1e6

    def outbox(self) -> list[bytes]:
        """Return the frames of what the peer sends."""
        self.core.tick(self.now)
        frames = []
        source = bytes(map(int, HOST.split(".")))
        while self.core.outbox:
            address, data = self.core.pop()
            to = bytes(map(int, address.host.split(".")))
            mac = group_mac(to) if address.host == GROUP else MAC
            packet = ipv4(17, udp(source, to, (7410, address.port), data), source, to)
            frames.append(on_wire(mac + HOST_MAC + b"\x08\0" + packet))
        return frames


def arp() -> bytes:
    """Return a question of the host for the board: so the board knows the host."""
    source = bytes(map(int, HOST.split(".")))
    head = bytes.fromhex("08060001080006040001")
    return on_wire(b"\xff" * 6 + HOST_MAC + head + HOST_MAC + source + bytes(6) + ADDRESS)


def spans(trace: Path, start: int, end: int) -> dict[str, tuple[int, int]]:
    """Return the first and the last cycle in which each stage has the message."""
    codes: dict[str, str] = {}
    found: dict[str, tuple[int, int]] = {}
    scopes: list[str] = []
    high: dict[str, bool] = {}
    cycle = 0
    with trace.open() as lines:
        for text in lines:
            line = text.strip()
            if line.startswith("$scope"):
                scopes.append(line.split()[2])
            elif line.startswith("$upscope"):
                scopes.pop()
            elif line.startswith("$var"):
                path = ".".join([*scopes, line.split()[4]])
                for stage, name in STAGES.items():
                    if path.endswith("." + name):
                        codes[line.split()[3]] = stage
                        high[stage] = False
            elif line.startswith("#"):
                now = int(line[1:])
                for stage, is_high in high.items():
                    if is_high and start <= cycle:
                        first, _ = found.get(stage, (max(cycle, start), 0))
                        found[stage] = first, min(now, end) - 1
                cycle = now
                if cycle > end:
                    break
            elif (match := re.match(r"([01])(\S+)$", line)) and match[2] in codes:
                high[codes[match[2]]] = match[1] == "1"
    return found


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m lab.rtps.latency", description=__doc__)
    parser.add_argument("--trips", type=int, default=40)
    parser.add_argument("--text", type=int, default=51, help="characters: 51 are 60 bytes of CDR")
    parser.add_argument("--program", type=Path, help="a harness that was compiled before")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="firm-hdl-latency-") as folder:
        program = args.program or compile_node(Path(folder))
        trace = Path(folder) / "trace.vcd"
        node = Node(program, trace)
        kind = names.type_name("std_msgs/msg/String")
        reader = node.core.add_reader("rt/text_out", kind, Qos(depth=0), b"", 0.0).guid
        writer = node.core.add_writer("rt/text_in", kind, Qos(depth=0), b"", 0.0)
        node.exchange([arp()], 1000)
        while not (node.core.matched(reader) and node.core.matched(writer.guid)):
            node.exchange(node.outbox(), 2000)
        for _ in range(20):
            node.exchange(node.outbox(), 5000)
        trips, ways = [], []
        for number in range(args.trips):
            text = f"{number:0{args.text}}".encode() + b"\0"
            payload = b"\0\1\0\0" + struct.pack("<I", len(text)) + text
            node.came.clear()
            node.core.write(writer, payload, node.now, None)
            (frame,) = node.outbox()[:1]
            (end,) = node.exchange([frame], 4000 + 37 * number, traced=True)
            (cycle, back) = node.came[0]
            assert back == payload + bytes(-len(payload) % 4)
            trips.append(cycle - end)
            ways.append((end, cycle))
            for _ in range(3):
                node.exchange(node.outbox(), 5000)
        node.close()
        end, cycle = ways[trips.index(min(trips))]
        print(f"{'cycles: first':>14} {'last':>6}  {len(frame) - 12} bytes of the frame")
        for stage, (first, last) in spans(trace, end - len(frame), cycle + 1).items():
            print(f"{first - end:14} {last - end:6}  {stage}")
        median = round(statistics.median(trips))
        print(f"{len(trips)} trips: {min(trips)} to {max(trips)} cycles, {median} in the median")
    return 0


if __name__ == "__main__":
    sys.exit(main())
