"""The link in a description: its kinds, their options and limits, and how they are read."""

from __future__ import annotations

import re
from dataclasses import replace
from ipaddress import AddressValueError, IPv4Address, IPv4Interface
from typing import Any

from firm_hdl.node.description import (
    DATAGRAM_BYTES,
    ETHERNETS,
    LINKS,
    NODE_BUS_BYTES,
    Link,
    Topic,
)
from firm_hdl.node.frame import FRAGMENT_UNIT
from firm_hdl.node.marked_yaml import Entry, Marked

__all__ = ["LINK_OPTIONS", "read_link", "with_memory"]

LINK_OPTIONS: dict[str, tuple[str, ...]] = {
    "stream": (),
    "axi_dma": ("memory_bytes", "packets", "buffer_bytes"),
    "udp": (
        *("memory_bytes", "packets", "datagram_bytes", "data_bytes", "port", "host", "host_port"),
        *("ethernet", "mac", "address", "gateway"),
    ),
    "uart": ("memory_bytes", "packets", "baud"),
    "rtps": (
        *("address", "domain", "participant", "static_peers", "peers", "matches"),
        *("memory_bytes", "packets", "datagram_bytes", "ethernet", "mac", "gateway"),
    ),
}
"""The options of each kind of link."""

_LIMITS: dict[str, tuple[int, int]] = {
    "memory_bytes": (64, 1 << 26),
    "packets": (1, 1 << 12),
    "buffer_bytes": (32, 65_520),
    # A datagram of IPv4 has at most 65,507 bytes.
    "datagram_bytes": (32, 65_507),
    "data_bytes": (1, 16),
    "port": (1, 65_535),
    "host_port": (1, 65_535),
    "baud": (1, 100_000_000),
    "domain": (0, 232),
    "participant": (0, 119),
    "peers": (1, 32),
    "matches": (4, 256),
}
"""Least and most of each option."""

_DISCOVERY_BYTES = 1 << 13
"""Memory for datagrams of discovery, of which several come at once."""

_PORTS, _PORTS_PER_DOMAIN, _LAST_PORT = 7411, 250, 65_535
"""Port of user data of participant 0 in domain 0, and the distance to the next domain (RTPS 9.6.1).
Participants have two ports each."""

_LEAST_CYCLES = 4
"""Cycles per bit of a UART: fewer do not find the middle of a bit."""

_MOST_DEVIATION = 0.02
"""How far the rate of the node may be off. Its receiver allows for that, and for 2 % of the other
side besides; what the node sends is off so much."""


def read_link(marked: Marked, entry: Entry, clock_hz: float) -> Link:
    """Read ``link``: the name of a kind, or a mapping with ``kind`` and its options."""
    entries: dict[str, Entry] = {}
    if isinstance(entry.value.value, str):
        kind = entry.choice(LINKS, None)
    else:
        entries = marked.mapping(entry.value, "'link'")
        if "kind" not in entries:
            entry.error_at_key(f"'link' needs a 'kind': {', '.join(LINKS)}")
            return Link(kind="stream")
        kind = entries.pop("kind").choice(LINKS, None)
    if kind is None:
        return Link(kind="stream")
    known = marked.known(entries, LINK_OPTIONS[kind], f"a link of kind '{kind}'")
    given: dict[str, Any] = {"kind": kind}
    for name, (least, most) in _LIMITS.items():
        if name in known:
            given[name] = known[name].integer(least, least, most)
    if "host" in known:
        given["host"] = known["host"].checked(_address_problem)
    elif "host_port" in known:
        known["host_port"].error_at_key("'host_port' counts only beside a 'host'")
    if "ethernet" in known:
        given["ethernet"] = known["ethernet"].choice(ETHERNETS, "stream")
    if given.get("ethernet", "stream") != "stream":
        given |= _read_ethernet(given, known, clock_hz)
    elif "ethernet" not in known or given["ethernet"] == known["ethernet"].value.value:
        for name in ("mac", "gateway") if kind == "rtps" else ("mac", "address", "gateway"):
            if name in known:
                known[name].error_at_key(f"'{name}' counts only beside an 'ethernet' with pins")
    if kind == "rtps":
        given |= _participant(known, entry, given)
    link = Link(**given)
    _check(link, known, entry, clock_hz)
    return link


_LEAST_ETHERNET_HZ = 25e6


def _read_ethernet(
    options: dict[str, Any], known: dict[str, Entry], clock_hz: float
) -> dict[str, str]:
    """Read the addresses of a link with pins, and check what its hardware asks for."""
    kind, place = options["ethernet"], known["ethernet"]
    if clock_hz < _LEAST_ETHERNET_HZ:
        place.error(f"'ethernet: {kind}' needs a 'clock_mhz' of 25 at least")
    for name, most in (("data_bytes", 1), ("datagram_bytes", DATAGRAM_BYTES)):
        if options.get(name, most) > most:
            known[name].error(f"'{name}' is at most {most} with 'ethernet: {kind}'")
    given = {}
    for name, problem in (("mac", _mac_problem), ("address", _interface_problem)):
        if name not in known:
            example = '"02:00:00:00:00:01"' if name == "mac" else "192.168.1.50/24"
            place.error_at_key(f"'ethernet: {kind}' needs '{name}', such as {example}")
        elif text := known[name].checked(problem):
            given[name] = text
    if "gateway" in known and "address" in given:
        own = IPv4Interface(given["address"])

        def problem(text: str) -> str:
            if wrong := _address_problem(text):
                return wrong
            if IPv4Address(text) not in own.network or text == str(own.ip):
                return f"'{text}' is no other machine of {own.network}, the network of 'address'"
            return ""

        given["gateway"] = known["gateway"].checked(problem)
    return given


