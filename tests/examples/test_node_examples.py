# amaranth: UnusedElaboratable=no
"""The nodes of `examples/nodes`, each in simulation behind a bridge."""

from __future__ import annotations

import io
import json
import math
import re
import struct
import sys
from pathlib import Path

import numpy as np
import pytest
from amaranth.sim import Simulator
from rosbags.typesys import Stores, get_typestore

import firm_hdl
from firm_hdl.cli import main
from firm_hdl.node import read_description
from firm_hdl.node.accelerator import load_accelerator
from firm_hdl.node.boards.simulated import SimulatedBoard
from firm_hdl.sim import MessagePort
from tests.node.bridge.fakes import FakeGraph, bridge_of, run_until

EXAMPLES = Path(firm_hdl.__file__).parents[1] / "examples" / "nodes"
STORE = get_typestore(Stores.ROS2_JAZZY)


@pytest.fixture
def modules(tmp_path):
    """Forget the modules of accelerators, which have no package. Others may be patched later."""
    before = set(sys.modules)
    yield
    for name in set(sys.modules) - before:
        file = Path(getattr(sys.modules[name], "__file__", None) or "/")
        if file.is_relative_to(EXAMPLES) or file.is_relative_to(tmp_path):
            del sys.modules[name]


@pytest.fixture
def start(modules):
    """Start a node in Amaranth's simulator, behind a bridge with a fake graph."""
    started = []

    def start(name):
        description = read_description(EXAMPLES / name)
        board = SimulatedBoard(description, engine="amaranth")
        made, said = bridge_of(board, FakeGraph(), description)
        started.append(made)
        assert run_until(made, lambda: made.graph.opened, 60), said
        topics = {topic.name: topic for topic in description.topics}
        return made, topics

    yield start
    for each in started:
        each.close()


def twist(forward, turn):
    new = STORE.types
    vector = new["geometry_msgs/msg/Vector3"]
    message = new["geometry_msgs/msg/Twist"](
        linear=vector(x=forward, y=9.0, z=9.0), angular=vector(x=9.0, y=9.0, z=turn)
    )
    return bytes(STORE.serialize_cdr(message, "geometry_msgs/msg/Twist"))


def read(packets, name, kind):
    return [STORE.deserialize_cdr(p, kind) for topic, p in packets if topic == name]


def test_wheels(start):
    made, topics = start("wheels/wheels.yaml")
    graph = made.graph
    graph.say(topics["/cmd_vel"], twist(1.0, 0.0), twist(0.5, -1.0), twist(-1e9, math.nan))
    names = ("/wheel/left", "/wheel/right")
    assert run_until(made, lambda: len(graph.got) == 6, 60)
    speeds = [[e.data for e in read(graph.got, n, "std_msgs/msg/Float64")] for n in names]
    assert speeds == [[1.0, 0.75, -32768.0], [1.0, 0.25, -32768.0]]
    assert not made.counters.dropped


@pytest.mark.thorough
def test_odometry(modules):
    """The accelerator alone, with a clock that ticks for it."""
    description = read_description(EXAMPLES / "odometry" / "odometry.yaml")
    dut = load_accelerator(description)
    stores = {topic.port: dict(topic.stores) for topic in description.topics}
    tick, ticks = 1 << 24, 12
    seen, others = [], []

    def port(interface, name, way):
        return MessagePort(interface, stores[name][way].message)

    async def clock(ctx):
        for n in range(ticks):
            ctx.set(dut.time.sec, 100)
            ctx.set(dut.time.nanosec, n * tick + 5)
            await ctx.tick().repeat(250)

    async def commands(ctx):
        speeds = {
            "linear": {"x": 1.0, "y": 9.0, "z": 9.0},
            "angular": {"x": 9.0, "y": 9.0, "z": 2.0},
        }
        await port(dut.subscribe.cmd_vel, "cmd_vel", "in").send(ctx, speeds)
        await ctx.tick().repeat(1500)
        await port(dut.serve.wheels_reset.request, "wheels_reset", "in").send(ctx, {})

    def sink(interface, name, count, found):
        async def bench(ctx):
            sent = port(interface, name, "out")
            for _ in range(count):
                found.append(await sent.receive(ctx, deadline=5000))

        return bench

    simulator = Simulator(dut)
    simulator.add_clock(1e-8)
    simulator.add_testbench(clock)
    simulator.add_testbench(commands)
    simulator.add_testbench(sink(dut.publish.odom, "odom", ticks - 1, seen))
    simulator.add_testbench(sink(dut.publish.wheel_left, "wheel_left", 1, others))
    simulator.add_testbench(sink(dut.publish.wheel_right, "wheel_right", 1, others))
    simulator.add_testbench(sink(dut.serve.wheels_reset.response, "wheels_reset", 1, others))
    simulator.run()
    assert {"data": 0.5} in others and {"data": 1.5} in others
    assert {"success": True, "message": "at zero"} in others
    bend = 2.0 * tick / 1e9
    x = y = yaw = 0.0
    resets = 0
    for n, each in enumerate(seen):
        assert each["header"] == {
            "stamp": {"sec": 100, "nanosec": n * tick + 5},
            "frame_id": "odom",
        }
        assert each["child_frame_id"] == "base" and not any(each["pose"]["covariance"])
        pose, speed = each["pose"]["pose"], each["twist"]["twist"]
        turn = pose["orientation"]
        assert abs(turn["z"] ** 2 + turn["w"] ** 2 - 1) < 1e-3 and turn["x"] == turn["y"] == 0
        if n == 0:
            continue
        assert (speed["linear"]["x"], speed["angular"]["z"]) == (1.0, 2.0)
        if pose["position"]["x"] < x:
            x = y = yaw = 0.0
            resets += 1
        yaw += bend
        x, y = x + math.cos(yaw) * tick / 1e9, y + math.sin(yaw) * tick / 1e9
        # The table has 1,024 angles.
        assert abs(2 * math.atan2(turn["z"], turn["w"]) - yaw) < 0.02, n
        assert abs(pose["position"]["x"] - x) < 1e-3 and abs(pose["position"]["y"] - y) < 1e-3, n
    assert resets == 1


