"""From the text of a description to its value; every mistake has its line and a caret."""

from __future__ import annotations

import keyword
import os
import re
from codecs import BOM_UTF8
from collections.abc import Iterable
from dataclasses import replace
from difflib import get_close_matches
from functools import cache
from ipaddress import AddressValueError, IPv4Address, IPv4Interface
from pathlib import Path
from typing import Any

import yaml

from firm_hdl.errors import DefinitionError, Diagnostic, Source, Span
from firm_hdl.files import read_file
from firm_hdl.frontend import DEFAULT_DISTRO, DISTROS, Library, open_library
from firm_hdl.metrics import metrics_of
from firm_hdl.model import WIRE_OF, Action, Interface, Message, Service
from firm_hdl.names.keywords import KEYWORDS
from firm_hdl.node.description import (
    DATAGRAM_BYTES,
    ETHERNETS,
    LINKS,
    Description,
    Direction,
    Hdl,
    IoPins,
    Kind,
    Link,
    Store,
    Topic,
    TopicQos,
)
from firm_hdl.node.marked_yaml import Entry, Marked, parse
from firm_hdl.node.names import (
    MOST_TOPIC_CHARACTERS,
    expand,
    namespace_problem,
    node_problem,
    topic_problem,
)
from firm_hdl.plan import BUS_BYTES
from firm_hdl.wire import refusals

__all__ = ["LINK_OPTIONS", "NODE_BUS_BYTES", "read_description", "read_description_text"]

MOST_BYTES = 1 << 18
"""Largest file that is read: a thousand topics need less."""

MOST_COMPARED = 1000
"""Most pairs of names that are compared to find out what the user means."""

KINDS: tuple[Kind, ...] = ("subscribe", "publish", "serve")

_KEYS = ("node", "namespace", "distro", "paths", "bags", "bus_bytes", "clock_mhz", "link", "remap")
KEYS = (*_KEYS, *KINDS, "accelerator", "pins")

LANGUAGES = ("vhdl", "verilog", "systemverilog")

_LANGUAGE_OF = {
    ".vhd": "vhdl",
    ".vhdl": "vhdl",
    ".v": "verilog",
    ".sv": "systemverilog",
}


def read_description(
    path: str | os.PathLike[str],
    *,
    paths: Iterable[str | os.PathLike[str]] = (),
    library: Library | None = None,
) -> Description:
    """Read the description of a node.

    Parameters
    ----------
    path : str or path
        A file in YAML; ``docs/reference/node.md`` describes it.
    paths : iterable of str or path
        Folders with ROS packages, searched before those that the file names.
    library : Library or None
        Definitions to use in place of those that the file and the environment name.

    Raises
    ------
    DefinitionError
        With all mistakes that were found, also those in definitions of types.
    """
    name = os.fspath(path)
    try:
        data = read_file(path, MOST_BYTES).removeprefix(BOM_UTF8)
    except OSError as error:
        message = f"cannot read '{name}': {error.strerror or error}"
        raise DefinitionError([Diagnostic(message=message)]) from None
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        source = Source(name=name, text=data.decode("utf-8", "replace"))
        at = len(data[: error.start].decode("utf-8"))
        message = f"byte 0x{data[error.start]:02x} is not UTF-8 text"
        span = Span(source=source, start=at, end=at + 1)
        raise DefinitionError([Diagnostic(message=message, span=span)]) from None
    folder = str(Path(name).parent)
    return read_description_text(text, name=name, folder=folder, paths=paths, library=library)


def read_description_text(
    text: str,
    *,
    name: str = "<description>",
    folder: str = ".",
    paths: Iterable[str | os.PathLike[str]] = (),
    library: Library | None = None,
) -> Description:
    """Read the text of a description; `folder` is the one that its paths are relative to.

    The other parameters and the errors are those of :func:`read_description`.
    """
    # As universal newlines of Python: a carriage return is no part of a caret's line.
    marked, node = parse(Source(name=name, text=text.replace("\r\n", "\n")))
    entries = marked.mapping(node, "a description")
    if not entries:
        # What is no mapping has no keys that could be missing.
        marked.check()
    return _Reader(marked, folder, list(paths), library).read(entries)


