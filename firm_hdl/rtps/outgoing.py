"""What endpoints ask to be sent: submessages, and the peer that they are for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from firm_hdl.rtps.peers import Route
from firm_hdl.rtps.wire.submessages import Submessage

__all__ = ["Outgoing", "Send"]


@dataclass(frozen=True, slots=True)
class Outgoing:
    """One datagram.

    Attributes
    ----------
    route : Route
        The way that it goes.
    prefix : bytes
        GUID prefix of the participant that it is for.
    submessages : tuple
        Its content, without the INFO_DST that names the participant.
    is_answer : bool
        Whether the peer has made us send it, so that it costs credit (:mod:`firm_hdl.rtps.peers`).
    """

    route: Route
    prefix: bytes
    submessages: tuple[Submessage, ...]
    is_answer: bool = True


Send: TypeAlias = Callable[[Outgoing], None]
"""Takes a datagram. It is sent later, or lost."""