def _participant(known: dict[str, Entry], entry: Entry, numbers: dict[str, Any]) -> dict[str, Any]:
    """Read the addresses of a participant, and check that it has ports."""
    found: dict[str, Any] = {}
    if numbers.get("ethernet", "stream") == "stream":
        if "address" in known:
            found["address"] = known["address"].checked(_host_problem)
        else:
            entry.error_at_key(
                "a link of kind 'rtps' needs an 'address', the IPv4 address of the node"
            )
    if "static_peers" in known:
        texts = known["static_peers"].texts()
        for problem in filter(None, map(_host_problem, texts)):
            known["static_peers"].error(problem)
        found["static_peers"] = tuple(texts)
    if "packets" not in known:
        # Peers announce their endpoints in bursts.
        found["packets"] = 64
    domain, number = numbers.get("domain", 0), numbers.get("participant", 0)
    if _PORTS + _PORTS_PER_DOMAIN * domain + 2 * number > _LAST_PORT:
        place = known.get("participant", known.get("domain", entry))
        place.error(f"domain {domain} has no UDP ports for participant {number}")
    return found


def _host_problem(text: str) -> str:
    if problem := _address_problem(text):
        return problem
    address = IPv4Address(text)
    is_host = not (address.is_multicast or address.is_unspecified or address.is_reserved)
    return "" if is_host else f"'{text}' is no address of one host"


def _check(link: Link, known: dict[str, Entry], entry: Entry, clock_hz: float) -> None:
    """Check what limits alone do not say."""
    if link.memory_bytes & (link.memory_bytes - 1):
        known["memory_bytes"].error(f"'memory_bytes' must be a power of two: {link.memory_bytes}")
    if link.data_bytes not in NODE_BUS_BYTES:
        known["data_bytes"].error(f"'data_bytes' must be 1, 2, 4, 8 or 16, not {link.data_bytes}")
    if link.frame_bytes is not None and link.frame_bytes % FRAGMENT_UNIT:
        name = "buffer_bytes" if link.kind == "axi_dma" else "datagram_bytes"
        near = link.frame_bytes // FRAGMENT_UNIT * FRAGMENT_UNIT
        known[name].error(f"'{name}' must be a multiple of {FRAGMENT_UNIT}, such as {near}")
    if link.kind == "uart":
        _check_baud(link, known.get("baud", entry), clock_hz)


def _check_baud(link: Link, place: Entry, clock_hz: float) -> None:
    """Check that a bit is a number of cycles, as nearly as a UART needs."""
    mhz = clock_hz / 1e6
    if clock_hz < _LEAST_CYCLES * link.baud:
        place.error(f"a bit takes {_LEAST_CYCLES} cycles at least, which {mhz:g} MHz has not")
        return
    found = clock_hz / round(clock_hz / link.baud)
    if abs(found / link.baud - 1) > _MOST_DEVIATION:
        place.error(
            f"a clock of {mhz:g} MHz gives {found:.0f} baud, which is more than "
            f"{100 * _MOST_DEVIATION:g} % off"
        )


def with_memory(link: Link, topics: list[Topic], entry: Entry | None) -> Link:
    """Give the link's memory the size of the largest one behind it, unless one is named."""
    sizes = [topic.store("in").memory_bytes for topic in topics if topic.has("in")]
    if entry is not None and _names_memory(entry):
        return link
    if link.kind == "rtps":
        # A datagram has more than its message, and those of discovery come to every node.
        return replace(link, memory_bytes=2 * max([_DISCOVERY_BYTES, *sizes]))
    return replace(link, memory_bytes=max([1 << 10, *sizes])) if sizes else link


def _names_memory(entry: Entry) -> bool:
    pairs = entry.value.value
    return not isinstance(pairs, str) and any(key.value == "memory_bytes" for key, _ in pairs)


def _mac_problem(text: str) -> str:
    if not re.fullmatch("[0-9A-Fa-f]{2}(:[0-9A-Fa-f]{2}){5}", text):
        return f"'{text}' is no address of Ethernet, such as 02:00:00:00:00:01"
    if int(text[:2], 16) & 1:
        return f"'{text}' is the address of a group: the lowest bit of its first byte is 1"
    if not int(text.replace(":", ""), 16):
        return f"'{text}' is no address that a machine can have"
    return ""


def _interface_problem(text: str) -> str:
    example = "such as 192.168.1.50/24"
    address, slash, prefix = text.partition("/")
    if wrong := _address_problem(address):
        return wrong
    if not slash or not re.fullmatch("[0-9]{1,2}", prefix) or not 1 <= int(prefix) <= 31:
        return f"'{text}' does not say how many bits are the network's, from 1 to 31, {example}"
    own = IPv4Interface(text)
    edges = (own.network.network_address, own.network.broadcast_address)
    if int(prefix) < 31 and own.ip in edges:
        return f"'{address}' is the address of the whole network {own.network}"
    if own.ip.is_multicast or own.ip.is_reserved or own.ip.is_loopback or int(own.ip) >> 24 == 0:
        return f"'{address}' is no address that a machine on Ethernet can have"
    return ""


def _address_problem(text: str) -> str:
    try:
        IPv4Address(text)
    except AddressValueError:
        return f"'{text}' is not an IPv4 address, such as 192.168.1.10"
    return ""
