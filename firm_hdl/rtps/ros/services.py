"""Services and clients of ROS 2, as Fast DDS's middleware maps them to topics.

A request and its reply are samples of two topics. The reply names the request in its inline QoS
(DDS-RPC 7.6.2). A client puts the GUID of its reader of replies into the inline QoS of its
requests, and the reply then has this one in the place of the writer.
"""

from __future__ import annotations

import logging
import threading
import time
from collections import Counter
from collections.abc import Callable
from concurrent.futures import Future
from concurrent.futures import TimeoutError as NoReply
from dataclasses import dataclass
from typing import Generic, TypeAlias, TypeVar

from firm_hdl.rtps.discovery import EndpointData
from firm_hdl.rtps.endpoints import ClosedError, DataReader, DataWriter
from firm_hdl.rtps.events import Sample
from firm_hdl.rtps.participant import Participant
from firm_hdl.rtps.wire.guid import Guid, SampleIdentity

__all__ = ["Client", "Handler", "Service"]

_LOG = logging.getLogger("firm_hdl.rtps")

# SEQUENCENUMBER_UNKNOWN (8.3.5.4).
_UNKNOWN_NUMBER = -1 << 32
# The bit of an entity identifier's kind that readers have, and writers have not (9.3.1.5).
_READER_BIT = 0x04
# Seconds for which a reply waits for its reader.
_PATIENCE = 5.0
# Requests without a reply, or replies that wait for their reader: of all participants, and of one.
# A reply counts once more for each 64 KiB.
_MOST, _MOST_OF_PEER, _UNIT_BYTES = 1024, 256, 1 << 16

_T = TypeVar("_T")

Handler: TypeAlias = Callable[[bytes], "bytes | Future[bytes]"]
"""Takes the payload of a request, and returns that of the reply, or a future that will have it, in
any thread. A request whose future is cancelled gets no reply."""


class _Queue(Generic[_T]):
    """What waits of each participant, within limits. Users have a lock."""

    def __init__(self) -> None:
        self._of_peer: dict[bytes, dict[object, tuple[int, _T]]] = {}
        self._sizes: Counter[bytes] = Counter()

    def add(self, prefix: bytes, key: object, size: int, value: _T) -> list[_T]:
        """Add a value that counts `size`; return those that give way.

        They are the oldest of a participant that has too many, or of the one that has most.
        """
        self._of_peer.setdefault(prefix, {})[key] = (size, value)
        self._sizes[prefix] += size
        given_up = []
        while self._sizes.total() > _MOST or self._sizes[prefix] > _MOST_OF_PEER:
            largest = max(self._sizes, key=self._sizes.__getitem__)
            oldest = next(iter(self._of_peer[largest]))
            given_up.append(self._of_peer[largest][oldest][1])
            self.pop(largest, oldest)
        return given_up

    def pop(self, prefix: bytes, key: object) -> bool:
        """Remove a value; return whether it was there."""
        size, _ = self._of_peer.get(prefix, {}).pop(key, (0, None))
        self._sizes[prefix] -= size
        if not self._sizes[prefix]:
            self._of_peer.pop(prefix, None)
            del self._sizes[prefix]
        return size > 0

    def of(self, prefix: bytes) -> list[_T]:
        """Return what waits of a participant, the oldest first."""
        return [value for _, value in self._of_peer.get(prefix, {}).values()]


@dataclass(frozen=True, slots=True)
class _Reply:
    """A reply that waits for its reader, until a time in seconds."""

    identity: SampleIdentity
    payload: bytes
    deadline: float


