"""The bridge between a board and a graph of ROS."""

from __future__ import annotations

from firm_hdl.node.bridge.bridge import Bridge
from firm_hdl.node.bridge.client import Client
from firm_hdl.node.bridge.counters import BridgeCounters
from firm_hdl.node.bridge.session import WrongBoardError

__all__ = ["Bridge", "BridgeCounters", "Client", "WrongBoardError"]
