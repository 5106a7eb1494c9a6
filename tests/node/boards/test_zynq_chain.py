# amaranth: UnusedElaboratable=no
"""The whole chain: bridge, driver, model of the DMA, and a node's gateware with its link."""

from __future__ import annotations

from contextlib import contextmanager
from itertools import product

import pytest

from tests.node.boards.chip import ServedChip, SimulatedStreams
from tests.node.boards.dma_model import DEC_ERR, INT_ERR, SLV_ERR
from tests.node.bridge.fakes import FakeGraph, bridge_of, run_until
from tests.node.samples import read
from tests.node.test_node import string
from tests.node.traffic import packets_of

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


@contextmanager
def ready(tmp_path, description, **options):
    """Give a chip, a bridge to it, which is ready, and what it says."""
    with ServedChip(tmp_path, SimulatedStreams(description, engine="amaranth"), **options) as chip:
        board = chip.board(description.link.buffer_bytes)
        # Amaranth's simulator takes its time.
        board.silent_seconds = board.repeat_seconds = 60.0
        made, said = bridge_of(board, FakeGraph(), description)
        assert run_until(made, lambda: made.graph.opened, 120), said
        yield chip, made, said
        made.close()


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


def test_messages_go_through_driver_dma_and_gateware(tmp_path):
    """A message has 20 bytes, five beats, and leaves the node in two buffers."""
    description = read(_SMALL, link="{kind: axi_dma, buffer_bytes: 32}", clock_mhz="1")
    topic, *_ = description.topics
    sent = packets_of(topic.store("in").message, 3)
    with ready(tmp_path, description) as (_, made, said):
        made.graph.say(topic, *sent)
        assert run_until(made, lambda: len(made.graph.got) == 3, 120), said
        assert [packet for _, packet in made.graph.got] == sent
        assert not made.counters.dropped and not made.side.on_the_way


@pytest.mark.thorough
@pytest.mark.parametrize("has_sg", [False, True])
def test_imus_long_texts_and_each_error(tmp_path, has_sg):
    description = read(_TEXT, link="{kind: axi_dma, buffer_bytes: 256}", clock_mhz="1")
    imu, large, *_ = description.topics
    imus = packets_of(imu.store("in").message, 5, most=600)
    # In one frame, and in up to five.
    texts = [string("x" * size) for size in (0, 230, 240, 1100)]
    with ready(tmp_path, description, bits=16, has_sg=has_sg) as (chip, made, said):
        made.graph.say(imu, *imus)
        made.graph.say(large, *texts)
        assert run_until(made, lambda: len(made.graph.got) == 9, 120), said
        assert [packet for name, packet in made.graph.got if name == "/imu_back"] == imus
        assert [packet for name, packet in made.graph.got if name == "/large_back"] == texts
        assert not made.counters.dropped and not made.side.on_the_way
        for channel, bit in [*product(("MM2S", "S2MM"), (SLV_ERR, DEC_ERR)), ("S2MM", INT_ERR)]:
            fail(chip, made, said, channel, bit, large, texts[1])
