"""Graphs: the ways from a host to other nodes of ROS. Each carries serialized messages by topic.

:func:`graph_of` makes a graph of what a user names.
"""

from __future__ import annotations

import io
import sys
from typing import TextIO

from firm_hdl.errors import UserError
from firm_hdl.node.description import Description
from firm_hdl.node.graphs.graph import Graph, GraphError, OnMessage

__all__ = ["GRAPHS", "Graph", "GraphError", "OnMessage", "graph_of"]


GRAPHS = ("ros2", "ros1", "rtps", "none")
"""The names of graphs: ROS 2 through rclpy, or `rtps` without it; ROS 1 through rospy; ROS 2
through firm-hdl's own participant; lines of JSON."""


def _standard_input() -> TextIO:
    """Return standard input, whose bytes may be any: a line of rubbish is no reason to end."""
    if sys.stdin is None:
        # A process may be started without.
        return io.StringIO()
    if isinstance(sys.stdin, io.TextIOWrapper):
        sys.stdin.reconfigure(encoding="utf-8", errors="replace")
    return sys.stdin


def graph_of(
    name: str | None,
    description: Description,
    *,
    domain: int | None = None,
    interface: str | None = None,
) -> Graph:
    """Make a graph, which is not yet joined.

    * `name`: one of `GRAPHS`. `None`: that of the description's distribution.
    * `domain`: the domain of ROS 2; `None`: that of the environment.
    * `interface`: the network interface of `rtps`.

    Raises `UserError` if the messages of the description are not those of the graph, the domain is
    none, or rospy is missing.
    """
    wire = description.wire
    if name is None:
        name = "ros1" if wire == "ros1" else "ros2"
    if name != "none" and (name == "ros1") != (wire == "ros1"):
        raise UserError(
            f"messages of {description.distro} are those of {wire}, which the graph '{name}' does "
            "not carry"
        )
    if name == "none":
        from firm_hdl.node.graphs.lines import LinesGraph

        return LinesGraph(description, _standard_input(), sys.stdout)
    if name == "ros1":
        from firm_hdl.node.graphs.ros1 import RospyGraph

        return RospyGraph(description)
    if name == "ros2" and interface is None:
        from firm_hdl.node.graphs.ros2 import RclpyGraph, has_rclpy

        if has_rclpy():
            return RclpyGraph(description, domain=domain)
    from firm_hdl.node.graphs.rtps import RtpsGraph

    return RtpsGraph(description, domain=domain, interface=interface)
