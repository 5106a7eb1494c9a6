"""A node that is a participant itself, in Verilator, with real nodes of ROS 2: no host between."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.live.nodes import PACKAGES
from tests.live.peer import Peer
from tests.tools import need

pytestmark = pytest.mark.live

EXAMPLE = Path(__file__).parents[2] / "examples" / "nodes" / "rtps"
RELEASES = pytest.mark.parametrize("release", ["jazzy", "kilted"])

NODE = f"""\
node: mirror
namespace: /fpga
distro: jazzy
paths: {PACKAGES}
clock_mhz: 1
bus_bytes: 2
link: {{kind: rtps, address: 127.0.0.1, participant: 50}}
accelerator: tests.live.nodes:Loop
subscribe:
  /text_in: {{type: std_msgs/msg/String, memory_bytes: 2048}}
  /imu_in: {{type: sensor_msgs/msg/Imu, memory_bytes: 8192}}
publish:
  /text_out: {{type: std_msgs/msg/String, memory_bytes: 2048}}
  /imu_out: {{type: sensor_msgs/msg/Imu, memory_bytes: 8192}}
serve:
  /mode: {{type: std_srvs/srv/SetBool, memory_bytes: 256}}
"""


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    """Build the node as a process."""
    need("Verilator", shutil.which("verilator"))
    folder = tmp_path_factory.mktemp("participant") / "rtps"
    shutil.copytree(EXAMPLE, folder, ignore=shutil.ignore_patterns("work"))
    (folder / "mirror.yaml").write_text(NODE)
    paths = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    made = subprocess.run(
        ["make", "FILE=mirror.yaml", "NAME=mirror"],
        cwd=folder,
        env={**os.environ, "PATH": paths, "PYTHONPATH": str(Path(__file__).parents[2])},
        capture_output=True,
        text=True,
        timeout=1800,
        check=False,
    )
    assert made.returncode == 0, made.stdout + made.stderr
    return folder / "work" / "board"


@pytest.fixture
def start(program):
    """Start the board; its processes end with the test."""
    started = []

    def begin():
        # Slower than the clock says, so that a busy machine keeps up.
        arguments = ["127.0.0.1", "1000000", "7400", "7510", "7511"]
        process = subprocess.Popen([program, *arguments], stdout=subprocess.PIPE, text=True)
        started.append(process)
        assert process.stdout.readline() == "ready\n"
        return process

    yield begin
    for process in started:
        process.kill()
        process.communicate()


@RELEASES
def test_messages_come_back_in_order(release, start):
    start()
    options = {"count": 300, "period": 0.1, "depth": 100}
    topics = [
        {"type": "string", "to": "/text_in", "back": "/text_out", **options},
        {"type": "imu", "to": "/imu_in", "back": "/imu_out", **options},
    ]
    with Peer(release, "trip", topics=topics) as peer:
        assert peer.next(90) == {"begins": True}
        assert peer.result(300)["numbers"] == [list(range(300))] * 2


@RELEASES
def test_the_node_is_in_the_graph_with_its_topics_and_services(release, start):
    start()
    wanted = {"node": "mirror", "namespace": "/fpga", "publishers": 2, "topics": ["/text_out"]}
    with Peer(release, "graph", own="watcher", **wanted) as peer:
        result = peer.result()
    assert ["mirror", "/fpga"] in result["nodes"] and result["owners"] == [["mirror", "/fpga"]]
    assert [name for name, _ in result["publishers"]] == ["/imu_out", "/text_out"]
    assert [name for name, _ in result["subscriptions"]] == ["/imu_in", "/text_in"]
    assert [name for name, _ in result["services"]] == ["/mode"]


@RELEASES
def test_four_clients_of_a_service_at_once(release, start):
    start()
    clients = [Peer(release, "call", name="/mode", count=50, own=f"c{n}") for n in range(4)]
    try:
        answers = [each.result(120)["answers"] for each in clients]
    finally:
        for each in clients:
            each.kill()
    assert answers == [[[bool(n & 1), "ok"] for n in range(50)]] * 4


def test_a_board_that_starts_again_is_found_again(start):
    topic = {"type": "string", "to": "/text_in", "back": "/text_out"}
    options = {"count": 20, "period": 0.1, "depth": 100}
    for _ in range(2):
        process = start()
        with Peer("kilted", "trip", topics=[{**topic, **options}]) as peer:
            assert peer.next(90) == {"begins": True}
            assert peer.result(120)["numbers"] == [list(range(20))]
        process.kill()
        process.wait()
