"""Definitions in recordings, for users who have the data but not the packages.

A ``.bag`` of ROS 1 has the definition of every topic's type, followed by those of all types in it.
An ``.mcap`` of ROS 2 and, since iron, a ``.db3`` have them, too. The format of these definitions is
described in ros2/rosbag2, ``docs/message_definition_encoding.md``. Their texts are processed like
those of definition files.

ROS has one message per file, and records one section per file. Other writers put all types of a
topic into one section of IDL. Of such a section, each struct gets a copy in which the other structs
are replaced by blanks. So constants, typedefs and line numbers stay.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from firm_hdl.errors import DefinitionError, Diagnostic, Source
from firm_hdl.frontend.embedded import DISTROS
from firm_hdl.frontend.explain import clip
from firm_hdl.frontend.names import KINDS, PARTS, Kind, TypeName, owners
from firm_hdl.frontend.parse import is_type_name
from firm_hdl.frontend.sources import Definition, Language, Origin, PackagePlace, distro_of
from firm_hdl.model import Dialect
from firm_hdl.recordings import MAX_TEXT_BYTES, MAX_TOPICS, Recording, Schema, Topic

__all__ = ["RecordingOrigin", "structs_of"]

_Name = tuple[str, Kind, str]

_LANGUAGES: dict[Dialect, tuple[str, ...]] = {"ros1": ("ros1msg",), "ros2": ("ros2msg", "ros2idl")}
# What recorders write as the language of a definition that they did not find.
_NO_LANGUAGES = "", "unknown"
_NOT_RECORDED = (
    "none was recorded; name a folder that has it with --depends, or a distribution with --distro"
)

# The heading of a definition: a line of ``=``, and the name of its type.
_HEADING = re.compile(
    r"^={3,}[ \t]*\r?\n(?:MSG|SRV|ACTION|IDL):[ \t]*(\S+)[ \t]*(?:\r?\n|\Z)", re.MULTILINE
)
_COMMENT = re.compile(r"#.*")
_INDENTED = re.compile(r"^[ \t]+(?=[^\s#])", re.MULTILINE)
_FULL_NAME = re.compile(r"^([A-Za-z]\w*)/msg/(?=[A-Z])", re.MULTILINE)
# Before std_msgs had it; genmsg reads both names as one.
_OLD_HEADER = re.compile(r"^roslib/Header(?=\s)", re.MULTILINE)
_STRUCT = re.compile(r"\bstruct\s+\w+\s*\{")
_SEPARATOR = re.compile(r"^---", re.MULTILINE)

# Names that are checked, legal or not.
_MOST_NAMES = 2 * MAX_TOPICS
_MOST_REASONS = 20


class RecordingOrigin:
    """The types of a recording: a ``.bag``, ``.mcap`` or ``.db3`` file, or a folder of rosbag2.

    The file is read at once, and closed. Where it defines a type twice, the first text counts.

    * `others`: have the types of topics that were recorded without their definitions.

    Raises `DefinitionError` if the file cannot be read, or if no type in it can be used. It has no
    span.
    """

    def __init__(self, path: str | os.PathLike[str], others: Iterable[Origin] = ()) -> None:
        recording = Recording(path)
        self.path, self.dialect = recording.path, recording.dialect
        distro = DISTROS.get(recording.distro)
        is_known = distro is not None and distro.dialect == self.dialect
        # The distribution that the recording names as its origin, if it is one of `DISTROS`.
        self.distro = recording.distro if is_known else None
        # Parts of packages: their types hide no others.
        self.packages: dict[str, PackagePlace] = {}
        self._definitions: dict[_Name, Definition] = {}
        self._copied = 0
        self._names: dict[str, _Name | None] = {}
        # A message without fields has no text. The text that another topic has counts before none.
        reasons: dict[str, str] = {}
        for schema in sorted(recording.schemas, key=lambda schema: schema.data == b""):
            reasons.setdefault(schema.type, self._read(schema))
        others = list(others)
        self._named = distro_of(others)
        # The types of topics that cannot be used, by their recorded names, with a sentence that
        # says why.
        self.unusable: dict[str, str] = {}
        self._refused: dict[_Name, str] = {}
        first: dict[str, Topic] = {}
        for topic in recording.topics:
            first.setdefault(topic.type, topic)
        for type_, topic in first.items():
            name, reason = self._name(type_), reasons.get(type_, _NOT_RECORDED)
            if name is not None and not self._has(name) and reason == _NOT_RECORDED:
                reason = self._look_up(name, others)
            if name is None or not self._has(name):
                self.unusable[type_] = self._sentence(topic, name, reason)
                # DDS tools write scopes of IDL, which users would not.
                name = self._name(type_.replace("::", "/"))
                if name is not None:
                    self._refused[name] = self.unusable[type_]
        if not self._definitions:
            raise DefinitionError(self._nothing(bool(others)))

    def names(self) -> Iterable[_Name]:
        """List the types that the recording defines."""
        return self._definitions

    def find(self, package: str, kind: Kind, name: str) -> Definition | None:
        """Give a definition; raise `DefinitionError` for a topic's type that cannot be used."""
        if (package, kind, name) in self._refused:
            raise DefinitionError.of(self._refused[package, kind, name])
        return self._definitions.get((package, kind, name))

    def _name(self, text: str) -> _Name | None:
        """Split the name of a type, once; `None` if it is no such name."""
        if text not in self._names:
            if len(self._names) == _MOST_NAMES:
                raise DefinitionError.of(
                    f"'{self.path}' has more than {_MOST_NAMES} names of types"
                )
            self._names[text] = self._split(text)
        return self._names[text]

    def _split(self, text: str) -> _Name | None:
        match text.split("/"):
            case [package, base]:
                kind: Kind = "msg"
            case [package, "msg" | "srv" | "action" as kind, base]:
                pass
            case _:
                return None
        if self.dialect == "ros1" and (package, base) == ("roslib", "Header"):
            package = "std_msgs"
        name: _Name = package, kind, base
        is_legal = any(is_type_name(f"{p}/{b}", self.dialect) for p, _, b in self._owners(name))
        return name if is_legal else None

    def _read(self, schema: Schema) -> str:
        """Define the types in a definition; return why it is not usable, or nothing."""
        languages = _LANGUAGES[self.dialect]
        if schema.encoding in _NO_LANGUAGES:
            return _NOT_RECORDED
        if schema.encoding not in languages:
            known = " and ".join(languages)
            return f"it is in '{clip(schema.encoding)}', and only {known} are read"
        if schema.data is None:
            return f"it has more than {MAX_TEXT_BYTES} bytes"
        try:
            text = schema.data.decode("utf-8")
        except UnicodeDecodeError:
            return "it is not UTF-8 text"
        is_idl = schema.encoding == "ros2idl"
        if is_idl and ("::" in schema.type or _is_of_dds(text)):
            return "it is in 'omgidl', and only ros2msg and ros2idl are read"
        name = self._name(schema.type)
        if name is None:
            return ""
        if not text and (is_idl or name[1] != "msg"):
            return _NOT_RECORDED
        marks = list(_HEADING.finditer(text))
        if len(marks) > MAX_TOPICS:
            return f"it has more than {MAX_TOPICS} headings"
        starts = [0, *(mark.end() for mark in marks)]
        ends = [*(mark.start() for mark in marks), len(text)]
        parts = [name, *(self._name(mark[1]) for mark in marks)]
        for part, start, end in zip(parts, starts, ends, strict=True):
            # Writers add an empty line, or at least a line end, before a heading.
            body = text[start:end] if end == len(text) else text[start:end].removesuffix("\n")
            is_before_headings = bool(marks) and start == 0
            if part is None or (is_before_headings and not _COMMENT.sub("", body).strip()):
                continue
            self._declare(part, body if not body or body.endswith("\n") else f"{body}\n", is_idl)
        return "" if self._has(name) else "the recorded text defines other types"

    def _declare(self, name: _Name, text: str, is_idl: bool) -> None:
        """Define what the text under a heading declares."""
        if is_idl:
            copies = structs_of(text, MAX_COPIED - self._copied)
            self._copied += len(copies) * len(text)
            for each, copy in (copies if name in copies else {}).items():
                self._define(each, "idl", copy)
            is_message = re.search(rf"\bstruct\s+{name[2]}\b", text) is not None
        else:
            is_message = _SEPARATOR.search(text) is None
        if name[1] == "msg" or is_message:
            self._define(name, "idl" if is_idl else "msg", text)
        else:
            # Under the name of a message of a service or an action may be the text of all of it.
            _, *wholes = self._owners(name)
            self._define(wholes[0] if wholes else name, "idl" if is_idl else name[1], text)

    def _define(self, name: _Name, language: Language, text: str) -> None:
        """Keep a definition, unless one of that name was found before."""
        if name in self._definitions:
            return
        if language != "idl":
            # Some writers indent the text, or write full names of types.
            text = _FULL_NAME.sub(r"\1/", _INDENTED.sub("", text))
        if self.dialect == "ros1":
            text = _OLD_HEADER.sub("std_msgs/Header", text)
        source = Source(name=f"<{self.path}>/{'/'.join(name)}.{language}", text=text)
        self._definitions[name] = Definition(source=source, language=language)

    def _has(self, name: _Name) -> bool:
        """Tell whether a message or its service or action is defined."""
        return any(key in self._definitions for key in self._owners(name))

    def _owners(self, name: _Name) -> list[_Name]:
        """List a type, and the services or actions that may have it."""
        package, kind, base = name
        found = owners(TypeName(package, kind, base, self.dialect))
        return [name, *((package, kind, owner.name) for owner in found)]

    def _look_up(self, name: _Name, others: list[Origin]) -> str:
        """Define a type as another origin does; return why it cannot be, or nothing."""
        for key in self._owners(name):
            for origin in others:
                try:
                    if isinstance(origin, RecordingOrigin):
                        # Why another recording has no definition is no reason here.
                        found = origin._definitions.get(key)
                    else:
                        found = origin.find(*key)
                except DefinitionError as error:
                    return error.diagnostics[0].message
                if found is not None:
                    self._definitions[key] = found
                    return ""
        return _NOT_RECORDED

    def _sentence(self, topic: Topic, name: _Name | None, reason: str) -> str:
        """Say why the type of a topic cannot be used."""
        if not topic.type:
            return f"'{self.path}' has a topic '{clip(topic.name)}' without a type"
        start = f"'{self.path}' has a topic of type '{clip(topic.type)}'"
        if name is None and reason in ("", _NOT_RECORDED):
            return f"{start}, which is not the name of a type"
        if reason == _NOT_RECORDED and self._named:
            reason = (
                f"none was recorded, and {self._named} does not have it; name a folder that has it "
                "with --depends"
            )
        return f"{start}, but not its definition: {reason or 'the recorded text is of other types'}"

    def _nothing(self, is_looked_up: bool) -> Iterator[Diagnostic]:
        """Say why no type can be used."""
        reasons = list(self.unusable.values())
        if not reasons:
            reasons = [f"'{self.path}' has no topics, and so no definitions"]
        elif not is_looked_up and all(each.endswith(_NOT_RECORDED) for each in reasons):
            distro = f"--distro {self.distro}" if self.distro else "--distro"
            reasons = [
                f"'{self.path}' has no definitions of its types, like all recordings made before "
                "ROS 2 iron; name folders that have them with --depends, or the distribution with "
                f"{distro}"
            ]
        for reason in reasons[:_MOST_REASONS]:
            yield Diagnostic(reason)
        if len(reasons) > _MOST_REASONS:
            yield Diagnostic(f"{len(reasons) - _MOST_REASONS} more types cannot be used")