class _Reader:
    """The reading of one description."""

    def __init__(
        self,
        marked: Marked,
        folder: str,
        paths: list[str | os.PathLike[str]],
        library: Library | None,
    ) -> None:
        self.marked, self.folder, self.paths = marked, folder, paths
        self.library = library
        self.renamed: dict[str, Entry] = {}

    def read(self, entries: dict[str, Entry]) -> Description:
        known = self.marked.known(entries, KEYS, "a description")
        library = self._library(known)
        dialect = library.dialect
        given: dict[str, Any] = {}
        if "node" not in known:
            self.marked.error_at_start("a description needs a 'node', the name of the node")
        else:
            given["node"] = known["node"].checked(lambda t: node_problem(t, dialect), "node")
        if "namespace" in known:
            given["namespace"] = known["namespace"].checked(
                lambda t: namespace_problem(t, dialect), "/"
            )
        bus_bytes = 8
        if "bus_bytes" in known:
            bus_bytes = self._bus_bytes(known["bus_bytes"])
        clock_hz = 100e6
        if "clock_mhz" in known:
            clock_hz = 1e6 * known["clock_mhz"].number(100.0, 1.0, 1000.0)
        link = Link(kind="stream")
        if "link" in known:
            link = read_link(self.marked, known["link"], clock_hz)
        names = _Names(given.get("namespace", "/"), given.get("node", "node"), {})
        if "remap" in known:
            names.remap = self._remap(known["remap"], library, names)
        if link.kind == "rtps" and dialect == "ros1":
            known["link"].error("a link of kind 'rtps' is for ROS 2")
        topics = self._topics(known, library, names, bus_bytes, link)
        self._check_remap(names)
        if not topics and not self.marked.noted:
            self.marked.error_at_start(f"a node needs a topic: {', '.join(KINDS)}")
        accelerator, hdl = "", None
        if "accelerator" in known:
            accelerator, hdl = self._accelerator(known["accelerator"])
        pins = self._pins(known["pins"]) if "pins" in known else ()
        if pins and "accelerator" not in known:
            known["pins"].error_at_key("'pins' are those of an accelerator, which is not there")
        self.marked.check()

        def span(key: str) -> Span | None:
            return self.marked.span(known[key].value) if key in known else None

        return Description(
            **given,
            distro=library.distro,
            wire=WIRE_OF[dialect],
            bus_bytes=bus_bytes,
            clock_hz=clock_hz,
            link=with_memory(link, topics, known.get("link")),
            topics=tuple(topics),
            accelerator=accelerator,
            hdl=hdl,
            pins=pins,
            folder=self.folder,
            accelerator_span=span("accelerator") if accelerator else None,
            clock_span=span("clock_mhz"),
            link_span=span("link"),
            node_span=span("node"),
        )

    def _accelerator(self, entry: Entry) -> tuple[str, Hdl | None]:
        """Read the name of a class, or the files of an accelerator in another language."""
        if not isinstance(entry.value, yaml.MappingNode):
            return entry.checked(_class_problem), None
        marked = self.marked
        given = marked.mapping(entry.value, "'accelerator'")
        known = marked.known(given, (*LANGUAGES, "entity"), "an accelerator")
        languages = [each for each in known.values() if each.name in LANGUAGES]
        if len(languages) != 1:
            if given.keys() <= known.keys():
                entry.error(f"an accelerator has the files of one of {', '.join(LANGUAGES)}")
            return "", None
        (language,) = languages
        files = language.texts()
        for file in files:
            other = _LANGUAGE_OF.get(os.path.splitext(file)[1].lower(), "")
            if problem := _path_problem(file):
                language.error(problem)
            elif other and (other == "vhdl") != (language.name == "vhdl"):
                language.error(f"'{file}' ends as files of {other} do: write '{other}' as the key")
        if not files:
            language.error(f"'{language.name}' has no file")
            return "", None
        entity = os.path.splitext(os.path.basename(files[-1]))[0]
        if "entity" in known:
            entity = known["entity"].checked(_entity_problem)
        elif problem := _entity_problem(entity):
            language.error(f"{problem}: name the 'entity'")
        hdl = Hdl(language=language.name, files=tuple(files), entity=entity)  # type: ignore[arg-type]
        return f"{entity} ({', '.join(files)})", hdl

    def _pins(self, entry: Entry) -> tuple[IoPins, ...]:
        """Read the pins of the members of an accelerator; which there are is up to the board."""
        found: list[IoPins] = []
        owners: dict[str, str] = {}
        for name, each in self.marked.mapping(entry.value, "'pins'", "{pwm: [A4, B5]}").items():
            words = each.words()
            for pin, span in words:
                if pin in owners:
                    message = f"the pin '{pin}' is already that of '{owners[pin]}'"
                    self.marked.note(Diagnostic(message=message, span=span))
                owners[pin] = name
            pins, spans = tuple(word for word, _ in words), tuple(span for _, span in words)
            place = self.marked.span(each.key)
            found.append(IoPins(name=name, pins=pins, span=place, spans=spans))
        return tuple(found)

    def _library(self, known: dict[str, Entry]) -> Library:
        """Open the definitions; without them, no type can be checked, so errors are final."""
        distro = (
            known["distro"].choice(list(DISTROS), DEFAULT_DISTRO) if "distro" in known else None
        )
        if self.library is not None:
            if distro not in (None, self.library.distro):
                known["distro"].error(f"the types are those of {self.library.distro}")
            return self.library
        named = self._places(known["paths"]) if "paths" in known else []
        bags = self._places(known["bags"]) if "bags" in known else []
        try:
            return open_library(distro, [*self.paths, *named], bags)
        except DefinitionError as error:
            for problem in map(in_keys, error.diagnostics):
                # A folder or a recording that cannot be read has no place of its own.
                is_of_bags = any(f"'{bag}'" in problem.message for bag in bags)
                entry = known.get("bags" if is_of_bags or not named else "paths")
                if entry is None or problem.span is not None:
                    self.marked.note(problem)
                else:
                    entry.error(problem.message)
            self.marked.check()
            raise

    def _places(self, entry: Entry) -> list[str]:
        """Return the paths of files or folders, which are relative to the description."""
        texts = entry.texts()
        for text in texts:
            if problem := _path_problem(text):
                entry.error(problem)
        self.marked.check()
        return [os.path.normpath(os.path.join(self.folder, text)) for text in texts]

    def _bus_bytes(self, entry: Entry) -> int:
        width = entry.integer(8, 1)
        if width not in NODE_BUS_BYTES:
            *others, last = map(str, NODE_BUS_BYTES)
            entry.error(f"'bus_bytes' must be {', '.join(others)} or {last}, not {width}")
            return 8
        return width

    def _remap(self, entry: Entry, library: Library, names: _Names) -> dict[str, str]:
        remap: dict[str, str] = {}
        for name, each in self.marked.mapping(entry.value, "'remap'").items():
            if problem := topic_problem(name, library.dialect):
                each.error_at_key(problem)
                continue
            new = each.checked(lambda text: topic_problem(text, library.dialect))
            if new:
                remap[names.complete(name)] = names.complete(new)
                self.renamed[names.complete(name)] = each
        return remap

    def _check_remap(self, names: _Names) -> None:
        """Report remappings of names that no topic has: nobody else could use them."""
        unused = [name for name in self.renamed if name not in names.used]
        # To compare two names can take ten milliseconds.
        is_quick = len(unused) * len(names.used) <= MOST_COMPARED
        for name in unused:
            is_name = len(name) <= MOST_TOPIC_CHARACTERS
            close = get_close_matches(name, names.used, n=1) if is_quick and is_name else []
            hint = f"; did you mean '{close[0]}'?" if close else ""
            self.renamed[name].error_at_key(f"no topic has the name '{name}'{hint}")

    def _topics(
        self,
        known: dict[str, Entry],
        library: Library,
        names: _Names,
        bus_bytes: int,
        link: Link,
    ) -> list[Topic]:
        reader = TopicReader(self.marked, library, bus_bytes, link)
        topics: list[Topic] = []
        places: dict[tuple[str, str], str] = {}
        ports: dict[tuple[str, str], str] = {}
        types: dict[str, Topic] = {}
        # The place in the text is the id, so sections count in the order in which they are written.
        for section in (entry for name, entry in known.items() if name in KINDS):
            kind: Kind = section.name  # type: ignore[assignment]
            for written, entry in self.marked.mapping(section.value, f"'{kind}'").items():
                name = self._name(entry, written, library, names)
                before = self.marked.noted
                keys = self.marked.mapping(entry.value, f"'{written}'", "{type: std_msgs/msg/Bool}")
                if not keys and self.marked.noted > before:
                    continue
                options = self.marked.known(keys, TOPIC_KEYS[kind], f"a topic of '{kind}'")
                if (name, kind) in places:
                    entry.error_at_key(f"'{name}' is already there, as '{places[name, kind]}'")
                places[name, kind] = written
                port = port_of(name, options.get("port"), entry, ports, kind)
                topic = reader.topic(entry, options, kind, name, written, port, 1 + len(topics))
                if topic is not None:
                    topics.append(topic)
                    if kind != "serve":
                        _check_type(topic, types.setdefault(name, topic), options["type"])
        return topics

    def _name(self, entry: Entry, written: str, library: Library, names: _Names) -> str:
        """Complete and check the name of a topic; an unusable one is returned as it is."""
        if problem := topic_problem(written, library.dialect):
            entry.error_at_key(problem)
            return written
        name = names.final(written)
        if len(name) > MOST_TOPIC_CHARACTERS:
            most = f"at most {MOST_TOPIC_CHARACTERS} characters, not {len(name)}"
            entry.error_at_key(f"the complete name of a topic has {most}")
        return name


