"""Formal equivalence proofs between the VHDL and the RTLIL of an Amaranth design."""

from __future__ import annotations

from firm_hdl.equivalence.circuit import ProofError
from firm_hdl.equivalence.proof import Proof, prove
from firm_hdl.equivalence.tools import Tools, find_tools

__all__ = ["Proof", "ProofError", "Tools", "find_tools", "prove"]
