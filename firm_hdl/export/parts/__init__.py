"""Packet parts as designs of their own: gate, FIFO, width, crossing, arbiter and router."""

from firm_hdl.export.parts.build import build_part
from firm_hdl.export.parts.catalog import Part, make_part

__all__ = ["Part", "build_part", "make_part"]
