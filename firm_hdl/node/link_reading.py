"""The reading of a description's link."""

from __future__ import annotations

from dataclasses import replace
from ipaddress import AddressValueError, IPv4Address
from typing import Any

from firm_hdl.node.description import LINKS, Link, Topic
from firm_hdl.node.marked_yaml import Entry, Marked
from firm_hdl.plan import BUS_BYTES

__all__ = ["LINK_OPTIONS", "NODE_BUS_BYTES", "read_link", "with_memory"]

NODE_BUS_BYTES = tuple(width for width in BUS_BYTES if width <= 16)
"""Bus widths of a node: the header of a frame, 16 bytes, has to fill whole beats."""

LINK_OPTIONS: dict[str, tuple[str, ...]] = {
    "stream": (),
    "udp": ("memory_bytes", "packets", "datagram_bytes", "data_bytes", "port", "host", "host_port"),
    "uart": ("memory_bytes", "packets", "baud"),
}
"""The options of each kind of link."""

_LIMITS: dict[str, tuple[int, int]] = {
    "memory_bytes": (64, 1 << 26),
    "packets": (1, 1 << 12),
    # A datagram of IPv4 has at most 65,507 bytes.
    "datagram_bytes": (32, 65_507),
    "data_bytes": (1, 16),
    "port": (1, 65_535),
    "host_port": (1, 65_535),
    "baud": (1, 100_000_000),
}
"""Least and most of each option."""

_LEAST_CYCLES = 4
"""Cycles per bit of a UART: fewer do not find the middle of a bit."""

_MOST_DEVIATION = 0.02
"""After 10 bits, both sides together may be half a bit off: 5 %. The other side needs a part."""


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
    link = Link(**given)
    _check(link, known, entry, clock_hz)
    return link


def _check(link: Link, known: dict[str, Entry], entry: Entry, clock_hz: float) -> None:
    """Check what limits alone do not say."""
    if link.memory_bytes & (link.memory_bytes - 1):
        known["memory_bytes"].error(f"'memory_bytes' must be a power of two: {link.memory_bytes}")
    if link.data_bytes not in NODE_BUS_BYTES:
        known["data_bytes"].error(f"'data_bytes' must be 1, 2, 4, 8 or 16, not {link.data_bytes}")
    if link.datagram_bytes % 16:
        near = link.datagram_bytes // 16 * 16
        known["datagram_bytes"].error(f"'datagram_bytes' must be a multiple of 16, such as {near}")
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
    stores = [store for topic in topics if (store := topic.store("in")) is not None]
    if not stores or (entry is not None and _names_memory(entry)):
        return link
    return replace(link, memory_bytes=max(1 << 10, *(each.memory_bytes for each in stores)))


def _names_memory(entry: Entry) -> bool:
    pairs = entry.value.value
    return not isinstance(pairs, str) and any(key.value == "memory_bytes" for key, _ in pairs)


def _address_problem(text: str) -> str:
    try:
        IPv4Address(text)
    except AddressValueError:
        return f"'{text}' is not an IPv4 address, such as 192.168.1.10"
    return ""
