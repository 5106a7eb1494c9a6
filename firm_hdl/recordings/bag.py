"""Bags of ROS 1; http://wiki.ros.org/Bags/Format/2.0 describes the format."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from io import BytesIO
from typing import BinaryIO

from firm_hdl.recordings.limits import (
    MAX_TEXT_BYTES,
    MAX_TOPICS,
    MAX_WORD_BYTES,
    Budget,
    Cursor,
    UnreadableError,
    word_of,
)
from firm_hdl.recordings.topics import RecordingFile, Schema, Topic

__all__ = ["MAGIC", "BagFile"]

MAGIC = b"#ROSBAG V"

_VERSION = b"2.0\n"
# Records have up to seven.
_MOST_FIELDS = 100
_MESSAGE, _BAG, _CHUNK, _CONNECTION = b"\x02", b"\x03", b"\x05", b"\x07"


class BagFile(RecordingFile):
    """An open bag; a topic is a connection."""

    def __init__(self, file: BinaryIO, size: int, budget: Budget) -> None:
        super().__init__()
        self._file, self._size, self._budget = file, size, budget
        start = Cursor(file, size)
        if start.take(len(MAGIC) + len(_VERSION)) != MAGIC + _VERSION:
            raise UnreadableError("it is not of version 2.0")
        header = _fields(start.part(start.number(4)))
        index = _number(header, b"index_pos")
        if header.get(b"op") != _BAG or index > size:
            raise UnreadableError("it is damaged or incomplete")
        if header.get(b"encryptor"):
            raise UnreadableError("it is encrypted")
        if not index:
            raise UnreadableError("it has no index, which 'rosbag reindex' makes")
        for header, data in self._records(index):
            if header.get(b"op") == _CONNECTION:
                self._add(_number(header, b"conn"), word_of(header.get(b"topic")), _fields(data))

    def messages(self, numbers: Collection[int]) -> Iterator[tuple[int, int, bytes]]:
        for header, data in self._records(len(MAGIC) + len(_VERSION)):
            if header.get(b"op") == _MESSAGE and (conn := _number(header, b"conn")) in numbers:
                nanoseconds, seconds = divmod(_number(header, b"time"), 1 << 32)
                yield conn, seconds * 10**9 + nanoseconds, data.take(data.left)

    def _add(self, number: int, topic: str, fields: dict[bytes, bytes | None]) -> None:
        if len(self.topics) == MAX_TOPICS:
            raise UnreadableError(f"it has more than {MAX_TOPICS} connections")
        type_ = word_of(fields.get(b"type"))
        # A subscriber to any type has `*` for its sum.
        if type_ == "roslib/Header":
            # Before std_msgs had it; genmsg reads both names as one.
            type_ = "std_msgs/Header"
        digest = word_of(fields.get(b"md5sum")).replace("*", "")
        text = fields.get(b"message_definition", b"")
        self._budget.keep(len(text or b""))
        self.schemas.append(Schema(type=type_, encoding="ros1msg", data=text))
        self.topics[number] = Topic(name=topic, type=type_, encoding="ros1", digest=digest)

    def _records(self, start: int) -> Iterator[tuple[dict[bytes, bytes | None], Cursor]]:
        self._file.seek(start)
        return _records(Cursor(self._file, self._size - start), self._budget)


def _records(
    cursor: Cursor, budget: Budget, *, is_in_chunk: bool = False
) -> Iterator[tuple[dict[bytes, bytes | None], Cursor]]:
    """Yield header and data of each record; chunks are replaced by the records in them."""
    while cursor.left:
        header = _fields(cursor.part(cursor.number(4)))
        data = cursor.part(cursor.number(4))
        if _value(header, b"op") == _CHUNK:
            if is_in_chunk:
                raise UnreadableError("it is damaged: it has a chunk in a chunk")
            block, compression = data.take(data.left), word_of(header.get(b"compression"))
            if compression != "none":
                block = budget.expand(block, compression, _number(header, b"size"))
            yield from _records(Cursor(BytesIO(block), len(block)), budget, is_in_chunk=True)
        else:
            yield header, data
        data.skip()


def _fields(cursor: Cursor) -> dict[bytes, bytes | None]:
    """Read the fields of a header. Those that are too long are `None`."""
    found: dict[bytes, bytes | None] = {}
    while cursor.left:
        field = cursor.part(cursor.number(4))
        # A name is shorter than that.
        is_long = field.left > MAX_TEXT_BYTES + 64
        name, is_field, value = field.take(64 if is_long else field.left).partition(b"=")
        field.skip()
        if not is_field or len(found) == _MOST_FIELDS:
            raise UnreadableError("it is damaged: a record has no fields, or too many")
        found[name] = None if is_long or len(value) > MAX_TEXT_BYTES else value
    return found


def _number(header: dict[bytes, bytes | None], name: bytes) -> int:
    """Return an unsigned number of any size."""
    return int.from_bytes(_value(header, name), "little")


def _value(header: dict[bytes, bytes | None], name: bytes) -> bytes:
    value = header.get(name)
    if value is None or len(value) > MAX_WORD_BYTES:
        raise UnreadableError(f"it is damaged: a record has no '{name.decode()}'")
    return value
