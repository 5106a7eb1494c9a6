"""Converters as Amaranth components."""

from firm_hdl.gateware.deserializer import Deserializer

__all__ = ["Deserializer"]
