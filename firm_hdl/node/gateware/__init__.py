"""The circuits of a node."""

from firm_hdl.node.gateware.core import NodeCore
from firm_hdl.node.gateware.streams import LinkSignature, link_layout, time_layout

__all__ = ["LinkSignature", "NodeCore", "link_layout", "time_layout"]
