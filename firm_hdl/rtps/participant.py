"""A participant on the network: sockets, a thread, and the endpoints that users have.

One thread receives, keeps the time, and calls users back. Any thread may write. So a user who waits
in a callback holds up what comes in, as does one who waits with a lock that a callback needs.
"""

from __future__ import annotations

import logging
import selectors
import socket
import threading
import time
from collections import Counter
from collections.abc import Callable, Collection
from typing import TypeAlias

from firm_hdl.rtps.backlog import MOST_SAMPLE_BYTES
from firm_hdl.rtps.core import Core
from firm_hdl.rtps.discovery import MOST_USER_DATA, EndpointData, ParticipantData
from firm_hdl.rtps.endpoints import (
    ClosedError,
    DataReader,
    DataWriter,
    OnIncompatible,
    OnMatch,
    OnSample,
)
from firm_hdl.rtps.events import Arrived, Event, Incompatible, Matched, Unmatched
from firm_hdl.rtps.qos import Durability, Qos
from firm_hdl.rtps.spdp import Settings
from firm_hdl.rtps.transport import Transport, address_of
from firm_hdl.rtps.wire.guid import Guid, SampleIdentity, new_prefix
from firm_hdl.rtps.wire.locators import Address, Ports
from firm_hdl.rtps.wire.octets import MOST_NAME_BYTES
from firm_hdl.rtps.writer import FRAGMENT_BYTES, HistoryFullError, Writer

__all__ = ["Pacer", "Participant"]

# A socket of Linux holds 212,992 bytes by default, and counts a datagram of 1,400 bytes as 2,304.
_BURST_BYTES = 64 << 10
# After a pause, as much may be sent at once: a pause for each datagram would cost more than that.
_CHUNK_BYTES = 16 << 10


class Pacer:
    """A token bucket.

    * `bytes_per_second`: the rate in the long run. A burst of 64 KiB passes at once.
    """

    def __init__(self, bytes_per_second: float):
        if bytes_per_second <= 0:
            raise ValueError(f"Rate must be positive, not {bytes_per_second}")
        self._rate = bytes_per_second
        self._tokens = float(_BURST_BYTES)
        self._at = 0.0
        self._needed = 0.0

    def wait(self, now: float) -> float:
        """Return the seconds until the next datagram may be sent; 0 or less means now."""
        if now > self._at:
            self._tokens = min(_BURST_BYTES, self._tokens + (now - self._at) * self._rate)
            self._at = now
        # A datagram may be larger than what is left: the debt is paid before the next one.
        if self._tokens > self._needed:
            self._needed = 0.0
            return 0.0
        self._needed = float(_CHUNK_BYTES)
        return (self._needed - self._tokens) / self._rate

    def note(self, size: int) -> None:
        """Note that a datagram of `size` bytes was sent."""
        self._tokens -= size


_LOG = logging.getLogger("firm_hdl.rtps")
# Seconds. A write in another thread may make a heartbeat due that soon.
_MOST_SLEEP = 0.05
# Most participants of a host have one of the first numbers. All numbers are tried, too, but seldom.
_FIRST_PARTICIPANTS = 5
# Seconds that closing waits until what was written is sent and acknowledged.
_FAREWELL = 1.0

OnEvent: TypeAlias = Callable[[Event], None]


