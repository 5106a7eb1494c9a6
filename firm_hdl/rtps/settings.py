"""What a participant is and does."""

from __future__ import annotations

from dataclasses import dataclass

from firm_hdl.rtps.discovery import ParticipantData
from firm_hdl.rtps.wire.locators import Address
from firm_hdl.rtps.writer import FRAGMENT_BYTES

__all__ = ["Settings"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """What a participant is and does.

    Attributes
    ----------
    own : ParticipantData
        What it announces.
    host : str
        Its IPv4 address.
    targets : tuple of Address
        Where announcements go, besides known peers.
    seldom : tuple of Address
        Where they go at first, and seldom after that: addresses where a peer may be.
    period : float
        Seconds between announcements.
    fragment_bytes : int
        Larger samples are sent in fragments of this size: from 256 to 65,000.
    memory_bytes : int
        Memory for samples that cannot be delivered yet.
    """

    own: ParticipantData
    host: str
    targets: tuple[Address, ...]
    seldom: tuple[Address, ...] = ()
    period: float = 1.0
    fragment_bytes: int = FRAGMENT_BYTES
    memory_bytes: int = 128 << 20

    def __post_init__(self) -> None:
        if not 256 <= self.fragment_bytes <= 65_000:
            raise ValueError(
                f"Fragments must have from 256 to 65000 bytes, not {self.fragment_bytes}"
            )
