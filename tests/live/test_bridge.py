"""The bridge with real nodes of ROS 2 on one side, and gateware in simulation on the other."""

from __future__ import annotations

import signal
import time

import pytest

from firm_hdl.jobs import ProgramMissingError
from firm_hdl.jobs.programs import find_compiler
from tests.live.bridges import BridgeProcess
from tests.live.load import load
from tests.live.nodes import LARGE, LOOP, SERIAL, loop_file
from tests.live.peer import Peer, python_of
from tests.live.serial import check_serial
from tests.live.trips import CLOUD, IMU, check_killed_board, check_trips
from tests.tools import need

pytestmark = pytest.mark.live

RELEASES = pytest.mark.parametrize("release", ["jazzy", "kilted"])


def compiler():
    try:
        return find_compiler("A fast simulation", with_zig=True)[0]
    except ProgramMissingError:
        return None


@pytest.fixture
def bridge(tmp_path):
    """Start bridges of `Loop`: with our own participant, or with the rclpy of an environment."""
    need("a C++ compiler", compiler())
    started = []

    def start(release, graph, clouds=False, text=LOOP):
        # The definitions of both releases are equal, so that one program serves both.
        file = loop_file(tmp_path, text, clouds)
        options = ["--graph", graph, *(["--interface", "lo"] if graph == "rtps" else [])]
        python = {"python": python_of(release)} if graph == "ros2" else {}
        started.append(BridgeProcess(file, *options, **python))
        started[-1].wait_for("joined")
        return started[-1]

    yield start
    for each in started:
        each.__exit__()


GRAPHS = pytest.mark.parametrize("graph", ["rtps", "ros2"])


@GRAPHS
@RELEASES
def test_two_topics_at_once(release, graph, bridge):
    imu, cloud = {**IMU, "count": 3000, "period": 0.001}, {**CLOUD, "count": 300, "period": 0.02}
    check_trips(bridge(release, graph, clouds=True), release, imu, cloud)


@GRAPHS
@RELEASES
def test_imu_at_1_khz(release, graph, bridge):
    check_trips(bridge(release, graph), release, {**IMU, "count": 3000, "period": 0.001})


@GRAPHS
@RELEASES
def test_clouds_at_50_hz(release, graph, bridge):
    cloud = {**CLOUD, "count": 300, "period": 0.02}
    check_trips(bridge(release, graph, clouds=True), release, cloud)


@GRAPHS
@RELEASES
def test_a_node_of_real_size(release, graph, bridge):
    """Clouds of 300 kB at 10 Hz, which the bridge keeps until the simulation takes them."""
    running = bridge(release, graph, clouds=True, text=LARGE)
    with Peer(release, "call", name="/mode", count=20) as peer:
        assert peer.result(90)["answers"] == [[bool(n & 1), "ok"] for n in range(20)]
    cloud = {**CLOUD, "bytes": 300_000, "count": 30, "period": 0.1}
    check_trips(running, release, {**IMU, "count": 300, "period": 0.01}, cloud, linger=30)


@GRAPHS
@RELEASES
def test_the_host_is_under_load(release, graph, bridge):
    """Nothing is wrong, in disorder or twice, and all comes, if late."""
    running = bridge(release, graph)
    with load():
        check_trips(running, release, {**IMU, "count": 1000, "period": 0.005}, linger=40)


@RELEASES
def test_a_serial_line_with_flipped_bytes(release, tmp_path):
    """Of the bytes of both directions, 1 % are flipped; what is delivered is right."""
    need("a C++ compiler", compiler())
    file = tmp_path / "echo.yaml"
    file.write_text(SERIAL.format(distro="jazzy"))
    check_serial(file, release, "/heard", "/said", options=["--graph", "rtps", "--interface", "lo"])


@GRAPHS
@RELEASES
def test_200_calls(release, graph, bridge):
    running = bridge(release, graph)
    with Peer(release, "call", name="/mode", count=200) as peer:
        answers = peer.result(90)["answers"]
    assert answers == [[bool(n & 1), "ok"] for n in range(200)]
    running.stop(signal.SIGTERM)


@GRAPHS
@RELEASES
def test_the_board_is_killed_and_starts_again(release, graph, bridge):
    check_killed_board(bridge(release, graph), release)


@GRAPHS
@RELEASES
def test_the_peer_is_killed_and_starts_again(release, graph, bridge):
    running = bridge(release, graph)
    endless = [{**IMU, "count": 100_000, "period": 0.002}]
    with Peer(release, "trip", topics=endless) as peer:
        assert peer.next(90) == {"begins": True}
        time.sleep(1)
        peer.kill()
    # The dead reader takes nothing, and does not hold up others.
    topics = [{**IMU, "count": 500, "period": 0.002}]
    with Peer(release, "trip", topics=topics) as peer:
        assert peer.next(90) == {"begins": True}
        (numbers,) = peer.result(90)["numbers"]
    assert numbers == list(range(500))
    running.stop()