class Participant:
    """A participant of a domain. It is also a context manager, which closes it.

    * `domain`: the domain, from 0 to 232.
    * `interface`: an interface or its IPv4 address; `None` for the one that multicast goes to. All
      traffic stays on it, so ``"lo"`` stays on the host.
    * `name`: name of the participant, which tools show.
    * `user_data`: what it announces in addition.
    * `peers`: IPv4 addresses of hosts that multicast does not reach. Without multicast, and on the
      loopback interface, which may have none, this host is one of them.
    * `multicast`: whether it announces itself by multicast. Announcements of others are received
      anyway.
    * `lease`: seconds after which peers take this participant for gone if it is silent.
    * `period`: seconds between announcements.
    * `fragment_bytes`: larger samples are sent in fragments of this size.
    * `bytes_per_second`: how much is sent at most, so that receivers keep up; short bursts pass.
    * `on_event`: called with every event but arrived samples.

    Raises `TransportError`: the interface has no address, or sockets cannot be opened. Raises
    `ValueError`: the domain is out of range, or the name or the user data is too long for peers.
    """

    def __init__(
        self,
        domain: int = 0,
        *,
        interface: str | None = None,
        name: str = "firm-hdl",
        user_data: bytes = b"",
        peers: tuple[str, ...] = (),
        multicast: bool = True,
        lease: float = 20.0,
        period: float = 1.0,
        fragment_bytes: int = FRAGMENT_BYTES,
        bytes_per_second: float = 40e6,
        on_event: OnEvent | None = None,
        transport: Transport | None = None,
    ):
        _check_name("participant", name, least=0)
        _check_user_data(user_data)
        host = address_of(interface)
        self._transport = transport or Transport(domain, host)
        self._on_event = on_event
        own = ParticipantData(
            prefix=new_prefix(),
            discovery=(self._transport.discovery,),
            user=(self._transport.user,),
            lease=lease,
            user_data=user_data,
            name=name,
            domain=domain,
        )
        group = (self._transport.group,) if multicast else ()
        alone = host.startswith("127.") or not multicast
        hosts = dict.fromkeys((*([host] if alone else []), *peers))
        ports = [each.discovery for each in Ports.all_of(domain)]
        first, rest = ports[:_FIRST_PARTICIPANTS], ports[_FIRST_PARTICIPANTS:]
        self._core = Core(
            Settings(
                own=own,
                host=host,
                targets=(*group, *(Address(each, port) for each in hosts for port in first)),
                seldom=tuple(Address(each, port) for each in hosts for port in rest),
                period=period,
                fragment_bytes=fragment_bytes,
            )
        )
        self._pacer = Pacer(bytes_per_second)
        self._endpoints: dict[Guid, DataWriter | DataReader] = {}
        self._lock = threading.RLock()
        self._changed = threading.Condition(self._lock)
        # A participant that closes takes nothing new, but sends what it has. Then it has left.
        self._closing = self._left = False
        self._wake_receiver, self._wake_sender = socket.socketpair()
        for each in (self._wake_receiver, self._wake_sender):
            each.setblocking(False)
        self._selector = selectors.DefaultSelector()
        for source in (*self._transport.sockets, self._wake_receiver):
            self._selector.register(source, selectors.EVENT_READ)
        self._thread = threading.Thread(target=self._run, name=f"rtps {name}", daemon=True)
        self._thread.start()

    def __enter__(self) -> Participant:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def prefix(self) -> bytes:
        """GUID prefix of the participant."""
        return self._core.prefix

    @property
    def peers(self) -> tuple[ParticipantData, ...]:
        """The participants that are there."""
        with self._lock:
            return self._core.peers

    @property
    def counters(self) -> Counter[str]:
        """What came and went, and what was refused; docs/explanation/rtps.md explains each."""
        with self._lock:
            return Counter(self._core.counters)

    def count(self, name: str) -> None:
        """Add one to a counter."""
        with self._lock:
            self._core.counters[name] += 1

    def remotes(self, writers: bool) -> tuple[EndpointData, ...]:
        """Return the writers or the readers of all peers."""
        with self._lock:
            return tuple(self._core.remotes(writers))

    def matched(self, guid: Guid) -> tuple[EndpointData, ...]:
        """Return the endpoints that an endpoint is matched with."""
        with self._lock:
            return self._core.matched(guid)

    def writer(
        self,
        topic: str,
        type_name: str,
        qos: Qos | None = None,
        *,
        user_data: bytes = b"",
        on_match: OnMatch | None = None,
        on_incompatible: OnIncompatible | None = None,
    ) -> DataWriter:
        """Create a writer.

        * `topic`, `type_name`: names on the wire; those of ROS 2 are in
          :mod:`firm_hdl.rtps.ros.names`.
        * `qos`: policies. By default, the writer is reliable and volatile, and keeps 10 samples.
        * `user_data`: what is announced in addition.
        * `on_match`, `on_incompatible`: see :class:`firm_hdl.rtps.endpoints.Endpoint`.

        Raises `ClosedError`: the participant is closed. Raises `TypeError` or `ValueError`: a
        parameter is none of the above, or a name has more than 256 bytes.
        """
        qos = _checked(topic, type_name, qos, user_data)
        with self._lock:
            self._check_open()
            now = time.monotonic()
            made = self._core.add_writer(topic, type_name, qos, user_data, now)
            writer = DataWriter(self, made, topic, type_name)
            writer.on_match, writer.on_incompatible = on_match, on_incompatible
            self._endpoints[made.guid] = writer
            self._flush()
            return writer

    def reader(
        self,
        topic: str,
        type_name: str,
        on_sample: OnSample,
        qos: Qos | None = None,
        *,
        user_data: bytes = b"",
        most_bytes: int = MOST_SAMPLE_BYTES,
        on_match: OnMatch | None = None,
        on_incompatible: OnIncompatible | None = None,
    ) -> DataReader:
        """Create a reader; the parameters are those of :meth:`writer`.

        `on_sample` is called with each sample, in the thread of the participant. Samples of more
        than `most_bytes` are refused.
        """
        qos = _checked(topic, type_name, qos, user_data)
        if not callable(on_sample):
            raise TypeError(f"on_sample is called with each sample, so it cannot be {on_sample!r}")
        with self._lock:
            self._check_open()
            now = time.monotonic()
            made = self._core.add_reader(topic, type_name, qos, user_data, now, most_bytes)
            reader = DataReader(self, made, topic, type_name, on_sample)
            reader.on_match, reader.on_incompatible = on_match, on_incompatible
            self._endpoints[made.guid] = reader
            self._flush()
            return reader

    def remove(self, *guids: Guid) -> None:
        """Remove endpoints, and tell peers.

        What was written is acknowledged before, if that takes no longer than a second; else it is
        counted (``unacknowledged``).
        """
        with self._lock:
            writers = [each for each in self._core.writers if each.guid in guids]
        if writers:
            self._settle(writers, lambda: True)
        with self._lock:
            if not self._closing:
                for guid in guids:
                    self._core.remove(guid, time.monotonic())
                self._flush()
            for guid in guids:
                self._endpoints.pop(guid, None)

    def write(
        self,
        writer: Writer,
        payload: bytes,
        related: SampleIdentity | None,
        timeout: float,
        to: Collection[Guid] | None,
    ) -> int:
        """Write a sample; see :meth:`DataWriter.write`."""
        deadline = time.monotonic() + timeout
        while True:
            with self._changed:
                self._check_open(writer)
                now = time.monotonic()
                try:
                    number = self._core.write(writer, payload, now, time.time_ns(), related, to)
                    self._flush()
                    return number
                except HistoryFullError:
                    if now >= deadline:
                        raise
                    if not self._in_callback():
                        self._changed.wait(deadline - now)
                        continue
            # Nobody else receives the acknowledgements that make room.
            self._poll(min(deadline - now, _MOST_SLEEP))

    def wait_until(self, condition: Callable[[], bool], timeout: float) -> bool:
        """Wait for a condition that what comes from peers makes true.

        Returns: whether it is true; `False` after `timeout` seconds.

        Raises `RuntimeError`: the caller is a callback.
        """
        if self._in_callback():
            raise RuntimeError("a callback cannot wait for what comes after it")
        with self._changed:
            return self._changed.wait_for(lambda: self._closing or condition(), timeout) and (
                condition()
            )

    def close(self) -> None:
        """Tell peers that this participant leaves, and close its sockets. Once is enough.

        What was written is sent and acknowledged before, if that takes no longer than a second;
        else it is counted (``unsent``, ``unacknowledged``).
        """
        with self._changed:
            if self._closing:
                return
            self._closing = True
            self._changed.notify_all()
        self._settle(self._core.writers, lambda: not self._core.outbox)
        with self._lock:
            self._core.leave()
            self._flush(everything=True)
            self._left = True
        self._wake()
        if not self._in_callback():
            self._thread.join()

    def _settle(self, writers: Collection[Writer], condition: Callable[[], bool]) -> None:
        """Wait at most a second until readers have what was written, and for a condition."""

        def is_settled() -> bool:
            return condition() and not any(each.unacknowledged for each in writers)

        end = time.monotonic() + _FAREWELL
        with self._changed:
            for each in writers:
                each.ask_all(time.monotonic())
            self._flush()
            if not self._in_callback():
                self._changed.wait_for(is_settled, _FAREWELL)
                return
        # Nobody else receives the acknowledgements.
        while not is_settled() and (left := end - time.monotonic()) > 0:
            self._poll(min(left, _MOST_SLEEP))

    def _check_open(self, writer: Writer | None = None) -> None:
        """Raise an error if the participant is closed, or one of its writers."""
        if self._closing:
            raise ClosedError("the participant is closed")
        if writer is not None and writer.guid not in self._endpoints:
            raise ClosedError("the writer is closed")

    def _in_callback(self) -> bool:
        return threading.current_thread() is self._thread

    def _wake(self) -> None:
        try:
            self._wake_sender.send(b"\0")
        except OSError:
            # It is full of such bytes, or closed.
            return

    def _flush(self, everything: bool = False) -> float:
        """Send what may be sent now. Return seconds until more may be."""
        now = time.monotonic()
        if self._core.events and not self._in_callback():
            # Such as a sample for a reader of this participant.
            self._wake()
        while self._core.outbox:
            wait = 0.0 if everything else self._pacer.wait(now)
            if wait > 0:
                if not self._in_callback():
                    self._wake()
                return wait
            address, datagram = self._core.pop()
            self._pacer.note(len(datagram))
            self._core.counters["sent"] += 1
            if not self._transport.send(address, datagram):
                self._core.counters["dropped"] += 1
        return _MOST_SLEEP

    def _run(self) -> None:
        sleep = 0.0
        while not self._left:
            sleep = self._poll(sleep)
            self._dispatch()
        self._selector.close()
        self._transport.close()
        self._wake_receiver.close()
        self._wake_sender.close()

    def _poll(self, sleep: float) -> float:
        """Receive what comes within `sleep` seconds, and do what is due.

        Returns: seconds until something is due again.
        """
        for key, _ in self._selector.select(sleep):
            assert isinstance(key.fileobj, socket.socket)
            if key.fileobj is self._wake_receiver:
                self._wake_receiver.recv(4096)
                continue
            datagrams = list(self._transport.receive(key.fileobj))
            with self._lock:
                now = time.monotonic()
                for datagram, host in datagrams:
                    self._receive(datagram, now, host)
        with self._changed:
            now = time.monotonic()
            due = self._core.tick(now)
            self._changed.notify_all()
            return max(0.0, min(due - now, self._flush(), _MOST_SLEEP))

    def _receive(self, datagram: bytes, now: float, host: str) -> None:
        try:
            self._core.receive(datagram, now, host)
        except Exception:
            # No datagram is known that gets here. One must not end the participant.
            self._core.counters["failed"] += 1
            _LOG.exception("a fault of firm-hdl, with the datagram %s", datagram.hex())

    def _dispatch(self) -> None:
        """Call users back, without the lock, so that they may call in turn."""
        while True:
            with self._changed:
                event = self._core.next_event()
                self._changed.notify_all()
            if event is None:
                return
            if self._closing:
                continue
            try:
                self._call(event)
            except Exception:
                _LOG.exception("a callback of a participant failed")

    def _call(self, event: Event) -> None:
        match event:
            case Arrived(reader, sample):
                target = self._endpoints.get(reader)
                if isinstance(target, DataReader):
                    target.on_sample(sample)
                return
            case Matched(local, remote) | Unmatched(local, remote):
                endpoint = self._endpoints.get(local)
                if endpoint is not None and endpoint.on_match is not None:
                    endpoint.on_match(remote, isinstance(event, Matched))
            case Incompatible(local, remote, policies):
                endpoint = self._endpoints.get(local)
                if endpoint is not None and endpoint.on_incompatible is not None:
                    endpoint.on_incompatible(remote, policies)
        if self._on_event is not None:
            self._on_event(event)


