"""A node beside Linux: rclpy, the bridge, the driver, a model of the DMA, the node's Verilog."""

from __future__ import annotations

import time

import pytest

from firm_hdl.node import read_description
from tests.live.bridges import BridgeProcess
from tests.live.peer import Peer, python_of
from tests.live.trips import CLOUD, IMU, check_trips, named
from tests.node.boards.chip import ServedChip, SimulatedStreams
from tests.node.boards.dma_model import DEC_ERR, INT_ERR, SLV_ERR

pytestmark = pytest.mark.live

ERRORS = [
    ("MM2S", SLV_ERR, "DMASlvErr"),
    ("MM2S", DEC_ERR, "DMADecErr"),
    ("S2MM", SLV_ERR, "DMASlvErr"),
    ("S2MM", DEC_ERR, "DMADecErr"),
    ("S2MM", INT_ERR, "DMAIntErr"),
]

NODE = """\
node: chip
distro: jazzy
link: axi_dma
accelerator: firm_hdl.node.loop:Loop
subscribe:
  /imu_in: {type: sensor_msgs/msg/Imu, history: keep_all, when_full: wait}
  /cloud_in:
    {type: sensor_msgs/msg/PointCloud2, history: keep_all, when_full: wait, memory_bytes: 524288}
publish:
  /imu_out: {type: sensor_msgs/msg/Imu, history: keep_all}
  /cloud_out: {type: sensor_msgs/msg/PointCloud2, history: keep_all, memory_bytes: 524288}
"""
"""With `wait`, the node holds the DMA while it is behind: a simulation is slow."""


@pytest.fixture(scope="module")
def node(tmp_path_factory):
    file = tmp_path_factory.mktemp("chip") / "node.yaml"
    file.write_text(NODE)
    return file


@pytest.fixture(scope="module")
def chip(node):
    streams = SimulatedStreams(read_description(node), engine="verilator", options=["-O1"])
    with ServedChip(node.parent, streams) as made:
        yield made


@pytest.fixture
def bridge(node, chip):
    setup = f"from tests.live.zynq import use_chip; use_chip({str(chip.folder)!r}); "
    options = ["--board", "zynq://dma/udmabuf0", "--graph", "ros2"]
    with BridgeProcess(node, *options, python=python_of("kilted"), setup=setup) as running:
        running.wait_for("joined")
        yield running


def test_a_thousand_imus_and_a_hundred_clouds(bridge):
    """Clouds of 300 kB: each goes to the node in 19 frames, and comes back in as many."""
    imu = {**IMU, "count": 1000, "period": 0.06}
    cloud = {**CLOUD, "bytes": 300_000, "count": 100, "period": 0.6}
    check_trips(bridge, "kilted", imu, cloud, timeout=1500, linger=60)


def test_each_error_of_the_dma_while_messages_pass(bridge, chip):
    """It is said, what is lost is in the account, and messages go on."""
    count = 1000
    topics = [{**IMU, "count": count, "period": 0.03}]
    with Peer("kilted", "trip", topics=topics, linger=60) as peer:
        assert peer.next(90) == {"begins": True}
        for channel, bit, name in ERRORS:
            # No more is said of a board in two seconds.
            time.sleep(3)
            if bit == INT_ERR:
                chip.dma.packets.append(bytes(16_384))
            else:
                chip.dma.fails[channel] = bit
            bridge.wait_for(f"the DMA has stopped ({channel}: {name}: ")
            bridge.wait_for("ready")
        (numbers,) = peer.result(300)["numbers"]
    account = bridge.stop()
    assert numbers == sorted(set(numbers)) and numbers[0] == 0 and numbers[-1] == count - 1
    lost = count - len(numbers)
    assert lost <= named(account, IMU) < lost + count // 4, (lost, account)
    assert f"the board was started again or lost {len(ERRORS)} times" in account
    assert any("DMA errors" in line and str(len(ERRORS)) in line for line in account), account
