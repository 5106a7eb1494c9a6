"""Databases of rosbag2, ``.db3``.

A file of SQLite may contain what computes: views, triggers, virtual tables, generated columns.
rosbag2 writes none of them, and a file that has one is refused. The pages of a damaged file may
have endlessly many rows, so the steps of SQLite and the bytes of messages are counted, too.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import Any, BinaryIO

import apsw

from firm_hdl.recordings.limits import (
    MAX_BLOCK_BYTES,
    MAX_TEXT_BYTES,
    MAX_TOPICS,
    MAX_WORD_BYTES,
    Budget,
    UnreadableError,
    word_of,
)
from firm_hdl.recordings.topics import RecordingFile, Schema, Topic

__all__ = ["MAGIC", "Database"]

MAGIC = b"SQLite format 3\0"

_PLAIN = " OR ".join(f"sql LIKE 'CREATE {kind} %'" for kind in ("TABLE", "INDEX", "UNIQUE INDEX"))
# SQLite's steps for each call of its progress handler, and the calls that any file may need. A row
# takes about ten steps, and has more bytes than that.
_STEPS, _MIN_CALLS = 1000, 2000


class Database(RecordingFile):
    """An open database.

    SQLite reads from the given file alone. So that file need not have a name, and neither a journal
    nor a lock beside it is looked for.
    """

    def __init__(self, file: BinaryIO, size: int, budget: Budget) -> None:
        super().__init__()
        self._budget, self._calls = budget, _MIN_CALLS + size // _STEPS
        self._vfs = _Vfs(file, size)
        self._connection = apsw.Connection(
            "recording", flags=apsw.SQLITE_OPEN_READONLY, vfs=self._vfs.name
        )
        self._connection.limit(apsw.SQLITE_LIMIT_LENGTH, MAX_BLOCK_BYTES)
        self._connection.set_progress_handler(self._is_over, _STEPS)
        try:
            self._read()
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        self._connection.close()
        self._vfs.unregister()

    def messages(self, numbers: Collection[int]) -> Iterator[tuple[int, int, bytes]]:
        # SQLite does not enforce the types of columns.
        topics = ", ".join(str(number) for number in numbers if isinstance(number, int))
        query = f"SELECT topic_id, timestamp, data FROM messages WHERE topic_id IN ({topics})"
        for topic, time, data in self._rows(query):
            if not isinstance(time, int) or not isinstance(data, bytes):
                raise UnreadableError("it is damaged: a message has no time or no bytes")
            self._budget.count(len(data))
            yield topic, time, data

    def _read(self) -> None:
        if list(self._rows(f"SELECT 1 FROM sqlite_master WHERE NOT ({_PLAIN})")):
            raise UnreadableError("it is a database with a view, a trigger or a virtual table")
        self._columns: set[tuple[str, str]] = set()
        for table in ("topics", "messages", "message_definitions", "schema"):
            for _, column, *_, hidden in self._rows(f"PRAGMA table_xinfo({table})"):
                if hidden:
                    raise UnreadableError("it is a database with generated columns")
                self._columns.add((table, column))
        if not {("topics", "type"), ("messages", "data")} <= self._columns:
            raise UnreadableError("it is a database without the tables of a recording")
        # Since iron, there are hashes and definitions.
        for number, *texts in self._texts(
            "topics", "id", "name", "type", "serialization_format", "type_description_hash"
        ):
            name, type_, encoding, digest = map(word_of, texts)
            self.topics[number] = Topic(name=name, type=type_, encoding=encoding, digest=digest)
        for _, type_, encoding, data in self._texts(
            "message_definitions", "id", "topic_type", "encoding", "encoded_message_definition"
        ):
            self._budget.keep(len(data or b""))
            self.schemas.append(Schema(type=word_of(type_), encoding=word_of(encoding), data=data))
        names = [word_of(name) for _, name in self._texts("schema", "schema_version", "ros_distro")]
        self.distro = names[0] if names else ""

    def _texts(self, table: str, key: str, *columns: str) -> Iterator[tuple[Any, ...]]:
        """Read the rows of a small table: the key, and columns as bytes.

        Columns that the table does not have are empty; texts that are too long are `None`.
        """
        if (table, key) not in self._columns:
            return
        texts = []
        for column in columns:
            most = MAX_TEXT_BYTES if column == "encoded_message_definition" else MAX_WORD_BYTES
            text = f"CASE WHEN octet_length({column}) <= {most} THEN CAST({column} AS BLOB) END"
            texts.append(text if (table, column) in self._columns else "x''")
        rows = self._rows(f"SELECT {key}, {', '.join(texts)} FROM {table}")
        for count, row in enumerate(rows):
            if count == MAX_TOPICS:
                raise UnreadableError(f"it has more than {MAX_TOPICS} topics or types")
            yield row

    def _rows(self, query: str) -> Iterator[tuple[Any, ...]]:
        try:
            yield from self._connection.execute(query)
        except apsw.InterruptError:
            reason = "it is damaged: SQLite takes more steps than its size allows for"
        except apsw.TooBigError:
            reason = f"it has a value of more than {MAX_BLOCK_BYTES} bytes"
        except apsw.NoMemError:
            raise MemoryError from None
        except (apsw.Error, UnicodeDecodeError):
            reason = "it is damaged: SQLite cannot read it"
        else:
            return
        raise UnreadableError(reason)

    def _is_over(self) -> bool:
        self._calls -= 1
        return self._calls < 0


class _Vfs(apsw.VFS):
    """The part of SQLite that opens files: it has one file, whatever its name is."""

    def __init__(self, file: BinaryIO, size: int) -> None:
        self.name = f"recording-{id(self)}"
        super().__init__(self.name, "")
        self._opened = _File(file, size)

    def xFullPathname(self, name: str) -> str:
        return name

    def xOpen(self, name: str | apsw.URIFilename | None, flags: list[int]) -> apsw.VFSFile:
        return self._opened


class _File(apsw.VFSFile):
    def __init__(self, file: BinaryIO, size: int) -> None:
        self._file, self._size = file, size

    def xRead(self, amount: int, offset: int) -> bytes:
        self._file.seek(offset)
        return self._file.read(amount)

    def xFileSize(self) -> int:
        return self._size

    def xDeviceCharacteristics(self) -> int:
        return apsw.SQLITE_IOCAP_IMMUTABLE

    def xSectorSize(self) -> int:
        return 0

    def xFileControl(self, op: int, ptr: int) -> bool:
        return False

    def xClose(self) -> None:
        return None
