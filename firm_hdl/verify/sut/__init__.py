"""Client libraries as systems under test, and as references.

A client library is a :class:`~firm_hdl.verify.sut.client.Client`: rosbags, Cyclone DDS, mcap's ROS
packages, ROS's own genpy and Fast CDR, and our converters, all behind one interface.
"""

from __future__ import annotations

from firm_hdl.verify.sut.client import Client, Codec, Refusal, UnsupportedError
from firm_hdl.verify.sut.clients import CLIENTS, REFERENCES, client, close_clients

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