def _is_of_dds(text: str) -> bool:
    """Tell whether DDS tools wrote a definition in IDL: without headings."""
    return not text.startswith("===") and len(_STRUCT.findall(text)) > 1


MAX_COPIED = 1 << 25
"""Characters of all copies of the sections of a recording."""

# What is not closed, ends with the line or with the text.
_TEXT_OR_COMMENT = re.compile(r'"(?:[^"\\\n]|\\.)*"?|//[^\n]*|/\*.*?(?:\*/|\Z)', re.DOTALL)
_MARK = re.compile(r"\bmodule\s+(?P<module>\w+)\s*\{|\bstruct\s+(?P<struct>\w+)\s*\{|[{}]")
_EMPTY = re.compile(r"\bmodule\s+\w+\s*\{\s*\}\s*;?")
_END = re.compile(r"\s*;?")
# A type of a member, or the element of a sequence.
_PLACE = re.compile(r"(?<![\w:])(\w+)(?=\s+\w+\s*[;,\[])|(?<=<)\s*(\w+)(?=\s*[>,])")
_SUFFIXES = PARTS["ros2", "srv"] + PARTS["ros2", "action"]
# Modules may be in modules: ROS has a package and a folder.
_MOST_LEVELS = 8


@dataclass(frozen=True, slots=True)
class _Struct:
    """The position of a struct with its annotations, and the modules around it."""

    modules: tuple[str, ...]
    name: str
    start: int
    end: int


