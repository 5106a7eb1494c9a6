"""Export: converters as files for FPGA tools."""

__all__ = []
