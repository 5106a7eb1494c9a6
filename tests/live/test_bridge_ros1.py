"""The bridge with real nodes of ROS 1 on one side, and gateware in simulation on the other."""

from __future__ import annotations

import subprocess
import time

import pytest

from tests.live.bridges import BridgeProcess
from tests.live.load import load
from tests.live.nodes import LOOP_ROS1, SERIAL, loop_file
from tests.live.peer import Peer, python_of, ros1_variables
from tests.live.serial import check_serial
from tests.live.test_bridge import compiler
from tests.live.trips import CLOUD, IMU, check_killed_board, check_trips
from tests.tools import need

pytestmark = pytest.mark.live


class Master:
    """A master of ROS 1; a context manager."""

    def __init__(self):
        code = "import rosmaster; rosmaster.rosmaster_main(['rosmaster', '--core', '-p', '11311'])"
        self._process = subprocess.Popen(
            [python_of("ros1"), "-c", code],
            env=ros1_variables(),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.kill()
        self._process.wait()


@pytest.fixture
def bridge(tmp_path, request):
    """A bridge of `Loop` with a graph of ROS 1, and its master."""
    need("a C++ compiler", compiler())
    python = python_of("ros1")
    file = loop_file(
        tmp_path, LOOP_ROS1, clouds="cloud" in request.node.name or "two" in request.node.name
    )
    with Master(), BridgeProcess(file, python=python, variables=ros1_variables()) as running:
        running.wait_for("joined")
        yield running


def test_two_topics_at_once(bridge):
    imu, cloud = {**IMU, "count": 3000, "period": 0.001}, {**CLOUD, "count": 300, "period": 0.02}
    check_trips(bridge, "ros1", imu, cloud)


def test_imu_at_1_khz(bridge):
    check_trips(bridge, "ros1", {**IMU, "count": 3000, "period": 0.001})


def test_clouds_at_50_hz(bridge):
    check_trips(bridge, "ros1", {**CLOUD, "count": 300, "period": 0.02})


def test_the_host_is_under_load(bridge):
    with load():
        check_trips(bridge, "ros1", {**IMU, "count": 1000, "period": 0.005}, linger=40)


def test_a_serial_line_with_flipped_bytes(tmp_path):
    need("a C++ compiler", compiler())
    file = tmp_path / "echo.yaml"
    file.write_text(SERIAL.format(distro="noetic").replace("/msg/", "/"))
    with Master():
        check_serial(
            file, "ros1", "/heard", "/said", python=python_of("ros1"), variables=ros1_variables()
        )


def test_the_peer_is_killed_and_starts_again(bridge):
    endless = [{**IMU, "count": 100_000, "period": 0.002}]
    with Peer("ros1", "trip", topics=endless) as peer:
        assert peer.next(90) == {"begins": True}
        time.sleep(1)
        peer.kill()
    topics = [{**IMU, "count": 500, "period": 0.002}]
    with Peer("ros1", "trip", topics=topics, own="second", settle=1) as peer:
        assert peer.next(90) == {"begins": True}
        (numbers,) = peer.result(90)["numbers"]
    # The first messages on the way back may be those of the dead peer.
    assert -1 not in numbers and numbers[-500:] == list(range(500))


@pytest.mark.parametrize("persistent", [False, True])
def test_200_calls(bridge, persistent):
    with Peer("ros1", "call", name="/mode", count=200, persistent=persistent) as peer:
        answers = peer.result(90)["answers"]
    assert answers == [[bool(n & 1), "ok"] for n in range(200)]


def test_the_board_is_killed_and_starts_again(bridge):
    check_killed_board(bridge, "ros1")


def test_the_master_starts_again(tmp_path):
    file = loop_file(tmp_path, LOOP_ROS1, clouds=False)
    topics = [{**IMU, "count": 100, "period": 0.002}]
    python = python_of("ros1")
    with BridgeProcess(file, python=python, variables=ros1_variables()) as running:
        running.wait_for("no master at http://127.0.0.1:11311; trying again")
        for _ in range(2):
            with Master():
                running.wait_for("joined")
                with Peer("ros1", "trip", topics=topics) as peer:
                    assert peer.next(90) == {"begins": True}
                    assert peer.result(90)["numbers"] == [list(range(100))]
            running.wait_for("the master does not answer")
