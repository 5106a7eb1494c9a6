"""From the text of a description to its value; every mistake has its line and a caret."""

from __future__ import annotations

import os
import re
from codecs import BOM_UTF8
from collections.abc import Iterable
from difflib import get_close_matches
from pathlib import Path
from typing import Any

import yaml

from firm_hdl.errors import DefinitionError, Diagnostic, Source, Span
from firm_hdl.files import read_file
from firm_hdl.frontend import DEFAULT_DISTRO, DISTROS, Library, open_library
from firm_hdl.model import WIRE_OF
from firm_hdl.node.description import Description, Hdl, Kind, Link, Topic
from firm_hdl.node.link_reading import NODE_BUS_BYTES, read_link, with_memory
from firm_hdl.node.marked_yaml import Entry, Marked, parse
from firm_hdl.node.names import (
    MOST_TOPIC_CHARACTERS,
    expand,
    namespace_problem,
    node_problem,
    topic_problem,
)
from firm_hdl.node.topics import TOPIC_KEYS, TopicReader, in_keys, port_of

__all__ = ["read_description", "read_description_text"]

MOST_BYTES = 1 << 18
"""Largest file that is read: a thousand topics need less."""

MOST_COMPARED = 1000
"""Most pairs of names that are compared to find out what the user means."""

KINDS: tuple[Kind, ...] = ("subscribe", "publish", "serve")

_KEYS = ("node", "namespace", "distro", "paths", "bags", "bus_bytes", "clock_mhz", "link", "remap")
KEYS = (*_KEYS, *KINDS, "accelerator")

LANGUAGES = ("vhdl", "verilog", "systemverilog")


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
        topics = self._topics(known, library, names, bus_bytes, link)
        self._check_remap(names)
        if not topics and not self.marked.noted:
            self.marked.error_at_start(f"a node needs a topic: {', '.join(KINDS)}")
        accelerator, hdl = "", None
        if "accelerator" in known:
            accelerator, hdl = self._accelerator(known["accelerator"])
        self.marked.check()
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
            folder=self.folder,
            accelerator_span=(
                self.marked.span(known["accelerator"].value) if accelerator else None
            ),
            node_span=self.marked.span(known["node"].value),
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
            if problem := _path_problem(file):
                language.error(problem)
        if not files:
            return "", None
        entity = os.path.splitext(os.path.basename(files[-1]))[0]
        if "entity" in known:
            entity = known["entity"].checked(_entity_problem)
        elif problem := _entity_problem(entity):
            language.error(f"{problem}: name the 'entity'")
        hdl = Hdl(language=language.name, files=tuple(files), entity=entity)  # type: ignore[arg-type]
        return f"{entity} ({', '.join(files)})", hdl

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
    is_name = re.fullmatch("[A-Za-z][A-Za-z0-9_]*", text) and len(text) <= 255
    return "" if is_name else f"'{text}' is no name of an entity or a module"
