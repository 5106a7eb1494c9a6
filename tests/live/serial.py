"""A board behind a serial line that flips bytes, as a process, and what has to come through it.

The process simulates the node with its UART; a pty is the line.
"""

from __future__ import annotations

import os
import random
import select
import subprocess
import sys
import tty
from pathlib import Path

from amaranth.hdl import Module
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.node import Node, read_description
from firm_hdl.node.gateware.uart import UartReceiver, UartTransmitter
from firm_hdl.sim.fast import FastSimulation
from tests.live.bridges import BridgeProcess
from tests.live.peer import Peer

__all__ = ["check_serial"]

ROOT = Path(__file__).parents[2]
COUNT = 500


class Line(wiring.Component):
    """A node with the other end of its line: bytes in place of bits."""

    def __init__(self, description):
        self.description = description
        eight = stream.Signature(8)
        super().__init__({"bytes_in": In(eight), "bytes_out": Out(eight)})

    def elaborate(self, platform):
        m = Module()
        cycles = round(self.description.clock_hz / self.description.link.baud)
        m.submodules.node = node = Node(self.description)
        m.submodules.transmitter = transmitter = UartTransmitter(cycles)
        m.submodules.receiver = receiver = UartReceiver(cycles)
        wiring.connect(m, wiring.flipped(self.bytes_in), transmitter.i)
        wiring.connect(m, receiver.o, wiring.flipped(self.bytes_out))
        m.d.comb += [node.link.rx.eq(transmitter.tx), receiver.rx.eq(node.link.tx)]
        return m


def flipped(data, chance, rng):
    """Return bytes of which some have another bit."""
    return bytes(b ^ 1 << rng.randrange(8) if rng.random() < chance else b for b in data)


def board(description, chance):
    """Run the board until its input ends; its line is the first line of output."""
    rng = random.Random(1)
    with FastSimulation(Line(read_description(description)), options=["-O1"]) as simulation:
        own, other = os.openpty()
        tty.setraw(own)
        tty.setraw(other)
        os.set_blocking(own, False)
        print(os.ttyname(other), flush=True)
        simulation.go_live()
        waiting = b""
        while True:
            readable, _, _ = select.select([simulation, own, sys.stdin], [], [], 1)
            if sys.stdin in readable:
                return
            if own in readable:
                simulation.send("bytes_in", list(flipped(os.read(own, 4096), chance, rng)))
            waiting += flipped(simulation.receive("bytes_out"), chance, rng)
            try:
                waiting = waiting[os.write(own, waiting) :] if waiting else b""
            except BlockingIOError:
                continue


def check_serial(file, peer, to, back, *, chance=0.01, options=(), **process):
    """Let strings go over a bad line and back; check that those that come are right."""
    command = [sys.executable, "-m", "tests.live.serial", str(file), str(chance)]
    with subprocess.Popen(
        command, cwd=ROOT, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as running:
        try:
            line = running.stdout.readline().strip()
            assert line
            address = f"serial://{line}?baud=1000000"
            with BridgeProcess(file, "--board", address, *options, **process) as bridge:
                bridge.wait_for("joined", 60)
                topics = [
                    {"type": "string", "to": to, "back": back, "count": COUNT, "period": 0.01}
                ]
                with Peer(peer, "trip", topics=topics, linger=3) as found:
                    assert found.next(90) == {"begins": True}
                    (numbers,) = found.result(90)["numbers"]
                account = "\n".join(bridge.stop())
        finally:
            running.kill()
    # About half of them; in order, none twice, none wrong (-1).
    assert numbers == sorted(set(numbers)) and numbers[0] >= 0, numbers
    assert COUNT // 5 < len(numbers) < COUNT, (len(numbers), account)
    assert "damaged" in account and "on the board, link" in account, account


if __name__ == "__main__":
    board(sys.argv[1], float(sys.argv[2]))
