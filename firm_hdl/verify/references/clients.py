"""All client libraries, which of them ROS itself uses, and which confirm the bytes of rosbags."""

from __future__ import annotations

import atexit
import os
from collections.abc import Sequence
from functools import cache

from firm_hdl.cases.wide_oracle import stand_ins
from firm_hdl.model import Message, closure
from firm_hdl.verify.references.client import Client, ClientMissingError
from firm_hdl.verify.references.fastcdr import NEWER, FastCdr
from firm_hdl.verify.references.libraries import (
    CycloneDds,
    FirmHdl,
    Genpy,
    McapRos1,
    McapRos2,
    Rosbags,
)
from firm_hdl.wire import Wire

__all__ = [
    "CLIENTS",
    "REFERENCES",
    "WIDE_REFERENCES",
    "WRITERS",
    "client",
    "close_clients",
    "find_clients",
    "find_references",
    "may_stand_in",
    "usable_references",
]

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


WRITERS: dict[str, frozenset[Wire]] = {
    name: kind.wires for name, kind in CLIENTS.items() if kind.may_confirm
}
"""Libraries that may confirm what rosbags writes, with the wires on which they may."""

WIDE_REFERENCES = ("fastcdr", *(kind.name for kind in NEWER))
"""Libraries that support wide text, which rosbags does not. One of them is enough."""


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


def find_clients(names: Sequence[str]) -> tuple[dict[str, str], dict[str, str]]:
    """Return the versions of the installed libraries, and why the others cannot be used."""
    versions, missing = {}, {}
    for name in names:
        why = client(name).missing()
        if why is None:
            versions[name] = client(name).version()
        else:
            missing[name] = why
    # Forked processes must not inherit the clients of this process.
    close_clients()
    return versions, missing


def usable_references(wanted: Sequence[str] | None = None) -> tuple[str, ...]:
    """Return those of the wanted libraries that can be asked in this process; `None`: of all."""
    names = WRITERS if wanted is None else [name for name in WRITERS if name in wanted]
    return tuple(name for name in names if client(name).missing() is None)


def may_stand_in(message: Message, wanted: Sequence[str] | None = None) -> bool:
    """Whether a type has wide text, and a library that can confirm its bytes is installed."""
    names = [name for name in WIDE_REFERENCES if wanted is None or name in wanted]
    return bool(stand_ins(closure([message]))) and bool(usable_references(names))


def find_references(wanted: Sequence[str] | None, wires: Sequence[str]) -> list[str]:
    """Return a line for each library that cannot be used; for a process that starts others.

    Raises `ClientMissingError` if a library that is wanted by name cannot be used.
    """
    names = [name for name in WRITERS if set(wires) & WRITERS[name]]
    _, missing = find_clients(names if wanted is None else wanted)
    if missing and wanted is not None:
        raise ClientMissingError(next(iter(missing.values())))
    return [f"{name} does not confirm bytes: {why}" for name, why in missing.items()]


# Otherwise, the processes that the libraries started would wait for more requests.
atexit.register(close_clients)
