"""Recordings made by hand, byte by byte: what no library for writing them would write."""

from __future__ import annotations

import sqlite3
import struct
from collections.abc import Mapping
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path

from firm_hdl.recordings import Recording, Topic

__all__ = [
    "TABLES",
    "Channel",
    "bag_record",
    "mcap_record",
    "messages",
    "write_bag",
    "write_db3",
    "write_mcap",
]

_MAGIC = b"\x89MCAP0\r\n"

TABLES = """
CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
  serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL,
  type_description_hash TEXT NOT NULL);
CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL,
  encoding TEXT NOT NULL, encoded_message_definition TEXT NOT NULL,
  type_description_hash TEXT NOT NULL);
CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,
  timestamp INTEGER NOT NULL, data BLOB NOT NULL);
"""
"""The tables that rosbag2 makes since iron."""


@dataclass(frozen=True, kw_only=True)
class Channel:
    """A topic, the definition of its type, and its messages.

    Attributes
    ----------
    schema : str or None
        The name of the definition's type, if it is not `type`.
    """

    topic: str = "/s"
    type: str = "std_msgs/msg/String"
    text: str | bytes = "string data\n"
    language: str = "ros2msg"
    wire: str = "cdr"
    schema: str | None = None
    metadata: Mapping[str, str] = field(default_factory=dict)
    messages: tuple[tuple[int, bytes], ...] = ()


def messages(path: Path) -> list[tuple[Topic, int, bytes]]:
    """Read all messages of a recording."""
    recording = Recording(path)
    return list(recording.messages(recording.topics))


def _text(value: str | bytes) -> bytes:
    data = value.encode() if isinstance(value, str) else value
    return struct.pack("<I", len(data)) + data


def mcap_record(kind: int, data: bytes) -> bytes:
    """Return a record of MCAP."""
    return struct.pack("<BQ", kind, len(data)) + data


def write_mcap(
    path: Path, *channels: Channel, profile: str = "ros2", summary: bool = False, more: bytes = b""
) -> Path:
    """Write an MCAP file without chunks. A summary repeats the definitions.

    The times are those of the log; the times of publishing are 0.
    """
    definitions, messages = more, b""
    for number, each in enumerate(channels, start=1):
        name = each.schema or each.type
        schema = struct.pack("<H", number) + _text(name) + _text(each.language) + _text(each.text)
        channel = struct.pack("<HH", number, number) + _text(each.topic) + _text(each.wire)
        channel += _text(b"".join(_text(key) + _text(v) for key, v in each.metadata.items()))
        definitions += mcap_record(3, schema) + mcap_record(4, channel)
        for time, data in each.messages:
            messages += mcap_record(5, struct.pack("<HIQQ", number, 0, time, 0) + data)
    body = _MAGIC + mcap_record(1, _text(profile) + _text("")) + definitions + messages
    end = struct.pack("<QQI", len(body) if summary else 0, 0, 0)
    path.write_bytes(body + definitions * summary + mcap_record(2, end) + _MAGIC)
    return path


def write_db3(path: Path, *channels: Channel, distro: str = "jazzy", tables: str = TABLES) -> Path:
    """Write a database as rosbag2 does; one from before iron has other `tables`."""
    with closing(sqlite3.connect(path)) as database, database:
        database.executescript(tables)
        database.execute("INSERT INTO schema VALUES (4, ?)", [distro])
        has_definitions = "message_definitions" in tables
        for number, each in enumerate(channels, start=1):
            row = [number, each.topic, each.type, each.wire, each.metadata.get("qos", "")]
            row += [""] * has_definitions
            database.execute(f"INSERT INTO topics VALUES ({', '.join('?' * len(row))})", row)
            if has_definitions:
                row = [number, each.schema or each.type, each.language, each.text, ""]
                database.execute("INSERT INTO message_definitions VALUES (?, ?, ?, ?, ?)", row)
            for time, data in each.messages:
                values = number, time, data
                database.execute(
                    "INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)", values
                )
    return path


def bag_record(header: Mapping[str, bytes], data: bytes = b"") -> bytes:
    """Return a record of a bag."""
    fields = b"".join(_text(name.encode() + b"=" + value) for name, value in header.items())
    return _text(fields) + _text(data)


def write_bag(path: Path, *channels: Channel, header: Mapping[str, bytes] | None = None) -> Path:
    """Write a bag without chunks; `header` replaces fields of its first record."""
    records: list[bytes] = []
    connections: list[bytes] = []
    for number, each in enumerate(channels):
        conn = struct.pack("<I", number)
        text = each.text.encode() if isinstance(each.text, str) else each.text
        fields = {"topic": each.topic.encode(), "type": each.type.encode(), "md5sum": b"0" * 32}
        data = b"".join(
            _text(f"{key}=".encode() + value)
            for key, value in {**fields, "message_definition": text}.items()
        )
        head = {"op": b"\7", "conn": conn, "topic": each.topic.encode()}
        connections.append(bag_record(head, data))
        for time, message in each.messages:
            stamp = struct.pack("<II", time // 10**9, time % 10**9)
            records.append(bag_record({"op": b"\2", "conn": conn, "time": stamp}, message))

    def start(index: int) -> bytes:
        first = {"op": b"\3", "index_pos": struct.pack("<Q", index), **(header or {})}
        return b"#ROSBAG V2.0\n" + bag_record(first, b" " * 100)

    body = b"".join(records)
    path.write_bytes(start(len(start(0)) + len(body)) + body + b"".join(connections))
    return path
