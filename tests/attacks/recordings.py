"""Attacks by recordings."""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Callable, Iterator
from pathlib import Path

from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2

from tests.attacks.table import Attack, files
from tests.frontend.recordings import make_recording

__all__ = ["recording_attacks"]

LINE = "=" * 80


def recording_attacks() -> Iterator[Attack]:
    """Yield the attacks of this kind."""
    yield from _files()
    yield from _databases()
    yield from _folders()
    yield from _texts()
    yield from _damaged()


def _bag(name: str, make: Callable[[Path], None], file: str, command: str = "list") -> Attack:
    types = ("p/A",) if command != "list" else ()
    return Attack(name=f"bag_{name}", argv=(command, *types, "--bag", file), make=make, fails=True)


def _files() -> Iterator[Attack]:
    for ending in ("bag", "mcap", "db3"):
        file = f"x.{ending}"

        def fifo(root: Path, file: str = file) -> None:
            os.mkfifo(root / file)

        def sparse(root: Path, file: str = file) -> None:
            (root / file).write_bytes(b"")
            os.truncate(root / file, 1 << 30)

        def device(root: Path, file: str = file) -> None:
            (root / file).symlink_to("/dev/zero")

        yield _bag(f"{ending}_fifo", fifo, file)
        yield _bag(f"{ending}_sparse", sparse, file)
        yield _bag(f"{ending}_device", device, file)
        yield _bag(f"{ending}_empty", files({file: b""}), file)
        yield _bag(f"{ending}_binary", files({file: bytes(range(256)) * 40}), file)
    yield _bag("bag_huge_field", files({"x.bag": b"#ROSBAG V2.0\n" + b"\xff" * 100}), "x.bag")
    magic = b"\x89MCAP0\r\n"
    header = b"\x01" + (1 << 60).to_bytes(8, "little")
    yield _bag("mcap_huge_record", files({"x.mcap": magic + header + b"x" * 90 + magic}), "x.mcap")

    def sparse_bag(root: Path) -> None:
        files({"x.bag": b"#ROSBAG V2.0"})(root)
        os.truncate(root / "x.bag", 1 << 30)

    yield _bag("bag_sparse_magic", sparse_bag, "x.bag")
    yield _bag("db3_header_only", files({"x.db3": b"SQLite format 3\0" + b"\0" * 500}), "x.db3")
    yield _bag("missing", files({}), "x.mcap")
    yield _bag("nul", files({}), "a\0.mcap")
    yield _bag("long", files({}), f"{'a' * 5000}.mcap")
    yield _bag("no_ending", files({"x": b"x"}), "x")


def _databases() -> Iterator[Attack]:
    columns = (
        "CREATE TABLE schema(schema_version, ros_distro);"
        "CREATE TABLE topics(id, name, type, serialization_format, offered_qos_profiles,"
        " type_description_hash);"
        "CREATE TABLE messages(id, topic_id, timestamp, data);"
        "CREATE TABLE message_definitions(id, topic_type, encoding, encoded_message_definition,"
        " type_description_hash);"
    )
    good = {
        "schema": (4, "jazzy"),
        "topics": (1, "/t", "p/msg/A", "cdr", "", "RIHS01_0"),
        "message_definitions": (1, "p/msg/A", "ros2msg", "int8 a", "RIHS01_0"),
    }
    odd = {
        "blob": b"\xff\xfe",
        "number": 7,
        "none": None,
        "huge": "x" * 100_000,
        "real": 1e300,
    }
    for table, row in good.items():
        for column in range(len(row)):
            for what, value in odd.items():
                if (column + len(what) + len(table)) % 3:
                    continue  # A third of all: each column gets some.

                def make(
                    root: Path, table: str = table, column: int = column, value: object = value
                ) -> None:
                    database = sqlite3.connect(root / "x.db3")
                    database.executescript(columns)
                    for name, values in good.items():
                        new = list(values)
                        if name == table:
                            new[column] = value  # type: ignore[call-overload]
                        marks = ", ".join("?" * len(new))
                        database.execute(f"INSERT INTO {name} VALUES ({marks})", new)
                    database.commit()
                    database.close()

                yield Attack(
                    name=f"db3_{table}_{column}_{what}",
                    argv=("plan", "p/A", "--bag", "x.db3"),
                    make=make,
                )