def structs_of(text: str, most: int = MAX_COPIED) -> dict[tuple[str, Kind, str], str]:
    """Cut a section into texts of one message each, by package, folder and name.

    The result is empty if there is nothing to cut: the section has one message, a service or an
    action. It is also empty if the copies together would have more than `most` characters.
    """
    found = _find(_blank(text))
    if len(found) < 2 or any(each.name.endswith(_SUFFIXES) for each in found):
        return {}
    if len(found) * len(text) > most:
        return {}
    texts: dict[tuple[str, Kind, str], str] = {}
    for each in found:
        kind = next((kind for kind in KINDS if each.modules[1:] == (kind,)), None)
        if kind is None:
            return {}
        texts[each.modules[0], kind, each.name] = _isolated(text, each, found)
    return texts


def _blank(text: str) -> str:
    """Replace string literals and comments by blanks; the length stays the same."""
    return _TEXT_OR_COMMENT.sub(lambda match: _blanks(match[0]), text)


def _blanks(text: str) -> str:
    return re.sub(r"[^\n]", " ", text)


def _find(code: str) -> list[_Struct]:
    found: list[_Struct] = []
    scopes: list[tuple[str, str, int]] = []
    before = 0
    for mark in _MARK.finditer(code):
        if mark[0] != "}":
            # The part starts after the previous declaration, so that it includes annotations.
            start = max(before, code.rfind(";", before, mark.start()) + 1)
            kind = "module" if mark["module"] else "struct" if mark["struct"] else ""
            scopes.append((kind, mark["module"] or mark["struct"] or "", start))
        elif scopes:
            kind, name, start = scopes.pop()
            if kind == "struct":
                terminator = _END.match(code, mark.end())
                assert terminator is not None
                modules = tuple(each for what, each, _ in scopes if what == "module")
                found.append(_Struct(modules, name, start, terminator.end()))
        before = mark.end()
    return found


