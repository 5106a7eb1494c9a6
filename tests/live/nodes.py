"""Nodes for tests with real peers: what comes goes back, through real gateware in simulation."""

from __future__ import annotations

from pathlib import Path

from amaranth.hdl import Module, Signal
from amaranth.lib import wiring

from firm_hdl.node import accelerator_signature

__all__ = ["LARGE", "LOOP", "LOOP_ROS1", "PACKAGES", "SERIAL", "Echo", "Loop", "loop_file"]

PACKAGES = Path(__file__).parents[2] / "examples" / "nodes" / "packages"

LOOP = """\
node: loop
namespace: /fpga
distro: {distro}
paths: {paths}
accelerator: tests.live.nodes:Loop
subscribe:
  /imu_in: {{type: sensor_msgs/msg/Imu, history: keep_all}}
  /cloud_in: {{type: sensor_msgs/msg/PointCloud2, history: keep_all, memory_bytes: 65536}}
publish:
  /imu_out: {{type: sensor_msgs/msg/Imu, history: keep_all}}
  /cloud_out: {{type: sensor_msgs/msg/PointCloud2, history: keep_all, memory_bytes: 65536}}
serve:
  /mode: {{type: std_srvs/srv/SetBool, memory_bytes: 256}}
"""

# Of real size; the clouds and images of a robot.
LARGE = """\
node: large
namespace: /fpga
distro: {distro}
paths: {paths}
accelerator: tests.live.nodes:Loop
subscribe:
  /image_in: {{type: sensor_msgs/msg/Image, history: keep_all, memory_bytes: 1048576}}
  /cloud_in: {{type: sensor_msgs/msg/PointCloud2, history: keep_all, memory_bytes: 524288}}
  /imu_in: {{type: sensor_msgs/msg/Imu, history: keep_all}}
  /odom_in: {{type: nav_msgs/msg/Odometry, history: keep_all}}
publish:
  /image_out: {{type: sensor_msgs/msg/Image, history: keep_all, memory_bytes: 1048576}}
  /cloud_out: {{type: sensor_msgs/msg/PointCloud2, history: keep_all, memory_bytes: 524288}}
  /imu_out: {{type: sensor_msgs/msg/Imu, history: keep_all}}
  /odom_out: {{type: nav_msgs/msg/Odometry, history: keep_all}}
serve:
  /mode: {{type: std_srvs/srv/SetBool, memory_bytes: 256}}
"""

LOOP_ROS1 = """\
node: loop
namespace: /fpga
distro: noetic
paths: {paths}
accelerator: tests.live.nodes:Loop
subscribe:
  /imu_in: {{type: sensor_msgs/Imu, depth: 1000}}
  /cloud_in: {{type: sensor_msgs/PointCloud2, depth: 1000, memory_bytes: 65536}}
publish:
  /imu_out: {{type: sensor_msgs/Imu, depth: 1000}}
  /cloud_out: {{type: sensor_msgs/PointCloud2, depth: 1000, memory_bytes: 65536}}
serve:
  /mode: {{type: std_srvs/SetBool, memory_bytes: 256}}
"""


SERIAL = """\
node: echo
distro: {distro}
clock_mhz: 4
link: {{kind: uart, baud: 1000000}}
accelerator: tests.live.nodes:Echo
subscribe:
  /heard: {{type: std_msgs/msg/String, memory_bytes: 256}}
publish:
  /said: {{type: std_msgs/msg/String, memory_bytes: 256}}
"""


def loop_file(folder, text, clouds):
    """Write a description into a folder; without clouds, it is compiled in a minute."""
    lines = text.format(distro="jazzy", paths=PACKAGES).splitlines()
    file = folder / "loop.yaml"
    file.write_text("\n".join(line for line in lines if clouds or "cloud" not in line) + "\n")
    return file


class Echo(wiring.Component):
    """Publish what comes."""

    def __init__(self, description):
        super().__init__(accelerator_signature(description))

    def elaborate(self, platform):
        m = Module()
        heard, said = self.subscribe.heard, self.publish.said
        wiring.connect(m, wiring.flipped(heard), wiring.flipped(said))
        return m


class Loop(wiring.Component):
    """Publish what comes, and answer SetBool with its own value and ``ok``."""

    def __init__(self, description):
        super().__init__(accelerator_signature(description))

    def elaborate(self, platform):
        m = Module()
        for name in self.subscribe.signature.members:
            came = getattr(self.subscribe, name)
            sent = getattr(self.publish, name.replace("_in", "_out"))
            wiring.connect(m, wiring.flipped(came), wiring.flipped(sent))
        asked, answer = self.serve.mode.request.data, self.serve.mode.response
        leaves = [answer.success, answer.message.length, answer.message.items]
        left = Signal(3)
        m.d.comb += [
            asked.ready.eq(left == 0),
            answer.message.length.payload.eq(2),
            answer.message.items.payload.last.eq(1),
            *(port.valid.eq(left[number]) for number, port in enumerate(leaves)),
            *(answer.message.items.payload.data[lane].eq(byte) for lane, byte in enumerate(b"ok")),
        ]
        with m.If(asked.valid & asked.ready):
            m.d.sync += [left.eq(7), answer.success.payload.eq(asked.payload)]
        for number, port in enumerate(leaves):
            with m.If(port.valid & port.ready):
                m.d.sync += left[number].eq(0)
        return m