def _checked(topic: str, type_name: str, qos: Qos | None, user_data: bytes) -> Qos:
    """Check what an endpoint is made of; return its policies."""
    _check_name("topic", topic)
    _check_name("type", type_name)
    _check_user_data(user_data)
    if qos is not None and not isinstance(qos, Qos):
        hint = f": Qos(depth={qos}) is one with a depth" if isinstance(qos, int) else ""
        raise TypeError(f"qos is a Qos, not {qos!r}{hint}")
    qos = qos or Qos()
    if qos.durability > Durability.TRANSIENT_LOCAL:
        raise ValueError(f"no writer or reader of firm-hdl is {qos.durability.name}")
    return qos


def _check_name(what: str, name: object, *, least: int = 1) -> None:
    """Check a name. Peers refuse one of too many bytes, with all that is announced beside it."""
    if not isinstance(name, str):
        raise TypeError(f"the name of a {what} is a str, not {name!r}")
    size = len(name.encode())
    if not least <= size <= MOST_NAME_BYTES:
        raise ValueError(
            f"the name of a {what} has from {least} to {MOST_NAME_BYTES} bytes, not {size}"
        )


def _check_user_data(data: object) -> None:
    if not isinstance(data, bytes):
        raise TypeError(f"user data is bytes, not {data!r}")
    if len(data) > MOST_USER_DATA:
        raise ValueError(f"user data has at most {MOST_USER_DATA} bytes, not {len(data)}")
