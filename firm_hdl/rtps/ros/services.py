"""Services and clients of ROS 2, as Fast DDS's middleware maps them to topics.

A request and its reply are samples of two topics. The reply names the request in its inline QoS
(DDS-RPC 7.6.2). A client puts the GUID of its reader of replies into the inline QoS of its
requests, and the reply then has this one in the place of the writer.
"""

from __future__ import annotations

import logging
import threading
import time
from collections import OrderedDict
from collections.abc import Callable
from concurrent.futures import Future
from concurrent.futures import TimeoutError as NoReply
from typing import TypeAlias

from firm_hdl.rtps.discovery import EndpointData
from firm_hdl.rtps.endpoints import DataReader, DataWriter
from firm_hdl.rtps.events import Sample
from firm_hdl.rtps.participant import Participant
from firm_hdl.rtps.wire.guid import SampleIdentity

__all__ = ["Client", "Handler", "Service"]

_LOG = logging.getLogger("firm_hdl.rtps")

# SEQUENCENUMBER_UNKNOWN (8.3.5.4).
_UNKNOWN_NUMBER = -1 << 32
# The bit of an entity identifier's kind that readers have, and writers have not (9.3.1.5).
_READER_BIT = 0x04
# Seconds for which a reply waits for its reader, and how many replies may wait.
_PATIENCE, _MOST_WAITING = 5.0, 256

Handler: TypeAlias = Callable[[bytes], "bytes | Future[bytes]"]
"""Takes the payload of a request, and returns that of the reply, or a future that will have it, in
any thread. A request whose future is cancelled gets no reply."""


class Service:
    """A service; see :meth:`firm_hdl.rtps.ros.node.Node.service`."""

    def __init__(self, participant: Participant, handler: Handler):
        self._participant = participant
        self._handler = handler
        self._replies: DataWriter | None = None
        self._requests: DataReader | None = None
        self._early: list[Sample] = []
        # Replies may come from any thread.
        self._lock = threading.Lock()
        # Replies whose reader is not known yet: discovery may bring the request's writer first.
        self._waiting: OrderedDict[SampleIdentity, tuple[float, bytes]] = OrderedDict()

    def open(self, requests: DataReader, replies: DataWriter) -> None:
        """Begin to serve."""
        self._requests, self._replies = requests, replies
        early, self._early = self._early, []
        for request in early:
            self.on_request(request)

    def on_request(self, request: Sample) -> None:
        """Answer a request."""
        if self._replies is None:
            self._early.append(request)
            return
        identity = request.identity
        if request.related is not None and any(bytes(request.related.writer)):
            identity = SampleIdentity(request.related.writer, request.sequence_number)
        reply = self._handler(request.payload)
        if isinstance(reply, bytes):
            self._reply(identity, reply)
            return
        reply.add_done_callback(lambda done: self._reply_of(identity, done))

    def _reply_of(self, identity: SampleIdentity, done: Future[bytes]) -> None:
        if done.cancelled():
            return
        if (problem := done.exception()) is not None:
            _LOG.error("a service failed", exc_info=problem)
            return
        self._reply(identity, done.result())

    def _reply(self, identity: SampleIdentity, reply: bytes) -> None:
        """Send a reply, or keep it until its reader is known."""
        assert self._replies is not None
        is_reader = bool(identity.writer.entity & _READER_BIT)
        known = {each.guid for each in self._replies.matched}
        if not is_reader or identity.writer in known:
            self._replies.write(reply, identity)
            return
        with self._lock:
            self._waiting[identity] = (time.monotonic() + _PATIENCE, reply)
            while len(self._waiting) > _MOST_WAITING:
                self._waiting.popitem(last=False)
        # The reader may have come since.
        for each in self._replies.matched:
            self.on_match(each, True)

    def on_match(self, reader: EndpointData, came: bool) -> None:
        """Send the replies that wait for a reader."""
        now, found = time.monotonic(), []
        with self._lock:
            for identity, (deadline, reply) in list(self._waiting.items()):
                if deadline < now:
                    del self._waiting[identity]
                elif came and identity.writer == reader.guid and self._replies is not None:
                    del self._waiting[identity]
                    found.append((identity, reply))
        for identity, reply in found:
            assert self._replies is not None
            self._replies.write(reply, identity)

    def close(self) -> None:
        """Remove the service."""
        for each in (self._requests, self._replies):
            if each is not None:
                each.close()


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
