"""Ports as plain vectors, and their types in the languages."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

__all__ = ["PlainPort", "verilog_range", "vhdl_type"]


def vhdl_type(width: int, *, vector: bool = False) -> str:
    """Return the type of so many bits in VHDL; `vector`: also of one bit."""
    return f"std_logic_vector({width - 1} downto 0)" if vector or width > 1 else "std_logic"


def verilog_range(width: int) -> str:
    """Return the range of so many bits in Verilog, with a space behind; of one bit nothing."""
    return f"[{width - 1}:0] " if width > 1 else ""


@dataclass(frozen=True, slots=True, kw_only=True)
class PlainPort:
    """A port of a top level."""

    name: str
    direction: Literal["in", "out"]
    width: int  # Width in bits.

    @property
    def vhdl_type(self) -> str:
        """The type in VHDL."""
        return vhdl_type(self.width)

    @property
    def verilog_range(self) -> str:
        """The range in Verilog, with a space behind; of one bit nothing."""
        return verilog_range(self.width)
