"""What a deserializer and a parser are made of: packet buffer, sequencers, queue of orders."""

from firm_hdl.gateware.parse.buffer import Buffer
from firm_hdl.gateware.parse.checker import Checker, verdict_layout
from firm_hdl.gateware.parse.orders import OrderQueue, order_layout
from firm_hdl.gateware.parse.sequencer import Sequencer

__all__ = ["Buffer", "Checker", "OrderQueue", "Sequencer", "order_layout", "verdict_layout"]