class _Names:
    """How names of topics are completed and remapped."""

    def __init__(self, namespace: str, node: str, remap: dict[str, str]) -> None:
        self.namespace, self.node, self.remap = namespace, node, remap
        self.used: set[str] = set()

    def complete(self, name: str) -> str:
        return expand(name, self.namespace, self.node)

    def final(self, name: str) -> str:
        complete = self.complete(name)
        self.used.add(complete)
        return self.remap.get(complete, complete)


def _check_type(topic: Topic, first: Topic, entry: Entry) -> None:
    """Check that a topic has the type that it has where the description names it first."""
    if topic.type != first.type:
        assert first.span is not None
        where = f"'{first.written}' in line {first.span.line}"
        entry.error(
            f"the topic '{topic.name}' has the type '{first.type}' already ({where}); a topic has "
            "one type"
        )


def _path_problem(text: str) -> str:
    try:
        is_path = b"\0" not in os.fsencode(text)
    except UnicodeEncodeError:
        # An escape can stand for half a character.
        is_path = False
    return "" if is_path else f"{text!r} is not a path"


def _class_problem(text: str) -> str:
    module, colon, name = text.partition(":")
    words = [*module.split("."), *name.split(".")]
    if not colon or not all(word.isidentifier() for word in words) or len(text) > 255:
        return (
            "an accelerator is named as 'module:Class', such as 'wheels.core:Wheels', or as "
            "{vhdl: wheels.vhd, entity: wheels}"
        )
    return ""