class Service:
    """A service; see :meth:`firm_hdl.rtps.ros.node.Node.service`.

    Attributes
    ----------
    replies, requests : DataWriter and DataReader
        The node sets both, the writer first: requests come once there is the reader.
    dropped : int
        How many requests and replies gave way to others, as too many waited, or came too late.
    """

    replies: DataWriter
    requests: DataReader

    def __init__(self, handler: Handler):
        self._handler = handler
        # Replies may come from any thread.
        self._lock = threading.Lock()
        # Replies whose reader is not known yet: discovery may bring the request's writer first.
        self._waiting: _Queue[_Reply] = _Queue()
        # Requests that the handler has not answered yet.
        self._open: _Queue[Future[bytes]] = _Queue()
        self.dropped = 0

    def on_request(self, request: Sample) -> None:
        """Answer a request."""
        identity, prefix = request.identity, request.writer.prefix
        if request.related is not None and any(bytes(request.related.writer)):
            identity = SampleIdentity(request.related.writer, request.sequence_number)
        reply = self._handler(request.payload)
        if not isinstance(reply, Future):
            self._reply(identity, reply)
            return
        with self._lock:
            given_up = self._open.add(prefix, reply, 1, reply)
            self.dropped += len(given_up)
        for each in given_up:
            each.cancel()
        reply.add_done_callback(lambda done: self._reply_of(prefix, identity, done))

    def _reply_of(self, prefix: bytes, identity: SampleIdentity, done: Future[bytes]) -> None:
        with self._lock:
            self._open.pop(prefix, done)
        if done.cancelled():
            return
        if (problem := done.exception()) is not None:
            _LOG.error("a service failed", exc_info=problem)
            return
        try:
            self._reply(identity, done.result())
        except ClosedError:
            # Nobody waits for it any more.
            return
        except (TypeError, ValueError) as problem:
            _LOG.error("a service failed: %s", problem)

    def _reply(self, identity: SampleIdentity, payload: bytes) -> None:
        """Send a reply, or keep it until its reader is known."""
        readers = self._readers_of(identity)
        if readers:
            self.replies.write(payload, identity, to=readers)
            return
        reply = _Reply(identity, payload, time.monotonic() + _PATIENCE)
        size, prefix = 1 + len(payload) // _UNIT_BYTES, identity.writer.prefix
        with self._lock:
            self.dropped += len(self._waiting.add(prefix, identity, size, reply))
        # The reader may have come since.
        self._try(reply)

    def _readers_of(self, identity: SampleIdentity) -> list[Guid]:
        """Return the reader that asked, if it is known.

        A client that names no reader has one in the participant that its request came from.
        """
        asked, is_named = identity.writer, bool(identity.writer.entity & _READER_BIT)
        return [
            each.guid
            for each in self.replies.matched
            if each.guid == asked or (not is_named and each.guid.prefix == asked.prefix)
        ]

    def _try(self, reply: _Reply) -> None:
        """Send a reply that waits, if its reader is known."""
        is_late = reply.deadline < time.monotonic()
        readers = self._readers_of(reply.identity)
        if not is_late and not readers:
            return
        with self._lock:
            # Another thread may have sent it.
            waits = self._waiting.pop(reply.identity.writer.prefix, reply.identity)
            self.dropped += waits and is_late
        if waits and not is_late:
            self.replies.write(reply.payload, reply.identity, to=readers)

    def on_match(self, reader: EndpointData, came: bool) -> None:
        """Send the replies that wait for a reader."""
        if came:
            with self._lock:
                waiting = self._waiting.of(reader.guid.prefix)
            for reply in waiting:
                self._try(reply)

    def close(self) -> None:
        """Remove the service."""
        self.requests.close()
        self.replies.close()


class Client:
    """A client of a service; see :meth:`firm_hdl.rtps.ros.node.Node.client`."""

    def __init__(self, participant: Participant):
        self._participant = participant
        self._requests: DataWriter | None = None
        self._replies: DataReader | None = None
        self._lock = threading.Lock()
        self._pending: dict[int, Future[bytes]] = {}

    def open(self, requests: DataWriter, replies: DataReader) -> None:
        """Take the endpoints."""
        self._requests, self._replies = requests, replies

    def wait_for_service(self, timeout: float = 10.0) -> bool:
        """Wait until a server has both topics, at most `timeout` seconds."""
        return self._participant.wait_until(self._ready, timeout)

    def call_async(self, payload: bytes) -> Future[bytes]:
        """Send a request. The future gets the payload of the reply."""
        assert self._requests is not None and self._replies is not None
        future: Future[bytes] = Future()
        with self._lock:
            related = SampleIdentity(self._replies.guid, _UNKNOWN_NUMBER)
            number = self._requests.write(payload, related)
            self._pending[number] = future
        future.add_done_callback(lambda _: self._forget(number))
        return future

    def call(self, payload: bytes, timeout: float = 10.0) -> bytes:
        """Send a request, and return the payload of the reply.

        Raises
        ------
        TimeoutError
            There was no reply in `timeout` seconds, or no server.
        """
        deadline = time.monotonic() + timeout
        if not self.wait_for_service(timeout):
            raise TimeoutError(f"no server in {timeout} s")
        future = self.call_async(payload)
        try:
            return future.result(max(0.0, deadline - time.monotonic()))
        except NoReply as problem:
            # Before Python 3.11, this error is another one than that of the builtins.
            raise TimeoutError(f"no reply in {timeout} s") from problem
        finally:
            future.cancel()

    def on_reply(self, reply: Sample) -> None:
        """Take a reply, which may be for another client."""
        related = reply.related
        if related is None or self._requests is None or self._replies is None:
            return
        if related.writer not in (self._requests.guid, self._replies.guid):
            return
        with self._lock:
            future = self._pending.pop(related.sequence_number, None)
        if future is not None and future.set_running_or_notify_cancel():
            future.set_result(reply.payload)

    def close(self) -> None:
        """Remove the client."""
        for each in (self._requests, self._replies):
            if each is not None:
                each.close()

    def _ready(self) -> bool:
        """Whether a participant has a reader of requests and a writer of replies."""
        if self._requests is None or self._replies is None:
            return False
        servers = {each.guid.prefix for each in self._requests.matched}
        return any(each.guid.prefix in servers for each in self._replies.matched)

    def _forget(self, number: int) -> None:
        with self._lock:
            self._pending.pop(number, None)
