"""The reading of one topic of a description: its type, its QoS and its memory."""

from __future__ import annotations

import keyword
import re
from dataclasses import replace
from functools import cache
from typing import Any

from firm_hdl.errors import DefinitionError, Diagnostic
from firm_hdl.frontend import Library
from firm_hdl.metrics import metrics_of
from firm_hdl.model import Action, Interface, Message, Service
from firm_hdl.node.description import Direction, Kind, Link, Qos, Store, Topic
from firm_hdl.node.marked_yaml import Entry, Marked
from firm_hdl.wire import refusals

__all__ = ["TOPIC_KEYS", "TopicReader", "in_keys", "port_of"]

_QOS: dict[str, tuple[str, ...]] = {
    "reliability": ("reliable", "best_effort"),
    "durability": ("volatile", "transient_local"),
    "history": ("keep_last", "keep_all"),
}
_STORE = ("max_message_bytes", "memory_bytes", "packets")
_OF_TOPICS = ("type", "port", *_QOS, "depth", *_STORE, "when_full", "rate_hz")

TOPIC_KEYS: dict[Kind, tuple[str, ...]] = {
    "subscribe": _OF_TOPICS,
    "publish": _OF_TOPICS,
    "serve": ("type", "port", *_STORE, "rate_hz"),
}
"""The keys of a topic, by what the node does with it."""

USUAL_MEMORY_BYTES = 1 << 14
"""Memory of a topic whose messages have no largest size, unless the description names one."""

USUAL_PACKETS = 16

MOST_MEMORY_BYTES = 1 << 26

# Names that Amaranth or Python keep for themselves; see `firm_hdl.gateware.members`.
_RESERVED = frozenset({"signature", "metadata", "elaborate", "clk", "rst", *keyword.kwlist})
_PORT = re.compile(r"[A-Za-z](?:_?[A-Za-z0-9]+)*")


def port_of(
    name: str, entry: Entry | None, topic: Entry, taken: dict[tuple[str, str], str], kind: Kind
) -> str:
    """Name the member of a topic: as the description says, or after the complete name.

    Parameters
    ----------
    entry : Entry or None
        The value of ``port``.
    taken : dict
        The topic of each port in lower case, by kind and port; this one is added.
    """
    place = topic.error_at_key if entry is None else entry.error
    # A port is part of names in VHDL, which has neither '__' nor an underscore at either end.
    port = "_".join(re.findall("[A-Za-z0-9]+", name)) if entry is None else entry.text("port")
    hint = "; name one with 'port'" if entry is None else ""
    if not _PORT.fullmatch(port):
        rule = "letters, digits and single underscores, a letter first and no underscore last"
        place(f"'{port}' cannot be the name of a port, which has {rule}{hint}")
    elif port in _RESERVED:
        place(f"'{port}' cannot be the name of a port, because Python or Amaranth use it{hint}")
    elif (kind, port.lower()) in taken:
        other = taken[kind, port.lower()]
        place(f"the port '{port}' is already that of '{other}'{hint}")
    taken.setdefault((kind, port.lower()), name)
    return port


