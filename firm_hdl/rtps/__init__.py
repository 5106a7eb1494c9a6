"""A participant of DDS on the network, in plain Python: RTPS over UDP (DDSI-RTPS 2.5).

It exchanges samples as bytes, and knows nothing of message types. :mod:`firm_hdl.rtps.ros` has the
names and conventions of ROS 2 on top. ``docs/explanation/rtps.md`` describes what is implemented.
"""

from firm_hdl.rtps.endpoints import ClosedError, DataReader, DataWriter
from firm_hdl.rtps.events import Sample
from firm_hdl.rtps.participant import Participant
from firm_hdl.rtps.qos import Durability, Qos, Reliability
from firm_hdl.rtps.transport import TransportError
from firm_hdl.rtps.wire.guid import Guid, SampleIdentity
from firm_hdl.rtps.writer import HistoryFullError

__all__ = [
    "ClosedError",
    "DataReader",
    "DataWriter",
    "Durability",
    "Guid",
    "HistoryFullError",
    "Participant",
    "Qos",
    "Reliability",
    "Sample",
    "SampleIdentity",
    "TransportError",
]
