# amaranth: UnusedElaboratable=no
"""The whole chain: bridge, driver, model of the DMA, and a node's gateware with its link."""

from __future__ import annotations

import os
import random
from itertools import product

import pytest

from firm_hdl.node import Node
from firm_hdl.node.boards.zynq import ZynqBoard
from firm_hdl.sim.fast import FastSimulation
from tests.node.boards.dma_model import DEC_ERR, INT_ERR, SLV_ERR, AxiDma
from tests.node.boards.test_zynq import ADDRESS, CachedBuffer, ModelRegisters
from tests.node.bridge.fakes import FakeGraph, bridge_of, run_until
from tests.node.samples import read
from tests.node.test_node import string
from tests.node.traffic import packets_of, pieces_of

_TEXT = """\
node: chip
distro: jazzy
accelerator: firm_hdl.node.loop:Loop
subscribe:
  /imu: {type: sensor_msgs/msg/Imu, memory_bytes: 2048}
  /large: {type: std_msgs/msg/String, memory_bytes: 2048}
publish:
  /imu_back: {type: sensor_msgs/msg/Imu, memory_bytes: 2048}
  /large_back: {type: std_msgs/msg/String, memory_bytes: 2048}
"""


_SMALL = """\
bus_bytes: 4
node: chip
distro: jazzy
accelerator: firm_hdl.node.loop:Loop
subscribe:
  /heard: {type: std_msgs/msg/ColorRGBA}
publish:
  /said: {type: std_msgs/msg/ColorRGBA}
"""


class Fabric(ModelRegisters):
    """The registers of a DMA in front of a node in simulation, which runs with each access."""

    def __init__(self, chip):
        super().__init__(chip.dma, 16)
        self.chip = chip
        # Time passes here only, so a bridge must never sleep.
        self.readable, self.writable = os.pipe()
        os.write(self.writable, b"x")

    def fileno(self):
        return self.readable

    def take_interrupt(self):
        super().take_interrupt()
        self.chip.run()

    def close(self):
        super().close()
        os.close(self.readable)
        os.close(self.writable)


class SimulatedChip:
    """A node with the link `axi_dma` in simulation, a DMA, and a buffer without coherent caches."""

    def __init__(self, description, cycles=150):
        self.bus, self.cycles = description.bus_bytes, cycles
        self.frame_bytes = description.link.buffer_bytes
        self.sim = FastSimulation(Node(description), engine="amaranth")
        self.rng, self.resets = random.Random(1), 0
        self.buffer = CachedBuffer(1 << 18)
        self.dma = AxiDma(self.buffer.memory, ADDRESS, self.take, length_bits=16)

    def take(self, frame):
        """Send a frame of MM2S, gathered from pieces as a driver with scatter-gather does it."""
        self.sim.send("link.pieces_in", pieces_of(frame, self.bus, self.rng))

    def run(self):
        if self.resets != self.dma.resets:
            self.resets = self.dma.resets
            for level in (0, 1):
                self.sim.set("link.mm2s_aresetn", level)
                self.sim.set("link.s2mm_aresetn", level)
                self.sim.run(16)
            # What came out before the end of the reset is lost.
            self.sim.receive_packets("link.frames_out")
        self.sim.run(self.cycles)
        self.dma.packets += self.sim.receive_packets("link.frames_out")
        self.dma.step()

    def board(self):
        return ZynqBoard(
            "zynq://uio0/udmabuf0",
            "uio0",
            "udmabuf0",
            self.frame_bytes,
            lambda *_: (Fabric(self), self.buffer),
        )


def ready(description, **options):
    """Return a chip, and a bridge to it, which is ready, and what it says."""
    chip = SimulatedChip(description, **options)
    board = chip.board()
    # Amaranth's simulator takes its time.
    board.silent_seconds = board.repeat_seconds = 60.0
    made, said = bridge_of(board, FakeGraph(), description)
    assert run_until(made, lambda: made.graph.opened, 120), said
    return chip, made, said


def fail(chip, made, said, channel, bit, topic, packet):
    """Let a transfer fail, which ends the board and starts it again; then a message passes."""
    restarts = made.side.restarts + 1
    chip.dma.fails[channel] = bit
    made.graph.say(topic, packet)
    assert run_until(made, lambda: made.side.restarts == restarts, 120), said
    assert run_until(made, lambda: made.side.is_ready, 120), said
    made.graph.got.clear()
    made.graph.say(topic, packet)
    assert run_until(made, lambda: len(made.graph.got) == 1, 120), said
    assert made.graph.got[0][1] == packet and made.counters.dropped.total() >= restarts
    assert made.side.on_the_way["DMA errors"] == restarts


def test_messages_go_through_driver_dma_and_gateware():
    """A message has 20 bytes, five beats, and leaves the node in two buffers."""
    description = read(_SMALL, link="{kind: axi_dma, buffer_bytes: 32}", clock_mhz="1")
    chip, made, said = ready(description, cycles=60)
    topic, *_ = description.topics
    sent = packets_of(topic.store("in").message, 3)
    made.graph.say(topic, *sent)
    assert run_until(made, lambda: len(made.graph.got) == 3, 120), said
    assert [packet for _, packet in made.graph.got] == sent
    assert not made.counters.dropped and not made.side.on_the_way
    made.close()
    chip.sim.close()


@pytest.mark.thorough
def test_imus_long_texts_and_each_error():
    description = read(_TEXT, link="{kind: axi_dma, buffer_bytes: 256}", clock_mhz="1")
    imu, large, *_ = description.topics
    chip, made, said = ready(description)
    imus = packets_of(imu.store("in").message, 5, most=600)
    # In one frame, and in up to five.
    texts = [string("x" * size) for size in (0, 230, 240, 1100)]
    made.graph.say(imu, *imus)
    made.graph.say(large, *texts)
    assert run_until(made, lambda: len(made.graph.got) == 9, 120), said
    assert [packet for name, packet in made.graph.got if name == "/imu_back"] == imus
    assert [packet for name, packet in made.graph.got if name == "/large_back"] == texts
    assert not made.counters.dropped and not made.side.on_the_way
    for channel, bit in [*product(("MM2S", "S2MM"), (SLV_ERR, DEC_ERR)), ("S2MM", INT_ERR)]:
        fail(chip, made, said, channel, bit, large, texts[1])
    made.close()
    chip.sim.close()
