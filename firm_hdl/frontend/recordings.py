"""Definitions in recordings, for users who have the data but not the packages.

A ``.bag`` of ROS 1 has the definition of every topic's type, followed by those of all types in it.
An ``.mcap`` of ROS 2 and, since iron, a ``.db3`` have them, too. The format of these definitions is
described in ros2/rosbag2, ``docs/message_definition_encoding.md``. rosbags reads the files; the
texts are then processed like the texts of definition files.
"""

from __future__ import annotations

import errno
import os
import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TypeAlias, TypeVar

from rosbags.interfaces import Connection, MessageDefinitionFormat
from rosbags.rosbag1 import Reader as Reader1
from rosbags.rosbag1 import ReaderError as ReaderError1
from rosbags.rosbag2 import Reader as Reader2
from rosbags.rosbag2 import ReaderError as ReaderError2

from firm_hdl.errors import DefinitionError, Diagnostic, Source
from firm_hdl.files import check_file
from firm_hdl.frontend.embedded import DISTROS
from firm_hdl.frontend.expansion import Budget, bounded
from firm_hdl.frontend.names import Kind
from firm_hdl.frontend.recorded_idl import structs_of
from firm_hdl.frontend.sources import Definition, Language, PackagePlace
from firm_hdl.model import Dialect

__all__ = ["Reader", "RecordingOrigin", "use_recording"]

Reader: TypeAlias = "Reader1 | Reader2"
"""rosbags' reader of a recording."""

# Limit on the metadata file, because rosbags reads the whole file.
_MAX_METADATA_BYTES = 1 << 20
_MAGIC, _MAGIC_BYTES = b"#ROSBAG V", 64

_Name = tuple[str, Kind, str]
_T = TypeVar("_T")

_KINDS: dict[str, Kind] = {"msg": "msg", "srv": "srv", "action": "action"}

# The separator between the definitions of a topic: a line of ``=``, and the next type's name.
_NEXT = re.compile(r"^={3,}[ \t]*\r?\n(MSG|SRV|IDL):[ \t]*(\S+)[ \t]*(?:\r?\n|\Z)", re.MULTILINE)
# Schema encodings of MCAP's registry that are not read here.
_OTHER_LANGUAGES = "omgidl", "protobuf", "flatbuffer", "jsonschema"
_INDENTED = re.compile(r"^[ \t]+(?=[^\s#])", re.MULTILINE)
_FULL_NAME = re.compile(r"^([A-Za-z]\w*)/msg/(?=[A-Z])", re.MULTILINE)
_STRUCT = re.compile(r"\bstruct\s+\w+\s*\{")
_SERVICE_PARTS = re.compile(r"^---", re.MULTILINE)


