"""Addresses of peers (8.3.5.10, 9.3.2) and the well-known ports (9.6.1)."""

from __future__ import annotations

import socket
import struct
from collections.abc import Iterable
from typing import NamedTuple

from firm_hdl.rtps.wire.octets import Cursor

__all__ = ["MULTICAST_GROUP", "Address", "Ports", "decode", "distance", "encode"]

MULTICAST_GROUP = "239.255.0.1"
"""The group of SPDP announcements (9.6.1.4.1)."""

_UDP_V4 = 1
# Parameters of 9.6.1.1: base, gain of the domain, gain of the participant, offsets.
_PB, _DG, _PG, _D0, _D1, _D3 = 7400, 250, 2, 0, 10, 11
_MAX_DOMAIN = 232
_MOST_ADDRESSES = 16
# Participants of a domain on one host: all their ports are below those of the next domain.
_MOST_PARTICIPANTS = 120


class Address(NamedTuple):
    """An IPv4 address, in dotted form, and a UDP port."""

    host: str
    port: int


class Ports(NamedTuple):
    """The well-known ports of a participant (9.6.1.1)."""

    # Port of SPDP announcements to the group, the same for all participants of a domain.
    discovery_multicast: int
    # Unicast ports of discovery, and of user data.
    discovery: int
    user: int

    @classmethod
    def of(cls, domain: int, participant: int) -> Ports:
        """Return the ports of participant number `participant` of a domain.

        Raises
        ------
        ValueError
            `domain` is not from 0 to 232, or the ports would be beyond 65,535.
        """
        if not 0 <= domain <= _MAX_DOMAIN:
            raise ValueError(f"Domain must be from 0 to {_MAX_DOMAIN}, not {domain}")
        base = _PB + _DG * domain
        ports = cls(base + _D0, base + _D1 + _PG * participant, base + _D3 + _PG * participant)
        if ports.user > 0xFFFF:
            raise ValueError(f"Domain {domain} has no ports for participant {participant}")
        return ports

    @classmethod
    def all_of(cls, domain: int) -> tuple[Ports, ...]:
        """Return the ports of all participants that a domain may have on one host."""
        most = min(_MOST_PARTICIPANTS, (0xFFFF - cls.of(domain, 0).user) // _PG + 1)
        return tuple(cls.of(domain, number) for number in range(most))


def encode(address: Address) -> bytes:
    """Return the 24 bytes of a locator, little-endian."""
    return struct.pack("<iI12x", _UDP_V4, address.port) + socket.inet_aton(address.host)


def decode(values: Iterable[Cursor]) -> tuple[Address, ...]:
    """Read locators, without those of other transports, such as shared memory or IPv6.

    A host has an address per interface. More than 16 are left out.
    """
    found: dict[Address, None] = {}
    for value in values:
        kind, port = value.i32(), value.u32()
        address = value.take(16)
        host = socket.inet_ntoa(address[12:])
        if kind == _UDP_V4 and 0 < port <= 0xFFFF and host != "0.0.0.0" and _is_unicast(host):
            found[Address(host, port)] = None
    return tuple(found)[:_MOST_ADDRESSES]


def distance(address: Address, own: str) -> int:
    """Return how far an address is from the interface `own`.

    A peer announces an address per interface, and may announce one of its loopback interface. The
    one that has the most leading bits in common with ours is on our network, or on our host.
    """
    return _number(own) ^ _number(address.host)


def _number(host: str) -> int:
    return int.from_bytes(socket.inet_aton(host), "big")


def _is_unicast(host: str) -> bool:
    return _number(host) >> 28 < 0xE
