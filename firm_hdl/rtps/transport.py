"""UDP sockets of a participant: discovery by multicast and unicast, and user data (9.6.1)."""

from __future__ import annotations

import errno
import socket
import struct
import sys
from collections.abc import Iterator
from contextlib import suppress

from firm_hdl.rtps.wire.locators import MULTICAST_GROUP, Address, Ports

__all__ = ["Transport", "TransportError", "address_of"]

# Linux, <linux/in.h>: whether a socket gets multicast that other sockets have joined.
_IP_MULTICAST_ALL = 49
# Linux, <linux/sockios.h>: the IPv4 address of an interface.
_SIOCGIFADDR = 0x8915
# Linux, <linux/if.h>: IFNAMSIZ, without the final zero.
_MOST_INTERFACE_BYTES = 15
_RECEIVE_BUFFER_BYTES = 4 << 20


class TransportError(Exception):
    """Sockets cannot be opened, or an interface has no address."""


def address_of(interface: str | None) -> str:
    """Return the IPv4 address of an interface.

    * `interface`: the name of an interface, such as ``"eth0"``; an IPv4 address, which is returned;
      or `None` for the interface that multicast goes to by default, or else the loopback interface.

    Raises `TransportError`: there is no such interface, or it has no IPv4 address.
    """
    if interface is None:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                # Nothing is sent; the system only chooses the way.
                probe.connect((MULTICAST_GROUP, 7400))
            except OSError:
                return "127.0.0.1"
            return str(probe.getsockname()[0])
    # A name with a NUL is a `ValueError`.
    with suppress(OSError, ValueError):
        return socket.inet_ntoa(socket.inet_pton(socket.AF_INET, interface))
    name = interface.encode()
    # The system would take the first bytes for the name of another interface.
    if len(name) > _MOST_INTERFACE_BYTES or b"\0" in name:
        raise TransportError(f"interface '{interface}' has no IPv4 address")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            # Only systems with interfaces of this kind have the module.
            import fcntl

            request = struct.pack("256s", name)
            return socket.inet_ntoa(fcntl.ioctl(probe, _SIOCGIFADDR, request)[20:24])
        except (OSError, ImportError) as problem:
            raise TransportError(f"interface '{interface}' has no IPv4 address") from problem


class Transport:
    """The sockets of a participant.

    * `domain`: the domain, from 0 to 232, which the ports follow from.
    * `host`: IPv4 address of the interface.

    Raises `TransportError`: the address is not one of this host, or no ports are free.
    """

    def __init__(self, domain: int, host: str):
        self.host = host
        # The number of the participant on this host: the lowest one whose ports are free.
        self.participant, self._unicast = _bind_unicast(domain, host)
        ports = Ports.of(domain, self.participant)
        # Where this participant is reached.
        self.discovery = Address(host, ports.discovery)
        self.user = Address(host, ports.user)
        self.group = Address(MULTICAST_GROUP, ports.discovery_multicast)
        try:
            self._multicast = _bind_multicast(self.group, host)
        except OSError as problem:
            for each in self._unicast:
                each.close()
            raise TransportError(f"no multicast on {host}: {problem}") from problem

    @property
    def sockets(self) -> tuple[socket.socket, ...]:
        """All sockets, for a selector. None of them blocks."""
        return (self._multicast, *self._unicast)

    def send(self, address: Address, datagram: bytes) -> bool:
        """Send a datagram. Return `False` if the system cannot take it now.

        Other errors, such as an address without a way to it, are those of a lost datagram.
        """
        try:
            self._unicast[0].sendto(datagram, address)
        except BlockingIOError:
            return False
        except OSError:
            return True
        return True

    def receive(self, source: socket.socket, limit: int = 64) -> Iterator[tuple[bytes, str]]:
        """Yield the datagrams that wait at a socket, at most `limit`, and where they come from."""
        for _ in range(limit):
            try:
                datagram, address = source.recvfrom(65536)
                yield datagram, address[0]
            except BlockingIOError:
                return
            except OSError:
                # Such as "connection refused", which is about a datagram that was sent.
                continue

    def close(self) -> None:
        """Close all sockets."""
        for each in self.sockets:
            each.close()


def _bind_unicast(domain: int, host: str) -> tuple[int, tuple[socket.socket, socket.socket]]:
    """Return the lowest free number of a participant, and its sockets."""
    every = Ports.all_of(domain)
    for participant, ports in enumerate(every):
        discovery, user = _socket(), _socket()
        try:
            discovery.bind((host, ports.discovery))
            user.bind((host, ports.user))
            discovery.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton(host))
            discovery.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_LOOP, 1)
            return participant, (discovery, user)
        except OSError as problem:
            discovery.close()
            user.close()
            if problem.errno != errno.EADDRINUSE:
                raise TransportError(f"no sockets on {host}: {problem}") from problem
    raise TransportError(f"all {len(every)} participants of domain {domain} are there")


def _bind_multicast(group: Address, host: str) -> socket.socket:
    """Return a socket that receives the group's datagrams of one interface."""
    multicast = _socket()
    try:
        # All participants of a host have this port. Some set the one option, some the other.
        multicast.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        if hasattr(socket, "SO_REUSEPORT"):
            multicast.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        multicast.bind(("", group.port))
        member = socket.inet_aton(group.host) + socket.inet_aton(host)
        multicast.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, member)
        if sys.platform == "linux":
            multicast.setsockopt(socket.IPPROTO_IP, _IP_MULTICAST_ALL, 0)
    except OSError:
        multicast.close()
        raise
    return multicast


def _socket() -> socket.socket:
    made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    made.setblocking(False)
    # The system takes less if this is more than it allows.
    with suppress(OSError):
        made.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _RECEIVE_BUFFER_BYTES)
    return made
