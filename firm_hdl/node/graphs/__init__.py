"""Graphs: the ways from a host to other nodes of ROS. Each carries serialized messages by topic.

:func:`graph_of` makes a graph of what a user names.
"""

from __future__ import annotations

from firm_hdl.node.graphs.choose import GRAPHS, graph_of
from firm_hdl.node.graphs.graph import Graph, GraphError, OnMessage

__all__ = ["GRAPHS", "Graph", "GraphError", "OnMessage", "graph_of"]
