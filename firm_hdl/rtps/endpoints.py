"""Writers and readers as users have them: handles on those of a participant."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import TYPE_CHECKING, TypeAlias

from firm_hdl.rtps.backlog import MOST_SAMPLE_BYTES
from firm_hdl.rtps.discovery import EndpointData
from firm_hdl.rtps.events import Sample
from firm_hdl.rtps.reader import Reader
from firm_hdl.rtps.wire.guid import Guid, SampleIdentity
from firm_hdl.rtps.writer import Writer

if TYPE_CHECKING:
    from firm_hdl.rtps.participant import Participant

__all__ = [
    "ClosedError",
    "DataReader",
    "DataWriter",
    "Endpoint",
    "OnIncompatible",
    "OnMatch",
    "OnSample",
]

# The encapsulation header of a serialized sample (10.2).
_HEADER_BYTES = 4

OnSample: TypeAlias = Callable[[Sample], None]
OnMatch: TypeAlias = Callable[[EndpointData, bool], None]
OnIncompatible: TypeAlias = Callable[[EndpointData, tuple[str, ...]], None]


class ClosedError(RuntimeError):
    """A participant or a writer was used after it was closed."""


class Endpoint:
    """What writers and readers of a user have in common."""

    def __init__(self, participant: Participant, guid: Guid, topic: str, type_name: str):
        self._participant = participant
        self.guid = guid  # Name of the endpoint.
        # The names on the wire.
        self.topic = topic
        self.type_name = type_name
        # Called with another endpoint, and whether it came (`True`) or went.
        self.on_match: OnMatch | None = None
        # Called with another endpoint whose policies do not fit, and the names of those.
        self.on_incompatible: OnIncompatible | None = None

    @property
    def matched(self) -> tuple[EndpointData, ...]:
        """The endpoints of peers, and of its own participant, that it is matched with."""
        return self._participant.matched(self.guid)

    def wait_for_match(self, count: int = 1, timeout: float = 10.0) -> bool:
        """Wait until it is matched with `count` endpoints, at most `timeout` seconds.

        Raises `RuntimeError`: the caller is a callback.
        """
        return self._participant.wait_until(lambda: len(self.matched) >= count, timeout)

    def close(self) -> None:
        """Remove the endpoint, and tell peers; see :meth:`Participant.remove`."""
        self._participant.remove(self.guid)


class DataWriter(Endpoint):
    """A writer of a user; see :meth:`Participant.writer`."""

    def __init__(self, participant: Participant, writer: Writer, topic: str, type_name: str):
        super().__init__(participant, writer.guid, topic, type_name)
        self._writer = writer

    @property
    def overwritten(self) -> int:
        """How many samples gave way to new ones before all reliable readers acknowledged them."""
        return self._writer.overwritten

    def write(
        self,
        payload: bytes,
        related: SampleIdentity | None = None,
        timeout: float = 0.1,
        to: Collection[Guid] | None = None,
    ) -> int:
        """Write a sample, and return its sequence number.

        * `payload`: the serialized sample with its encapsulation header of 4 bytes.
        * `related`: the sample that this one answers.
        * `timeout`: seconds to wait for room, if the writer keeps all samples (`Qos.depth` 0).
        * `to`: the readers that get it; by default all.

        Raises `ClosedError`: the writer, or its participant, is closed. Raises `HistoryFullError`:
        there was no room in time. Raises `TypeError` or `ValueError`: a parameter is none of the
        above. Nothing was written.
        """
        if not isinstance(payload, bytes | bytearray | memoryview):
            raise TypeError(f"a sample is bytes, not {type(payload).__name__}")
        payload = bytes(payload)
        if not _HEADER_BYTES <= len(payload) <= MOST_SAMPLE_BYTES:
            raise ValueError(
                f"a sample has at least the {_HEADER_BYTES} bytes of its encapsulation header, and "
                f"at most {MOST_SAMPLE_BYTES} bytes; this one has {len(payload)}"
            )
        if related is not None and not isinstance(related, SampleIdentity):
            raise TypeError(f"a sample is related to a SampleIdentity, not to {related!r}")
        return self._participant.write(self._writer, payload, related, float(timeout), to)

    def wait_for_acknowledgments(self, timeout: float = 10.0) -> bool:
        """Wait until all reliable readers have all samples, at most `timeout` seconds."""
        return self._participant.wait_until(lambda: self._writer.acknowledged, timeout)


class DataReader(Endpoint):
    """A reader of a user; see :meth:`Participant.reader`."""

    def __init__(
        self,
        participant: Participant,
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
