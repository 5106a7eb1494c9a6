"""Files of MCAP; https://mcap.dev/spec describes the format.

Only schemas, channels, messages and chunks are read, in the order of the file. So files without an
index are read like others, and a wrong index does no harm.
"""

from __future__ import annotations

from binascii import crc32
from collections.abc import Collection, Iterator
from contextlib import suppress
from io import BytesIO
from typing import BinaryIO

from firm_hdl.recordings.limits import Budget, Cursor, UnreadableError
from firm_hdl.recordings.topics import RecordingFile, Schema, Topic

__all__ = ["MAGIC", "McapFile"]

MAGIC = b"\x89MCAP0\r\n"

_SCHEMA, _CHANNEL, _MESSAGE, _CHUNK = 0x03, 0x04, 0x05, 0x06
# Kind and size of the footer, which has the place of the summary.
_FOOTER = b"\x02" + (20).to_bytes(8, "little")
# Where rosbag2 writes the type hash in a channel.
_DIGEST = "topic_type_hash"
_MAX_METADATA_BYTES = 1 << 20


class McapFile(RecordingFile):
    """An open MCAP file; a topic is a channel."""

    def __init__(self, file: BinaryIO, size: int, budget: Budget) -> None:
        super().__init__()
        self._file, self._budget = file, budget
        footer = size - len(_FOOTER) - 20 - len(MAGIC)
        file.seek(max(0, footer))
        end = Cursor(file, size - max(0, footer))
        head, summary, _, magic = end.take(9), end.number(8), end.take(12), end.take(end.left)
        if head != _FOOTER or magic != MAGIC:
            raise UnreadableError("it is incomplete, which 'mcap recover' may mend")
        if summary and not len(MAGIC) <= summary <= footer:
            raise UnreadableError("it is damaged or incomplete")
        self._end = summary or footer
        schemas: dict[int, Schema] = {}
        channels: dict[int, tuple[int, str, str, str]] = {}
        if summary:
            self._read(summary, footer, schemas, channels)
        # A summary need not have the definitions.
        if not channels or any(each[0] and each[0] not in schemas for each in channels.values()):
            self._read(len(MAGIC), self._end, schemas, channels)
        self.schemas = list(schemas.values())
        for number, (schema, name, encoding, digest) in channels.items():
            type_ = schemas[schema].type if schema in schemas else ""
            self.topics[number] = Topic(name=name, type=type_, encoding=encoding, digest=digest)

    def messages(self, numbers: Collection[int]) -> Iterator[tuple[int, int, bytes]]:
        for kind, record in self._records(len(MAGIC), self._end):
            if kind == _MESSAGE and (channel := record.number(2)) in numbers:
                _, time, _ = record.number(4), record.number(8), record.number(8)
                yield channel, time, record.take(record.left)

    def _read(
        self,
        start: int,
        end: int,
        schemas: dict[int, Schema],
        channels: dict[int, tuple[int, str, str, str]],
    ) -> None:
        """Add the schemas and channels of a part of the file. The first of a number counts."""
        for kind, record in self._records(start, end):
            if kind == _SCHEMA and (number := record.number(2)) not in schemas:
                type_, encoding = record.word(), record.word()
                data = self._budget.text(record.part(record.number(4)))
                schemas[number] = Schema(type=type_, encoding=encoding, data=data)
            elif kind == _CHANNEL and (number := record.number(2)) not in channels:
                schema, name, encoding = record.number(2), record.word(), record.word()
                channels[number] = schema, name, encoding, _digest(record)

    def _records(self, start: int, end: int) -> Iterator[tuple[int, Cursor]]:
        self._file.seek(start)
        return _records(Cursor(self._file, end - start), self._budget)


def _records(
    cursor: Cursor, budget: Budget, *, is_in_chunk: bool = False
) -> Iterator[tuple[int, Cursor]]:
    """Yield kind and content of each record; chunks are replaced by the records in them."""
    while cursor.left:
        kind = cursor.number(1)
        record = cursor.part(cursor.number(8))
        if kind == 0 or (kind == _CHUNK and is_in_chunk):
            raise UnreadableError("it is damaged: it has a record of no known kind")
        if kind == _CHUNK:
            block = _expanded(record, budget)
            yield from _records(Cursor(BytesIO(block), len(block)), budget, is_in_chunk=True)
        else:
            yield kind, record
        record.skip()


def _expanded(chunk: Cursor, budget: Budget) -> bytes:
    chunk.take(16)
    size, checksum, compression = chunk.number(8), chunk.number(4), chunk.word()
    block = chunk.take(chunk.number(8))
    if compression:
        block = budget.expand(block, compression, size)
    if checksum and crc32(block) != checksum:
        raise UnreadableError("it is damaged: a chunk has a wrong checksum")
    return block


def _digest(channel: Cursor) -> str:
    """Return the type hash in the metadata of a channel, which has QoS texts, too."""
    with suppress(UnreadableError):
        size = min(channel.number(4), _MAX_METADATA_BYTES)
        metadata = Cursor(BytesIO(channel.take(size)), size)
        while metadata.left:
            key, value = metadata.word(), metadata.take(metadata.number(4))
            if key == _DIGEST:
                return value.decode("utf-8", "replace")
    return ""