def _folders() -> Iterator[Attack]:
    good = (
        "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n"
        "  relative_file_paths: [x.mcap]\n  duration: {nanoseconds: 1}\n"
        "  starting_time: {nanoseconds_since_epoch: 1}\n  message_count: 1\n"
        "  topics_with_message_count: []\n"
    )
    laughs = "a0: &a0 [x]\n" + "".join(
        f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 10)}]\n" for n in range(1, 9)
    )
    texts: dict[str, str | bytes] = {
        "empty": "",
        "list": "[]",
        "text": "hello",
        "not_yaml": "{{{",
        "binary": bytes(range(256)),
        "laughs": laughs,
        "deep": "[" * 400,
        "tag": "!!python/object/apply:os.system ['touch owned']",
        "no_file": good,
        "file_above": good.replace("[x.mcap]", "[../../etc/passwd]"),
        "files_number": good.replace("[x.mcap]", "7"),
        "files_of_numbers": good.replace("[x.mcap]", "[7]"),
        "version_text": good.replace("version: 5", "version: five"),
        "version_huge": good.replace("version: 5", f"version: {'9' * 5000}"),
        "no_storage": good.replace("mcap\n", "{}\n", 1),
        "topics_number": good.replace("count: []", "count: 7"),
        "topics_none": good.replace("count: []", "count: [null]"),
        "duration_text": good.replace("nanoseconds: 1}", "nanoseconds: long}", 1),
    }
    for name, text in texts.items():
        yield _bag(f"metadata_{name}", files({"x/metadata.yaml": text}), "x")

    def fifo(root: Path) -> None:
        files({"x/metadata.yaml": good})(root)
        os.mkfifo(root / "x/x.mcap")

    def metadata_fifo(root: Path) -> None:
        (root / "x").mkdir()
        os.mkfifo(root / "x/metadata.yaml")

    def metadata_sparse(root: Path) -> None:
        files({"x/metadata.yaml": good})(root)
        os.truncate(root / "x/metadata.yaml", 1 << 30)

    yield _bag("folder_fifo", fifo, "x")
    yield _bag("folder_metadata_fifo", metadata_fifo, "x")
    yield _bag("folder_metadata_sparse", metadata_sparse, "x")
    yield _bag("folder_empty", lambda root: (root / "x").mkdir(), "x")


def _texts() -> Iterator[Attack]:
    def record(name: str, text: str) -> Callable[[Path], None]:
        def make(root: Path) -> None:
            with Writer2(root / "x", version=9, storage_plugin=StoragePlugin.MCAP) as writer:
                hashed = "RIHS01_" + "0" * 64
                writer.add_connection("/t", name, msgdef=text, rihs01=hashed)

        return make

    boom = "".join(f"T0 f{n}\n" for n in range(100))
    for level in range(7):
        fields = "".join(f"T{level + 1} f{n}\n" for n in range(100))
        boom += f"{LINE}\nMSG: p/T{level}\n{fields}"
    boom += f"{LINE}\nMSG: p/T7\nfloat64 x\n"
    texts = {
        "boom": boom,
        "headings": f"{LINE}\nMSG: p/B\n" * 1000,
        "no_names": f"int8 a\n{LINE}\nMSG: \n{LINE}\nMSG: a/b/c/d\n",
        "itself": f"A a\n{LINE}\nMSG: p/A\nA a\n",
        "nul": "int8 a\0\n",
        "long": "#" * 1_000_000,
    }
    for name, text in texts.items():
        for command in ("plan", "show", "metrics"):
            yield Attack(
                name=f"recorded_{name}_{command}",
                argv=(command, "p/A", "--bag", "x"),
                make=record("p/msg/A", text),
                fails=None if command == "metrics" or name in ("headings", "long") else True,
            )
    for name in ("", "/", "p", "p/msg/", "p/msg/A/B", "p//A", "..", "p/msg/A\n", "p/msg/\x1b[2J"):
        yield Attack(
            name=f"recorded_name_{name.encode().hex()}",
            argv=("list", "--bag", "x"),
            make=record(name, "int8 a\n"),
        )


def _damaged() -> Iterator[Attack]:
    for form in ("bag", "mcap", "db3"):
        for number in range(6):

            def make(root: Path, form: str = form, number: int = number) -> None:
                whole = make_recording(root, form)
                file = whole if whole.is_file() else next(whole.glob(f"*.{form}"))
                data = bytearray(file.read_bytes())
                if number % 2:
                    del data[len(data) * number // 6 :]
                else:
                    place = len(data) * (number + 1) // 8
                    data[place : place + 16] = b"\xff" * 16
                (root / f"x.{form}").write_bytes(data)

            yield Attack(
                name=f"damaged_{form}_{number}",
                argv=("verify", "my_msgs/Wheel", "--bag", f"x.{form}"),
                make=make,
            )
