"""ROS 2 on top of RTPS: names, the graph of nodes, services. Messages are bytes."""

from firm_hdl.rtps.ros.context import Context
from firm_hdl.rtps.ros.node import Node
from firm_hdl.rtps.ros.services import Client, Service

__all__ = ["Client", "Context", "Node", "Service"]
