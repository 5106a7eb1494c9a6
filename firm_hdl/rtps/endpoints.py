"""Writers and readers as users have them: handles on those of a participant."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypeAlias

from firm_hdl.rtps.discovery import EndpointData
from firm_hdl.rtps.events import Sample
from firm_hdl.rtps.reader import Reader
from firm_hdl.rtps.wire.guid import Guid, SampleIdentity
from firm_hdl.rtps.writer import Writer

__all__ = ["DataReader", "DataWriter", "Endpoint", "OnIncompatible", "OnMatch", "OnSample", "Owner"]

OnSample: TypeAlias = Callable[[Sample], None]
OnMatch: TypeAlias = Callable[[EndpointData, bool], None]
OnIncompatible: TypeAlias = Callable[[EndpointData, tuple[str, ...]], None]


class Owner(Protocol):
    """What endpoints need of their participant; see its methods of the same names."""

    def matched(self, guid: Guid) -> tuple[EndpointData, ...]:
        """Return the endpoints of peers that an endpoint is matched with."""

    def remove(self, guid: Guid) -> None:
        """Remove an endpoint."""

    def wait_until(self, condition: Callable[[], bool], timeout: float) -> bool:
        """Wait for a condition."""

    def write(
        self, writer: Writer, payload: bytes, related: SampleIdentity | None, timeout: float
    ) -> int:
        """Write a sample."""


class Endpoint:
    """What writers and readers of a user have in common.

    Attributes
    ----------
    guid : Guid
        Name of the endpoint.
    topic, type_name : str
        The names on the wire.
    on_match : callable or None
        Called with an endpoint of a peer, and whether it came (`True`) or went.
    on_incompatible : callable or None
        Called with an endpoint of a peer whose policies do not fit, and the names of those.
    """

    def __init__(self, participant: Owner, guid: Guid, topic: str, type_name: str):
        self._participant = participant
        self.guid = guid
        self.topic = topic
        self.type_name = type_name
        self.on_match: OnMatch | None = None
        self.on_incompatible: OnIncompatible | None = None

    @property
    def matched(self) -> tuple[EndpointData, ...]:
        """The endpoints of peers that it is matched with."""
        return self._participant.matched(self.guid)

    def wait_for_match(self, count: int = 1, timeout: float = 10.0) -> bool:
        """Wait until it is matched with `count` endpoints, at most `timeout` seconds.

        Raises
        ------
        RuntimeError
            The caller is a callback.
        """
        return self._participant.wait_until(lambda: len(self.matched) >= count, timeout)

    def close(self) -> None:
        """Remove the endpoint, and tell peers."""
        self._participant.remove(self.guid)


class DataWriter(Endpoint):
    """A writer of a user; see :meth:`Participant.writer`."""

    def __init__(self, participant: Owner, writer: Writer, topic: str, type_name: str):
        super().__init__(participant, writer.guid, topic, type_name)
        self._writer = writer

    def write(
        self, payload: bytes, related: SampleIdentity | None = None, timeout: float = 0.1
    ) -> int:
        """Write a sample, and return its sequence number.

        Parameters
        ----------
        payload : bytes
            The serialized sample with its encapsulation header of 4 bytes.
        related : SampleIdentity or None
            The sample that this one answers.
        timeout : float
            Seconds to wait for room, if the writer keeps all samples (`Qos.depth` 0).

        Raises
        ------
        HistoryFullError
            There was no room in time.
        """
        return self._participant.write(self._writer, payload, related, timeout)

    def wait_for_acknowledgments(self, timeout: float = 10.0) -> bool:
        """Wait until all reliable readers have all samples, at most `timeout` seconds."""
        return self._participant.wait_until(lambda: self._writer.acknowledged, timeout)


class DataReader(Endpoint):
    """A reader of a user; see :meth:`Participant.reader`."""

    def __init__(
        self,
        participant: Owner,
        reader: Reader,
        topic: str,
        type_name: str,
        on_sample: OnSample,
    ):
        super().__init__(participant, reader.guid, topic, type_name)
        self._reader = reader
        self.on_sample = on_sample

    @property
    def lost(self) -> int:
        """How many samples did not come, and will not."""
        return self._reader.lost
