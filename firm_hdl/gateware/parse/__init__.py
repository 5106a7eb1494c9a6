"""The parts of the parser: packet buffer, decoded lengths, and the sequencer of the steps."""

from firm_hdl.gateware.parse.buffer import Buffer
from firm_hdl.gateware.parse.orders import OrderQueue, order_layout
from firm_hdl.gateware.parse.sequencer import Sequencer

__all__ = ["Buffer", "OrderQueue", "Sequencer", "order_layout"]
