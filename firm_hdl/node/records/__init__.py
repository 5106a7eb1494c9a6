"""The message ports of a node as records of VHDL and as structs of SystemVerilog.

A node without accelerator has its message ports outside. :mod:`messages` finds the ports of each
message, :mod:`vhdl` and :mod:`systemverilog` write a layer around the node, with the same types as
those of single converters.
"""

from __future__ import annotations

from firm_hdl.node.records.messages import MessagePort, message_ports
from firm_hdl.node.records.systemverilog import struct_files
from firm_hdl.node.records.vhdl import record_files

__all__ = ["MessagePort", "message_ports", "record_files", "struct_files"]