@pytest.mark.thorough
def test_filter(start):
    made, topics = start("filter/near.yaml")
    graph, new = made.graph, STORE.types
    stamp = new["builtin_interfaces/msg/Time"](sec=1, nanosec=2)
    header = new["std_msgs/msg/Header"](stamp=stamp, frame_id="laser")
    ranges = [0.5, 2.5, 2.6, 1e9, -3.0, math.inf, 0.0, math.nan, 1.0]
    for count in (9, 0, 1, 8):
        scan = new["sensor_msgs/msg/LaserScan"](
            header=header,
            **dict.fromkeys(("angle_min", "angle_max", "angle_increment", "time_increment"), 0.25),
            **dict.fromkeys(("scan_time", "range_min", "range_max"), 9.0),
            ranges=np.array(ranges[:count], np.float32),
            intensities=np.arange(count, dtype=np.float32),
        )
        graph.say(topics["/scan"], bytes(STORE.serialize_cdr(scan, "sensor_msgs/msg/LaserScan")))
    assert run_until(made, lambda: len(graph.got) == 4, 60)
    scans = read(graph.got, "/near", "sensor_msgs/msg/LaserScan")
    for count, scan in zip((9, 0, 1, 8), scans, strict=True):
        assert scan.header == header and scan.range_max == 9.0 and scan.angle_min == 0.25
        assert list(scan.intensities) == list(range(count))
        want = [0.5, 2.5, math.inf, math.inf, -3.0, math.inf, 0.0, math.inf, 1.0][:count]
        assert list(scan.ranges) == want


@pytest.mark.thorough
def test_echo_of_ros_1(start):
    made, topics = start("echo_ros1/echo.yaml")
    texts = [struct.pack("<I", size) + b"x" * size for size in (0, 1, 7, 8, 9, 40)]
    made.graph.say(topics["/heard"], *texts)
    assert run_until(made, lambda: len(made.graph.got) == len(texts), 60)
    assert made.graph.got == [("/said", text) for text in texts]


def test_the_tutorial(tmp_path, monkeypatch, capsys, modules):
    """The files of the tutorial, written and run as it says."""
    page = (EXAMPLES.parents[1] / "docs" / "tutorial" / "first-node.md").read_text(encoding="utf-8")
    for name, language in (("double.yaml", "yaml"), ("double.py", "py")):
        (text,) = re.findall(rf"^```{language}\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
        (tmp_path / name).write_text(text)
    ((line, answer),) = re.findall(r"^(\{.*\})\n(\{.*\})$", page, re.MULTILINE)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "stdin", io.StringIO(f"{line}\n"))
    options = ["--graph", "none", "--engine", "amaranth"]
    assert main(["node", "run", "double.yaml", *options]) == 0
    out, err = capsys.readouterr()
    assert out == f"{answer}\n"
    rows = [line.split() for line in err.splitlines()]
    assert ["/number", "subscribe", "1", "0"] in rows and ["/double", "publish", "0", "1"] in rows


def test_the_line_of_the_robot_is_a_twist():
    page = (EXAMPLES.parents[1] / "docs" / "tutorial" / "robot.md").read_text(encoding="utf-8")
    (line,) = re.findall(r"^(\{.*\})$", page, re.MULTILINE)
    packet = bytes.fromhex(json.loads(line)["packet"])
    twist = STORE.deserialize_cdr(packet, "geometry_msgs/msg/Twist")
    assert (twist.linear.x, twist.angular.z) == (0.5, 0.2)
    assert bytes(STORE.serialize_cdr(twist, "geometry_msgs/msg/Twist")) == packet


def test_led_shows_numbers_and_says_where_buttons_change(modules):
    led = load_accelerator(read_description(EXAMPLES / "led" / "led.yaml"))
    came, sent = led.subscribe.lights.data, led.publish.buttons.data
    found = []

    async def check(ctx):
        ctx.set(came.payload, 0x5A)
        ctx.set(came.valid, 1)
        await ctx.tick()
        ctx.set(came.valid, 0)
        for pressed in (2, 3):
            ctx.set(led.buttons, pressed)
            await ctx.tick().repeat(5)
        ctx.set(sent.ready, 1)
        for _ in range(5):
            found.append((ctx.get(sent.valid), ctx.get(sent.payload)))
            await ctx.tick()
        assert ctx.get(led.lights) == 0x5A

    simulator = Simulator(led)
    simulator.add_clock(1e-6)
    simulator.add_testbench(check)
    simulator.run()
    # The first number waits until it is taken; then comes the newest.
    assert [number for valid, number in found if valid] == [2, 3]
