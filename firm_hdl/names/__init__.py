"""Names that are legal in VHDL, Verilog and SystemVerilog, and differ in more than case."""

__all__ = []
