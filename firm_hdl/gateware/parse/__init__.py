"""What a deserializer and a parser share: packet buffer, sequencer, and the queue of orders."""

from firm_hdl.gateware.parse.buffer import Buffer
from firm_hdl.gateware.parse.orders import OrderQueue, order_layout
from firm_hdl.gateware.parse.packet_judge import verdict_layout
from firm_hdl.gateware.parse.sequencer import Sequencer

__all__ = ["Buffer", "OrderQueue", "Sequencer", "order_layout", "verdict_layout"]
