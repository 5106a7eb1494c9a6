"""Recordings: a ``.bag`` of ROS 1, an ``.mcap``, a ``.db3``, or a folder of rosbag2."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Container, Iterator
from contextlib import closing, contextmanager
from pathlib import PurePath
from typing import BinaryIO, Literal

import yaml

from firm_hdl.errors import DefinitionError, Diagnostic
from firm_hdl.files import check_file, read_file
from firm_hdl.recordings import bag, database, mcap
from firm_hdl.recordings.limits import MAX_TOPICS, Budget, UnreadableError
from firm_hdl.recordings.topics import RecordingFile, Schema, Topic

__all__ = ["Recording"]

_MAX_METADATA_BYTES = 1 << 20


class Recording:
    """What a recording has: topics, definitions and messages.

    Its files are read one after the other, and none of them stays open.

    Raises `DefinitionError` if the recording cannot be read. It has no span.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = os.fspath(path)
        # The distribution that the recording names as its origin; empty if there is none.
        self.distro = self._compression = ""
        self._files = [self.path]
        topics: dict[Topic, None] = {}
        schemas: dict[Schema, None] = {}
        has_bag = False
        with self._reported():
            if os.path.isdir(self.path):
                self._read_metadata()
            for file, _ in self._opened():
                topics |= dict.fromkeys(file.topics.values())
                schemas |= dict.fromkeys(file.schemas)
                if len(topics) > MAX_TOPICS:
                    raise UnreadableError(f"it has more than {MAX_TOPICS} topics")
                has_bag = has_bag or isinstance(file, bag.BagFile)
                self.distro = self.distro or file.distro
        # Definitions are in the order of the recording.
        self.topics, self.schemas = list(topics), list(schemas)
        # Files of MCAP may be of ROS 1, too.
        encodings = {schema.encoding for schema in self.schemas}
        is_ros1 = "ros1msg" in encodings and not encodings & {"ros2msg", "ros2idl"}
        self.dialect: Literal["ros1", "ros2"] = "ros1" if has_bag or is_ros1 else "ros2"

    def messages(self, topics: Container[Topic]) -> Iterator[tuple[Topic, int, bytes]]:
        """Yield topic, time in nanoseconds and bytes of each message, in the order of the files.

        * `topics`: those whose messages are read.

        Raises `DefinitionError` if the recording cannot be read to its end.
        """
        with self._reported():
            for file, budget in self._opened():
                wanted = {number: each for number, each in file.topics.items() if each in topics}
                for number, time, data in file.messages(wanted):
                    if self._compression == "message":
                        yield wanted[number], time, budget.expand(data, "zstd")
                    else:
                        yield wanted[number], time, data

    def _read_metadata(self) -> None:
        """Look up which files a folder has, and how they are compressed."""
        path = os.path.join(self.path, "metadata.yaml")
        if not os.path.exists(path):
            raise UnreadableError("it is a folder without metadata.yaml")
        # This loader makes texts, lists and dictionaries, and nothing else.
        loader = getattr(yaml, "CBaseLoader", yaml.BaseLoader)
        try:
            about = yaml.load(read_file(path, _MAX_METADATA_BYTES), Loader=loader)
            about = about["rosbag2_bagfile_information"]
            names = [PurePath(name).name for name in about["relative_file_paths"]]
            mode, compression = about.get("compression_mode"), about.get("compression_format")
            distro = about.get("ros_distro")
        except (yaml.YAMLError, RecursionError, AttributeError, KeyError, TypeError):
            raise UnreadableError("its metadata.yaml is not that of a recording") from None
        self._files = [os.path.join(self.path, name) for name in dict.fromkeys(names)]
        self.distro = distro if isinstance(distro, str) else ""
        if isinstance(mode, str) and mode.lower() in ("file", "message"):
            if compression != "zstd":
                raise UnreadableError(f"it is compressed by {compression!r}, and only zstd is read")
            self._compression = mode.lower()

    def _opened(self) -> Iterator[tuple[RecordingFile, Budget]]:
        """Open one file after the other."""
        for path in self._files:
            try:
                check_file(path)
            except ValueError:
                raise UnreadableError("no file has the name that it names") from None
        budget = Budget(sum(map(os.path.getsize, self._files)))
        for path in self._files:
            with open(path, "rb") as file:
                if self._compression == "file":
                    # This file has no name, so nothing remains of it if the process is killed.
                    with tempfile.TemporaryFile() as expanded:
                        for piece in budget.pieces(file, "zstd"):
                            expanded.write(piece)
                        yield from _read(expanded, budget)
                else:
                    yield from _read(file, budget)

    @contextmanager
    def _reported(self) -> Iterator[None]:
        """Make of any error one that users see."""
        try:
            yield
            return
        except UnreadableError as error:
            message = f"'{self.path}' cannot be read as a recording: {error}"
        except MemoryError:
            message = f"'{self.path}' cannot be read: there is not enough memory"
        except OSError as error:
            where = self.path if error.filename is None else os.fsdecode(error.filename)
            message = f"'{where}' cannot be read: {error.strerror or error}"
        raise DefinitionError([Diagnostic(message=message)])


def _read(file: BinaryIO, budget: Budget) -> Iterator[tuple[RecordingFile, Budget]]:
    """Read the definitions of an open file. Its first bytes tell its kind."""
    size = file.seek(0, os.SEEK_END)
    file.seek(0)
    start = file.read(16)
    file.seek(0)
    budget.begin_file()
    kinds: dict[bytes, type[bag.BagFile | mcap.McapFile | database.Database]] = {
        bag.MAGIC: bag.BagFile,
        mcap.MAGIC: mcap.McapFile,
        database.MAGIC: database.Database,
    }
    for magic, kind in kinds.items():
        if start.startswith(magic):
            with closing(kind(file, size, budget)) as opened:
                yield opened, budget
            return
    raise UnreadableError("it does not begin like a .bag, an .mcap or a .db3 file")
