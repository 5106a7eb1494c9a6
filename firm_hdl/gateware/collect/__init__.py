"""The collector: leaves of a message to the words that its packet consists of."""

from firm_hdl.gateware.collect.collector import Collector
from firm_hdl.gateware.collect.words import words_layout

__all__ = ["Collector", "words_layout"]