def _isolated(text: str, struct: _Struct, structs: list[_Struct]) -> str:
    text = _without(text, [(each.start, each.end) for each in structs if each is not struct])
    code = _blank(text)
    for _ in range(_MOST_LEVELS):
        empty = [match.span() for match in _EMPTY.finditer(code)]
        if not empty:
            break
        text, code = _without(text, empty), _without(code, empty)
    return _with_scopes(text, code, struct, structs)


def _without(text: str, spans: list[tuple[int, int]]) -> str:
    """Replace parts by blanks. A part may be in another one."""
    parts: list[tuple[int, int, str]] = []
    for start, end in sorted(spans):
        if not parts or start >= parts[-1][1]:
            parts.append((start, end, _blanks(text[start:end])))
    return _replaced(text, parts)


def _replaced(text: str, parts: list[tuple[int, int, str]]) -> str:
    """Replace parts, in the order of the text, by others."""
    pieces, position = [], 0
    for start, end, new in parts:
        pieces += [text[position:start], new]
        position = end
    return "".join([*pieces, text[position:]])


def _with_scopes(text: str, code: str, struct: _Struct, structs: list[_Struct]) -> str:
    """Write the names of structs in the same module in full, as ROS does."""
    others = (each for each in structs if each is not struct)
    siblings = {each.name for each in others if each.modules == struct.modules}
    parts = []
    for match in _PLACE.finditer(code):
        name = match[1] or match[2]
        if name in siblings:
            full = "::".join([*struct.modules, name])
            parts.append((match.end() - len(name), match.end(), full))
    return _replaced(text, parts)
