"""Recordings, made by rosbags for one test."""

from __future__ import annotations

import sqlite3
from pathlib import Path

from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

__all__ = ["FORMATS", "make_old_db3", "make_recording", "record", "record_in_idl"]

FORMATS = ["bag", "mcap", "db3"]

# A type that exists only in these recordings.
_WHEEL = "uint8 LEFT=0\nstd_msgs/Header header\nfloat32 speed\nmy_msgs/Spot[] spots\n"
_SPOT = "int16 a\nstring b\n"


def make_recording(folder: Path, form: str) -> Path:
    """Record a topic of `my_msgs/Wheel` without, and one of `std_msgs/String` with a message."""
    store = get_typestore(Stores.ROS1_NOETIC if form == "bag" else Stores.ROS2_JAZZY)
    store.register(
        get_types_from_msg(_WHEEL, "my_msgs/msg/Wheel")
        | get_types_from_msg(_SPOT, "my_msgs/msg/Spot")
    )
    text = store.types["std_msgs/msg/String"](data="x")
    name = "std_msgs/msg/String"
    if form == "bag":
        path = folder / "run.bag"
        with Writer1(path) as writer:
            writer.add_connection("/wheel", "my_msgs/msg/Wheel", typestore=store)
            connection = writer.add_connection("/text", name, typestore=store)
            writer.write(connection, 1, store.serialize_ros1(text, name))
        return path
    plugin = StoragePlugin.MCAP if form == "mcap" else StoragePlugin.SQLITE3
    with Writer2(folder / form, version=9, storage_plugin=plugin) as writer2:
        writer2.add_connection("/wheel", "my_msgs/msg/Wheel", typestore=store)
        connection = writer2.add_connection("/text", name, typestore=store)
        writer2.write(connection, 1, store.serialize_cdr(text, name))
    return folder / form


def make_old_db3(path: Path, types: list[str]) -> Path:
    """Make a database in the form of ROS 2 humble, without definitions."""
    with sqlite3.connect(path) as database:
        database.executescript(
            "CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);"
            "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,"
            " serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
            "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,"
            " timestamp INTEGER NOT NULL, data BLOB NOT NULL);"
            "INSERT INTO schema VALUES (3, 'humble');"
        )
        for index, name in enumerate(types, start=1):
            row = index, f"/t{index}", name, "cdr", ""
            database.execute("INSERT INTO topics VALUES (?, ?, ?, ?, ?)", row)
    database.close()
    return path


def record(path: Path, name: str, text: str, *more: tuple[str, str]) -> Path:
    """Record topics with given definitions; the hashes in the recording are wrong."""
    with Writer2(path, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        for index, (type_name, definition) in enumerate([(name, text), *more]):
            hashed = "RIHS01_" + "0" * 64
            writer.add_connection(f"/t{index}", type_name, msgdef=definition, rihs01=hashed)
    return path


def record_in_idl(path: Path, name: str, text: str, *more: tuple[str, str]) -> Path:
    """Record topics as `record` does, with definitions in IDL; they may lack their headings."""
    (file,) = record(path, name, text, *more).glob("*.mcap")
    data = file.read_bytes()
    assert data.count(b"ros2msg") >= 1 + len(more)
    file.write_bytes(data.replace(b"ros2msg", b"ros2idl"))
    return path
