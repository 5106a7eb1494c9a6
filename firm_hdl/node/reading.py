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
    NODE_BUS_BYTES,
    REGISTER_BUSES,
    Description,
    Hdl,
    IoPins,
    Kind,
    Link,
    Store,
    Topic,
    TopicQos,
    Way,
)
from firm_hdl.node.link_options import read_link, with_memory
from firm_hdl.node.marked_yaml import Entry, Marked, parse
from firm_hdl.node.names import (
    MOST_TOPIC_CHARACTERS,
    expand,
    namespace_problem,
    node_problem,
    topic_problem,
)
from firm_hdl.wire import refusals

__all__ = ["read_description", "read_description_text"]

MOST_BYTES = 1 << 18
"""Largest file that is read: a thousand topics need less."""

MOST_COMPARED = 1000
"""Most pairs of names that are compared to find out what the user means."""

KINDS: tuple[Kind, ...] = ("subscribe", "publish", "serve")

_KEYS = ("node", "namespace", "distro", "paths", "bags", "bus_bytes", "clock_mhz", "link", "remap")
KEYS = (*_KEYS, *KINDS, "accelerator", "registers", "pins")

LANGUAGES = ("vhdl", "verilog", "systemverilog")

PORTS = ("plain", "records", "structs")
"""Kinds of the ports of an accelerator; SystemVerilog's word for records is structs."""

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
        bus: Any = known["registers"].choice(REGISTER_BUSES, "") if "registers" in known else ""
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
            registers=bus,
            pins=pins,
            folder=self.folder,
            accelerator_span=span("accelerator") if accelerator else None,
            clock_span=span("clock_mhz"),
            link_span=span("link"),
            node_span=span("node"),
            registers_span=span("registers"),
        )

    def _accelerator(self, entry: Entry) -> tuple[str, Hdl | None]:
        """Read the name of a class, or the files of an accelerator in another language."""
        if not isinstance(entry.value, yaml.MappingNode):
            return entry.checked(_class_problem), None
        marked = self.marked
        given = marked.mapping(entry.value, "'accelerator'")
        known = marked.known(given, (*LANGUAGES, "entity", "ports"), "an accelerator")
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
        ports = known["ports"].choice(PORTS, "plain") if "ports" in known else "plain"
        has_records = ports != "plain"
        if has_records and language.name == "verilog":
            known["ports"].error("Verilog has no records: write 'systemverilog' as the key")
        hdl = Hdl(
            language=language.name,  # type: ignore[arg-type]
            files=tuple(files),
            entity=entity,
            has_records=has_records,
        )
        return f"{entity} ({', '.join(files)})", hdl

    def _pins(self, entry: Entry) -> tuple[IoPins, ...]:
        """Read the pins of the members of an accelerator; which there are is up to the board."""
        found: list[IoPins] = []
        for name, each in self.marked.mapping(entry.value, "'pins'", "{pwm: [A4, B5]}").items():
            words = each.words()
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

    * `entry`: the value of ``port``.
    * `taken`: the topic of each port in lower case, by kind and port; this one is added.
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

    * `library`: the definitions of all types.
    * `link`: it decides whether a subscription may hold what comes.
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
        self, message: Message, direction: Way, kind: Kind, options: dict[str, Entry]
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

    def _when_full(self, entry: Entry | None, kind: Kind, direction: Way) -> Any:
        # A subscription that waits would hold the packets of all others, which come by one router.
        usual = "drop" if direction == "in" else "wait"
        if entry is None:
            return usual
        policy = entry.choice(("wait", "drop"), usual)
        if policy == "wait" and kind == "subscribe" and not self.link.can_wait:
            entry.error(f"a link of kind '{self.link.kind}' cannot be held; use 'drop'")
        return policy


def in_keys(problem: Diagnostic) -> Diagnostic:
    """Name keys of a description where a problem of its definitions names options of commands."""
    message = problem.message.replace("--depends", "'paths'").replace("--distro", "'distro'")
    return replace(problem, message=message)


def _directions(kind: Kind, interface: Interface) -> tuple[tuple[Way, Message], ...]:
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
