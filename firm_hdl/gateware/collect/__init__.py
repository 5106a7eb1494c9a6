"""The collector: turn the leaves of a message into the words of its packet."""

from firm_hdl.gateware.collect.collector import Collector
from firm_hdl.gateware.collect.words import words_layout

__all__ = ["Collector", "words_layout"]
