"""The tutorial's node and a peer in rclpy, in a network of their own: a process of a short test.

Arguments are the folder of the peer's environment and the description. Output is a line of JSON:
what the peer says at its end, and the lines of ``firm-hdl node run``.
"""

from __future__ import annotations

import json
import os
import sys

from tests.live.bridges import BridgeProcess
from tests.live.network import leave_network
from tests.live.peer import Peer

__all__ = ["NUMBERS"]

NUMBERS = [*range(-10, 9), 1_000_000_000]
"""What the peer sends; the double of the last one has 32 bits."""


def main(peers: str, description: str) -> None:
    """Let them meet."""
    leave_network()
    os.environ["FIRM_HDL_LIVE_PEERS"] = peers
    options = ["--engine", "amaranth", "--graph", "rtps", "--interface", "lo"]
    with (
        BridgeProcess(description, *options) as bridge,
        Peer("kilted", "double", numbers=NUMBERS) as peer,
    ):
        found = peer.result(50)
        account = bridge.stop()
    print(json.dumps({**found, "account": account}))


if __name__ == "__main__":
    main(*sys.argv[1:])
