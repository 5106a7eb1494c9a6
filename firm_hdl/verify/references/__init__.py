"""Libraries that read and write packets of ROS messages, behind one interface.

A library is a :class:`~firm_hdl.verify.references.client.Client`: rosbags, Cyclone DDS, mcap's ROS
packages, ROS's own genpy and Fast CDR, and our converters. They are references of TS3 and of each
other; `firm_hdl.verify.clients` has them under test. rosbags is also the oracle, see `oracle`.
"""

from __future__ import annotations

from firm_hdl.verify.references.client import Client, Codec, Refusal, UnsupportedError
from firm_hdl.verify.references.clients import CLIENTS, REFERENCES, client, close_clients

__all__ = [
    "CLIENTS",
    "REFERENCES",
    "Client",
    "Codec",
    "Refusal",
    "UnsupportedError",
    "client",
    "close_clients",
]