class RecordingOrigin:
    """The types of a recording: a ``.bag``, ``.mcap`` or ``.db3`` file, or a folder of rosbag2.

    The file is read at once, and closed. Where it defines a type twice, the first text counts.

    Parameters
    ----------
    path : str or path

    Attributes
    ----------
    path : str
    dialect : "ros1" or "ros2"
    distro : str or None
        The distribution that the recording names as its origin, if it is one of `DISTROS`.

    Raises
    ------
    DefinitionError
        If the file cannot be read, or has no definitions. It has no span.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = os.fspath(path)
        self.dialect: Dialect = _dialect(self.path)
        self.distro: str | None = None
        # Parts of packages: their types hide no others.
        self.packages: dict[str, PackagePlace] = {}
        self._definitions: dict[_Name, Definition] = {}
        self._missing: set[_Name] = set()
        # Messages without fields have definitions without text.
        self._empty: set[_Name] = set()
        # Names of topics' types that do not have ROS's form.
        self._not_ros: set[str] = set()
        # Types in OMG IDL as DDS tools write it: all types in one text, without headings.
        self._of_dds: set[_Name] = set()
        for connection in self._connections():
            self._add(connection)
        for name in sorted(self._empty):
            self._define(name, "msg", "")
        self._missing -= self._definitions.keys()
        self._of_dds -= self._definitions.keys()
        if not self._definitions:
            raise _refusal(self._why_empty())

    def names(self) -> Iterable[_Name]:
        """List the types that the recording defines."""
        return self._definitions

    def find(self, package: str, kind: Kind, name: str) -> Definition | None:
        """Give a definition; raise `DefinitionError` for a topic's type without one."""
        if (package, kind, name) in self._missing:
            raise _refusal(
                f"'{self.path}' has a topic of type '{package}/{kind}/{name}', but not its "
                "definition"
            )
        if (package, kind, name) in self._of_dds:
            raise _refusal(self._in_omgidl(f"{package}/{kind}/{name}"))
        return self._definitions.get((package, kind, name))

    def _in_omgidl(self, name: str) -> str:
        return f"'{self.path}' defines '{name}' in 'omgidl', and only ros2msg and ros2idl are read"

    def _connections(self) -> list[Connection]:
        def look(recording: Reader) -> list[Connection]:
            distro = getattr(recording, "ros_distro", None)
            known = DISTROS.get(distro) if isinstance(distro, str) else None
            if known is not None and known.dialect == self.dialect:
                self.distro = distro
            connections = list(recording.connections)
            for each in connections:
                # SQLite does not enforce the types of columns.
                if not isinstance(each.msgtype, str) or not isinstance(each.msgdef.data, str):
                    raise TypeError
            return connections

        return use_recording(self.path, look)

    def _add(self, connection: Connection) -> None:
        text, language = connection.msgdef.data, connection.msgdef.format
        is_idl = language == MessageDefinitionFormat.IDL
        # In omgidl, names have the scope operator of IDL.
        name = _parse(connection.msgtype.replace("::", "/") if is_idl else connection.msgtype)
        if name is None:
            self._not_ros.add(connection.msgtype)
        elif language == MessageDefinitionFormat.NONE or (is_idl and not text):
            self._missing.add(name)
        elif not text and self.dialect == "ros2":
            self._empty.add(name)
        elif is_idl and _is_of_dds(connection.msgtype, text):
            self._of_dds.add(name)
        else:
            for part, kind, body in _split(name, text, is_idl):
                self._define(part, kind, body)

    def _define(self, name: _Name, language: Language, text: str) -> None:
        """Keep a definition, unless one of that name was found before."""
        source = Source(name=f"<{self.path}>/{'/'.join(name)}.{language}", text=text)
        self._definitions.setdefault(name, Definition(source=source, language=language))

    def _why_empty(self) -> str:
        if self._of_dds:
            return self._in_omgidl("/".join(min(self._of_dds)))
        if self._not_ros and not self._missing:
            name = min(self._not_ros)
            return f"'{self.path}' has a topic of type {name!r}, which is not a ROS name"
        if not self._missing:
            return f"'{self.path}' has no topics, and so no definitions"
        return (
            f"'{self.path}' has no definitions of its types, like all recordings made before ROS 2 "
            "iron; name folders that have them with --path, or a distribution with --distro, "
            "instead of --bag"
        )


def use_recording(path: str, use: Callable[[Reader], _T]) -> _T:
    """Open a recording, call a function with its reader, and return the function's result.

    Parameters
    ----------
    use : callable
        Called with rosbags' reader. It must only read, because any exception in it is reported as
        an unreadable file.

    Raises
    ------
    DefinitionError
        If the file cannot be read. It has no span.
    """
    if not os.path.exists(path):
        raise _refusal(f"'{path}' does not exist")
    if os.path.isdir(path) and not os.path.exists(os.path.join(path, "metadata.yaml")):
        raise _refusal(f"'{path}' is a folder without the metadata.yaml of a recording")
    try:
        _check_files(path)
        with bounded(path) as budget:
            return _use(path, use, budget)
    except OSError as error:
        raise _refusal(f"'{error.filename}' cannot be read: {error.strerror}") from None