def _entity_problem(text: str) -> str:
    if text.lower() in KEYWORDS:
        return f"'{text}' is a keyword of VHDL or SystemVerilog"
    if text.lower().startswith("firm_hdl_"):
        return f"'{text}' is a name as of firm-hdl's own units; give the entity another"
    is_name = re.fullmatch("[A-Za-z][A-Za-z0-9_]*", text) and len(text) <= 255
    return "" if is_name else f"'{text}' is no name of an entity or a module"


NODE_BUS_BYTES = tuple(width for width in BUS_BYTES if width <= 16)
"""Bus widths of a node: the header of a frame, 16 bytes, has to fill whole beats."""

LINK_OPTIONS: dict[str, tuple[str, ...]] = {
    "stream": (),
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
    if link.kind == "udp" and link.datagram_bytes % 16:
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

_SAMPLES_BYTES = 1 << 11
"""Least memory of a topic whose link is a participant, unless the description names one."""

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

    def _qos(self, options: dict[str, Entry]) -> TopicQos:
        given: dict[str, Any] = {}
        for name, choices in _QOS.items():
            if name not in options:
                continue
            if self.library.dialect == "ros1" and name != "durability":
                options[name].error_at_key(f"ROS 1 has no '{name}'")
            given[name] = options[name].choice(choices, choices[0])
        if "depth" in options:
            given["depth"] = options["depth"].integer(10, 1, 1 << 20)
        return TopicQos(**given)

    def _store(
        self, message: Message, direction: Direction, kind: Kind, options: dict[str, Entry]
    ) -> Store | None:
        figures = self._metrics_of(message)
        least, most = figures.min_bytes or 0, figures.max_bytes
        memory = _memory_bytes(least, most, self.bus_bytes)
        if self.link.kind == "rtps":
            # Several samples come in one datagram, and several are kept for those who miss them.
            memory = max(memory, _SAMPLES_BYTES)
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
