"""Accelerators in VHDL, Verilog and SystemVerilog: files of the user's with an entity.

:mod:`ports` has the ports that the entity must have, :mod:`accelerator` is the component around it,
:mod:`vhdl` and :mod:`verilog` check the files and translate them for a simulation, and
:mod:`skeleton` writes a file to begin with.
"""

from __future__ import annotations

from firm_hdl.node.hdl.accelerator import HdlAccelerator
from firm_hdl.node.hdl.ports import AcceleratorPort, accelerator_ports
from firm_hdl.node.hdl.skeleton import new_accelerator

__all__ = ["AcceleratorPort", "HdlAccelerator", "accelerator_ports", "new_accelerator"]
