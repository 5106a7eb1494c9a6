"""What happened in a participant, for its user."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from firm_hdl.rtps.discovery import EndpointData, ParticipantData
from firm_hdl.rtps.wire.guid import Guid, SampleIdentity

__all__ = [
    "Arrived",
    "Event",
    "Incompatible",
    "Matched",
    "PeerFound",
    "PeerLost",
    "Sample",
    "Unmatched",
]


@dataclass(frozen=True, slots=True, kw_only=True)
class Sample:
    """A sample of a peer."""

    payload: bytes  # The serialized sample with its encapsulation header of 4 bytes.
    writer: Guid  # Who wrote it.
    sequence_number: int  # Its number at the writer, from 1 on.
    # When the writer wrote it, in nanoseconds since 1970, where it says so.
    source_timestamp: int | None = None
    # The sample that it answers, where it names one; see `firm_hdl.rtps.ros.services`.
    related: SampleIdentity | None = None

    @property
    def identity(self) -> SampleIdentity:
        """The name of the sample."""
        return SampleIdentity(self.writer, self.sequence_number)


@dataclass(frozen=True, slots=True)
class Arrived:
    """A sample came for one of our readers."""

    reader: Guid
    sample: Sample


@dataclass(frozen=True, slots=True)
class Matched:
    """One of our endpoints, `local`, and one of a peer found each other."""

    local: Guid
    remote: EndpointData


@dataclass(frozen=True, slots=True)
class Unmatched:
    """An endpoint of a peer that was matched is gone."""

    local: Guid
    remote: EndpointData


@dataclass(frozen=True, slots=True)
class Incompatible:
    """Topic and type of two endpoints are equal, but the reader asks for more than is offered."""

    local: Guid
    remote: EndpointData
    policies: tuple[str, ...]  # The policies in question, such as `"RELIABILITY"`.


@dataclass(frozen=True, slots=True)
class PeerFound:
    """A participant is new."""

    peer: ParticipantData


@dataclass(frozen=True, slots=True)
class PeerLost:
    """A participant is gone: it said so, or it was silent for its lease (`expired`)."""

    peer: ParticipantData
    expired: bool


Event: TypeAlias = Arrived | Matched | Unmatched | Incompatible | PeerFound | PeerLost
