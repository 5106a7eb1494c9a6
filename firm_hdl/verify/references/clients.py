"""All client libraries, and which of them ROS itself uses."""

from __future__ import annotations

import atexit
import os
from functools import cache

from firm_hdl.verify.references.client import Client
from firm_hdl.verify.references.fastcdr import NEWER, FastCdr
from firm_hdl.verify.references.genpy import Genpy
from firm_hdl.verify.references.libraries import CycloneDds, McapRos1, McapRos2, Rosbags
from firm_hdl.verify.references.own import FirmHdl
from firm_hdl.wire import Wire

__all__ = ["CLIENTS", "REFERENCES", "client", "close_clients"]

_ALL: tuple[type[Client], ...] = (
    FirmHdl,
    Rosbags,
    Genpy,
    FastCdr,
    *NEWER,
    CycloneDds,
    McapRos1,
    McapRos2,
)

CLIENTS: dict[str, type[Client]] = {kind.name: kind for kind in _ALL}
"""Every client library by name, in the order of reports."""

REFERENCES: dict[Wire, tuple[str, ...]] = {
    "ros1": ("genpy", "rosbags"),
    "cdr": ("fastcdr", *(kind.name for kind in reversed(NEWER)), "rosbags"),
}
"""The references of each wire, ROS's own serializer first.

The next reference is asked if one is not installed, is itself under test, or lacks the type.
"""


def client(name: str) -> Client:
    """Return a client library. There is one object of each library in a process."""
    return _client(name, os.getpid())


@cache
def _client(name: str, process: int) -> Client:
    # A forked process must not talk to processes that its parent has started.
    return CLIENTS[name]()


def close_clients() -> None:
    """End the processes that the client libraries of this process have started."""
    if _client.cache_info().currsize:
        for name in CLIENTS:
            client(name).close()
        _client.cache_clear()


# Otherwise, the processes that the libraries started would wait for more requests.
atexit.register(close_clients)