class TopicReader:
    """Read the options of topics.

    Parameters
    ----------
    library : Library
        The definitions of all types.
    bus_bytes : int
    link : Link
        It decides whether a subscription may hold what comes.
    """

    def __init__(self, marked: Marked, library: Library, bus_bytes: int, link: Link) -> None:
        self.marked, self.library, self.bus_bytes, self.link = marked, library, bus_bytes, link
        # Many topics may have one type.
        self._metrics_of, self._hash_of = cache(metrics_of), cache(library.definition_hash)

    def topic(
        self,
        entry: Entry,
        options: dict[str, Entry],
        kind: Kind,
        name: str,
        written: str,
        port: str,
        number: int,
    ) -> Topic | None:
        """Read a topic; `None` if it has no type that can be used."""
        if "type" not in options:
            entry.error_at_key(f"'{written}' has no 'type'")
            return None
        interface = self._interface(options["type"], kind)
        qos = self._qos(options)
        if interface is None:
            return None
        stores = tuple(
            (direction, store)
            for direction, message in _directions(kind, interface)
            if (store := self._store(message, direction, kind, options)) is not None
        )
        rate = options["rate_hz"].number(None, 1e-3, 1e9) if "rate_hz" in options else None
        return Topic(
            id=number,
            kind=kind,
            name=name,
            written=written,
            port=port,
            type=interface.name,
            definition_hash=self._hash_of(interface),
            stores=stores,
            qos=qos,
            rate_hz=rate,
            span=self.marked.span(entry.key),
        )

    def _interface(self, entry: Entry, kind: Kind) -> Interface | None:
        name = entry.text()
        if not name:
            return None
        try:
            found = self.library.interface(name)
        except DefinitionError as error:
            # What is wrong in a definition has its own place; a type that is not there has none.
            for problem in map(in_keys, error.diagnostics):
                if problem.span is None:
                    entry.error(problem.message)
                else:
                    self.marked.note(problem)
            return None
        if kind == "serve" and not isinstance(found, Service):
            what = "an action" if isinstance(found, Action) else "a message"
            entry.error(f"'{found.name}' is {what}, and a service is served")
            return None
        if kind != "serve" and not isinstance(found, Message):
            what = "an action" if isinstance(found, Action) else "a service"
            where = "; put it below 'serve'" if isinstance(found, Service) else ""
            entry.error(f"'{found.name}' is {what}, and a topic has a message{where}")
            return None
        wrong = [each for _, message in _directions(kind, found) for each in refusals(message)]
        for problem in wrong:
            self.marked.note(problem)
        return None if wrong else found

    def _qos(self, options: dict[str, Entry]) -> Qos:
        given: dict[str, Any] = {}
        for name, choices in _QOS.items():
            if name not in options:
                continue
            if self.library.dialect == "ros1" and name != "durability":
                options[name].error_at_key(f"ROS 1 has no '{name}'")
            given[name] = options[name].choice(choices, choices[0])
        if "depth" in options:
            given["depth"] = options["depth"].integer(10, 1, 1 << 20)
        return Qos(**given)

    def _store(
        self, message: Message, direction: Direction, kind: Kind, options: dict[str, Entry]
    ) -> Store | None:
        figures = self._metrics_of(message)
        least, most = figures.min_bytes or 0, figures.max_bytes
        memory = _memory_bytes(least, most, self.bus_bytes)
        if "memory_bytes" in options:
            entry = options["memory_bytes"]
            memory = entry.integer(memory, 2 * self.bus_bytes, MOST_MEMORY_BYTES)
            if memory & (memory - 1):
                entry.error(f"'memory_bytes' must be a power of two, not {memory}")
                return None
        if memory < least:
            place = options.get("memory_bytes", options["type"])
            place.error(f"a {message.name} has {least} bytes at least, and the memory has {memory}")
            return None
        # Longer packets have no room, so lengths beyond the memory need not be judged.
        longest = max(least, memory)
        if "max_message_bytes" in options:
            entry = options["max_message_bytes"]
            longest = entry.integer(longest, max(1, least), (1 << 32) - 1)
        packets = USUAL_PACKETS
        if "packets" in options:
            packets = options["packets"].integer(packets, 1, 1 << 12)
        return Store(
            message=message,
            max_message_bytes=longest,
            memory_bytes=memory,
            packets=packets,
            when_full=self._when_full(options.get("when_full"), kind, direction),
        )

    def _when_full(self, entry: Entry | None, kind: Kind, direction: Direction) -> Any:
        # A subscription that waits would hold the packets of all others, which come by one router.
        usual = "drop" if direction == "in" else "wait"
        if entry is None:
            return usual
        policy = entry.choice(("wait", "drop"), usual)
        if policy == "wait" and kind == "subscribe" and self.link.kind != "stream":
            entry.error(f"a link of kind '{self.link.kind}' cannot be held; use 'drop'")
        return policy


def in_keys(problem: Diagnostic) -> Diagnostic:
    """Name keys of a description where a problem of its definitions names options of commands."""
    message = problem.message.replace("--depends", "'paths'").replace("--distro", "'distro'")
    return replace(problem, message=message)


def _directions(kind: Kind, interface: Interface) -> tuple[tuple[Direction, Message], ...]:
    """List the messages of a topic, with the way that they go."""
    if isinstance(interface, Service):
        return ("in", interface.request), ("out", interface.response)
    assert isinstance(interface, Message)
    return (("in" if kind == "subscribe" else "out", interface),)


def _memory_bytes(least: int, most: int | None, bus_bytes: int) -> int:
    """Choose a memory: for two of the largest messages, if that is not too much."""
    room = min(2 * most, USUAL_MEMORY_BYTES) if most is not None else USUAL_MEMORY_BYTES
    wanted = max(room, 2 * least, 64, 2 * bus_bytes)
    return min(1 << (wanted - 1).bit_length(), MOST_MEMORY_BYTES)
