"""Registers on AXI4-Lite or a CSR bus: blocks for any table of registers, messages as registers.

A :class:`RegisterMap` is the only home of names, addresses and meanings. From it come the circuit,
the SystemRDL, the header for C and the manifest.
"""

from firm_hdl.registers.axi_lite import AxiLiteSignature, AxiLiteSlave
from firm_hdl.registers.block import RegisterBlock
from firm_hdl.registers.buses import CsrSignature, CsrSlave
from firm_hdl.registers.c_header import c_header, c_values, table_c_header
from firm_hdl.registers.converters import RegisterReceiver, RegisterSender
from firm_hdl.registers.message import Item, MessageMap, message_map
from firm_hdl.registers.system_rdl import system_rdl
from firm_hdl.registers.table import Field, Register, RegisterMap

__all__ = [
    "AxiLiteSignature",
    "AxiLiteSlave",
    "CsrSignature",
    "CsrSlave",
    "Field",
    "Item",
    "MessageMap",
    "Register",
    "RegisterBlock",
    "RegisterMap",
    "RegisterReceiver",
    "RegisterSender",
    "c_header",
    "c_values",
    "message_map",
    "system_rdl",
    "table_c_header",
]
