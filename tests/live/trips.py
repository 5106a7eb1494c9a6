"""Checks of a bridge that are the same for all graphs: what goes to the board has to come back."""

from __future__ import annotations

import os
import re
import signal
import time

from tests.live.peer import Peer

__all__ = ["CLOUD", "IMU", "check_killed_board", "check_trips", "named"]

IMU = {"type": "imu", "to": "/imu_in", "back": "/imu_out", "depth": 0}
CLOUD = {"type": "cloud", "bytes": 20_000, "to": "/cloud_in", "back": "/cloud_out", "depth": 0}


def check_trips(running, release, *topics, timeout=300, **options):
    """Let messages go through a bridge and back; all come, and the account has no loss."""
    with Peer(release, "trip", topics=topics, **options) as peer:
        assert peer.next(90) == {"begins": True}
        # A simulation on a busy machine takes minutes for 300 clouds.
        numbers = peer.result(timeout)["numbers"]
    account = running.stop()
    for topic, came in zip(topics, numbers, strict=True):
        wanted = list(range(topic["count"]))
        lost = sorted(set(wanted) - set(came))
        assert came == wanted, (topic["to"], lost, [n for n in came if n < 0], account)
    assert not [line for line in account if "dropped" in line], account


def check_killed_board(running, release):
    """Kill the simulation while messages go through; each one that is lost is in the account."""
    count = 4000
    topics = [{**IMU, "count": count, "period": 0.002}]
    with Peer(release, "trip", topics=topics, linger=20) as peer:
        assert peer.next(90) == {"begins": True}
        time.sleep(1)
        os.kill(running.engine(), signal.SIGKILL)
        running.wait_for("killed by SIGKILL; trying again")
        running.wait_for("ready")
        (numbers,) = peer.result(90)["numbers"]
    # In order, none twice, none wrong (-1); and the last ones came.
    assert numbers == sorted(set(numbers)) and numbers[0] == 0 and numbers[-1] == count - 1
    account = running.stop()
    lost = count - len(numbers)
    # What a dead board took with it is an upper bound: messages of some tenths of a second.
    assert 0 < lost <= named(account, IMU) < lost + count // 4, (lost, account)
    assert "the board was started again or lost 1 times" in account


def named(account, topic):
    """Return how many messages of a topic an account says are lost, there or back."""
    found = re.compile(rf"dropped: (\d+) .*({topic['to']}|{topic['back']})[ :]")
    return sum(int(match[1]) for line in account if (match := found.match(line)))
