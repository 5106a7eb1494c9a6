"""A node of ROS 2 at the pins of a PHY, in Verilator; Linux and rclpy are its peers."""

from __future__ import annotations

import subprocess

import pytest

from tests.live import test_participant
from tests.live.boards import build_board, make_tap, ping
from tests.live.peer import Peer

pytestmark = pytest.mark.live

BOARD = "192.168.51.50"
LINK = f"{{kind: rtps, ethernet: gmii, mac: '02:00:00:00:00:51', address: {BOARD}/24}}"
# A second of the board is minutes of the simulation. So nothing here may wait for one, as samples
# do that have to be asked for again: there are few, and small ones.
NODE = "\n".join(
    {"clock_mhz": "clock_mhz: 25", "link": f"link: {LINK}"}.get(line.partition(":")[0], line)
    for line in test_participant.NODE.splitlines()
)


@pytest.fixture(scope="module", autouse=True)
def restart(tmp_path_factory):
    """Build the node, and start it behind a TAP device; what is returned starts it again."""
    make_tap("tap1", "192.168.51.1/24")
    program = build_board(tmp_path_factory.mktemp("fpga"), "ethernet", "mirror", NODE)
    running = []

    def end():
        running[-1].kill()
        # It would tell of frames that are not valid.
        assert running.pop().communicate()[1] == ""

    def start():
        if running:
            end()
        pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
        running.append(subprocess.Popen([program, "tap1"], text=True, **pipes))
        assert running[-1].stdout.readline() == "ready\n"

    start()
    yield start
    end()


def test_it_answers_ping():
    ping(BOARD, 56, 1472)


def test_it_is_in_the_graph():
    wanted = {"node": "mirror", "namespace": "/fpga", "publishers": 4, "topics": ["/text_out"]}
    with Peer("kilted", "graph", own="watcher", patience=60, **wanted) as peer:
        result = peer.result(90)
    assert ["mirror", "/fpga"] in result["nodes"] and result["owners"] == [["mirror", "/fpga"]]
    assert ["/text_in", ["std_msgs/msg/String"]] in result["subscriptions"]
    assert [name for name, _ in result["services"]] == ["/mode"]


def test_messages_come_back_in_order():
    test_participant.check_trips("kilted", test_participant.TOPICS[:1], 100)


def test_it_answers_calls():
    with Peer("kilted", "call", name="/mode", count=10, timeout=60) as peer:
        assert peer.result(300)["answers"] == [[bool(n & 1), "ok"] for n in range(10)]


def test_it_is_found_again_after_a_restart(restart):
    options = {**test_participant.TEXT, "count": 20, "period": 0.1}
    with Peer("kilted", "echo", to="/text_back", back="/text_again"):
        # This peer has known the board before.
        test_participant.check_trips("kilted", [options], 20)
        restart()
        test_participant.check_trips("kilted", [options], 20)