def _use(path: str, use: Callable[[Reader], _T], budget: Budget) -> _T:
    reader = Reader1 if _dialect(path) == "ros1" else Reader2
    try:
        if reader is Reader1 and not _is_bag(path):
            raise ReaderError1("File magic is invalid.")
        with reader(Path(path)) as recording:
            return use(recording)
    except OSError as error:
        # A damaged file has offsets that no file can have.
        reason = "it is damaged" if error.errno == errno.EINVAL else error.strerror or str(error)
    except (ReaderError1, ReaderError2) as error:
        # rosbags wraps exceptions from data that it does not check. Their messages do not help.
        unchecked = TypeError | AttributeError | KeyError | ValueError
        reason = "it is damaged" if isinstance(error.__context__, unchecked) else str(error)
    except KeyError as error:
        # Such as the language of the definitions.
        reason = f"rosbags does not support {error}"
        if error.args[:1] in [(language,) for language in _OTHER_LANGUAGES]:
            reason = f"its definitions are in {error}, and only ros2msg and ros2idl are read"
    except MemoryError:
        reason = "it needs more memory than is available"
    except Exception:
        # A damaged file can make a reader fail in any way.
        reason = "it is damaged"
    reason = budget.excess or reason
    raise _refusal(f"'{path}' cannot be read as a recording: {reason}")


def _check_files(path: str) -> None:
    """Check, before rosbags opens them, that no file blocks its reader, such as a pipe."""
    if not os.path.isdir(path):
        check_file(path)
        return
    with os.scandir(path) as entries:
        for entry in entries:
            if entry.name == "metadata.yaml":
                check_file(entry.path, _MAX_METADATA_BYTES)
            elif not entry.is_dir():
                check_file(entry.path)


def _is_bag(path: str) -> bool:
    """Tell whether a file starts like a bag of ROS 1; rosbags would read a line of any length."""
    with open(path, "rb") as file:
        start = file.read(_MAGIC_BYTES)
    return start.startswith(_MAGIC) and b"\n" in start


def _dialect(path: str) -> Dialect:
    is_bag = path.lower().endswith(".bag") and not os.path.isdir(path)
    return "ros1" if is_bag else "ros2"


def _refusal(message: str) -> DefinitionError:
    return DefinitionError([Diagnostic(message=message)])


def _parse(name: str) -> _Name | None:
    match name.split("/"):
        case [package, base] if package and base:
            return package, "msg", base
        case [package, kind, base] if package and base and kind in _KINDS:
            return package, _KINDS[kind], base
    return None


def _is_of_dds(name: str, text: str) -> bool:
    """Tell whether DDS tools wrote a definition in IDL: without headings."""
    return "::" in name or (not text.startswith("===") and len(_STRUCT.findall(text)) > 1)


def _split(name: _Name, text: str, is_idl: bool) -> Iterator[tuple[_Name, Language, str]]:
    """Cut a topic's definition into the definitions of the types in it."""
    marks = list(_NEXT.finditer(text))
    starts = [0, *(mark.end() for mark in marks)]
    ends = [*(mark.start() for mark in marks), len(text)]
    names = [name, *(_parse(mark[2]) for mark in marks)]
    for index, (part, start, end) in enumerate(zip(names, starts, ends, strict=True)):
        body = text[start:end]
        if part is None or (is_idl and index == 0 and not body.strip() and marks):
            continue  # In IDL, the first definition has a heading, too.
        if index < len(marks) and body.endswith("\n"):
            # Writers add an empty line, or at least a line end, after each definition.
            body = body[:-1]
        if body and not body.endswith("\n"):
            body += "\n"
        if is_idl:
            for each, isolated in ({part: body} | _messages(part, body)).items():
                yield each, "idl", isolated
        else:
            yield part, _language(part, body), _normalized(body)


def _messages(name: _Name, text: str) -> dict[_Name, str]:
    """Give the texts of all messages of an IDL section that declares `name` and other messages."""
    found = structs_of(text)
    return found if name in found else {}


def _normalized(text: str) -> str:
    """Write a definition as in its file: some writers indent it, or write full names of types."""
    return _FULL_NAME.sub(r"\1/", _INDENTED.sub("", text))


def _language(name: _Name, text: str) -> Language:
    # A message of a service or of an action may be defined by itself.
    is_whole = name[1] != "msg" and _SERVICE_PARTS.search(text) is not None
    return name[1] if is_whole else "msg"
