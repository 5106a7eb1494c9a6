"""What endpoints ask to be sent: submessages, and the peer that they are for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from firm_hdl.rtps.wire.locators import Address
from firm_hdl.rtps.wire.submessages import Submessage

__all__ = ["Outgoing", "Send"]


@dataclass(frozen=True, slots=True)
class Outgoing:
    """One datagram.

    Attributes
    ----------
    to : Address
        Where it goes.
    prefix : bytes
        GUID prefix of the participant that it is for.
    submessages : tuple
        Its content, without the INFO_DST that names the participant.
    """

    to: Address
    prefix: bytes
    submessages: tuple[Submessage, ...]


Send: TypeAlias = Callable[[Outgoing], None]
"""Takes a datagram. It is sent later, or lost."""
