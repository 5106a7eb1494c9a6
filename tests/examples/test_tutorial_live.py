"""A short run with real ROS 2: the tutorial's node in simulation, and rclpy of Kilted."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.examples.meeting import NUMBERS
from tests.live.network import why_not

ROOT = Path(__file__).parents[2]


def peers():
    """Return the folder with the peers; without them or a network of its own, skip the test."""
    found = Path(os.environ.get("FIRM_HDL_LIVE_PEERS") or Path(sys.prefix) / "live")
    if not (found / "kilted" / "bin" / "python").is_file():
        pytest.skip("rclpy of Kilted is not installed (make live, or FIRM_HDL_LIVE_PEERS=DIR)")
    if lacking := why_not():
        pytest.skip(f"this system has no {lacking}")
    return found


def judge(found):
    """Check what the peer has seen."""
    assert "failed" not in found, found
    assert found["doubles"] == [2 * number for number in NUMBERS]
    assert ["double", "/"] in found["nodes"]
    assert ["/double", ["std_msgs/msg/Int32"]] in found["topics"]
    rows = [line.split() for line in found["account"]]
    assert ["/number", "subscribe", str(len(NUMBERS)), "0"] in rows
    assert not [line for line in found["account"] if "dropped" in line]


def test_a_node_of_rclpy_meets_the_node_of_the_tutorial(tmp_path):
    folder = peers()
    page = (ROOT / "docs" / "tutorial" / "first-node.md").read_text(encoding="utf-8")
    for name, language in (("double.yaml", "yaml"), ("double.py", "py")):
        (text,) = re.findall(rf"^```{language}\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
        (tmp_path / name).write_text(text)
    # A process of its own: this one keeps its network.
    command = [sys.executable, "-m", "tests.examples.meeting", str(folder), "double.yaml"]
    command[-1] = str(tmp_path / "double.yaml")
    ended = subprocess.run(
        command,
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=100,
        check=False,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )
    assert ended.returncode == 0, ended.stderr
    judge(json.loads(ended.stdout))


GOOD = {
    "doubles": [2 * number for number in NUMBERS],
    "nodes": [["peer", "/"], ["double", "/"]],
    "topics": [["/double", ["std_msgs/msg/Int32"]]],
    "account": [f"/number  subscribe  {len(NUMBERS)}  0"],
}


@pytest.mark.parametrize(
    "change",
    [
        {"doubles": GOOD["doubles"][1:]},
        {"doubles": [*GOOD["doubles"][:-1], 0]},
        {"nodes": [["peer", "/"]]},
        {"topics": [["/double", ["std_msgs/msg/Int64"]]]},
        {"account": [*GOOD["account"], "dropped: 1 of /number: no board"]},
        {"failed": "no bridge"},
    ],
)
def test_the_judge_finds_faults(change):
    judge(GOOD)
    with pytest.raises(AssertionError):
        judge(GOOD | change)
