"""Databases of rosbag2: what is read of them, and that nothing in them is run."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.recordings import MAX_TEXT_BYTES, MAX_TOPICS, Recording
from tests.recordings.files import TABLES, Channel, messages, write_db3

GOOD = Channel(messages=((1, b"\0\1\0\0"),))
ENDLESS = "WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c) SELECT x"


def change(path: Path, script: str) -> Path:
    with closing(sqlite3.connect(path)) as database, database:
        database.executescript(f"BEGIN; {script}; COMMIT")
    return path


def refused(path: Path) -> str:
    with pytest.raises(DefinitionError) as caught:
        messages(path)
    return str(caught.value)


@pytest.mark.parametrize(
    ("script", "reason"),
    [
        (
            f"DROP TABLE topics; CREATE VIEW topics AS {ENDLESS} AS id, 'a' AS name, "
            "'std_msgs/msg/String' AS type, 'cdr' AS serialization_format FROM c",
            "with a view, a trigger or a virtual table",
        ),
        (
            "DROP TABLE messages; CREATE VIEW messages AS SELECT 1 AS topic_id, 1 AS timestamp, "
            "zeroblob(900000000) AS data",
            "with a view, a trigger or a virtual table",
        ),
        ("CREATE VIEW other AS SELECT 1", "with a view, a trigger or a virtual table"),
        (
            "CREATE TRIGGER t AFTER INSERT ON topics BEGIN SELECT 1; END",
            "with a view, a trigger or a virtual table",
        ),
        (
            "CREATE VIRTUAL TABLE t USING rtree(id, a, b)",
            "with a view, a trigger or a virtual table",
        ),
        (
            "ALTER TABLE topics ADD COLUMN x AS (hex(zeroblob(400000000)))",
            "with generated columns",
        ),
        ("ALTER TABLE messages RENAME TO m", "without the tables of a recording"),
    ],
)
def test_databases_that_compute_are_refused(tmp_path: Path, script: str, reason: str) -> None:
    path = change(write_db3(tmp_path / "x.db3", GOOD), script)
    assert refused(path) == (
        f"error: '{path}' cannot be read as a recording: it is a database {reason}"
    )


def test_pages_that_are_used_again_and_again_end(tmp_path: Path) -> None:
    """A tree of a few pages, each of which refers to the next one hundreds of times."""
    many = Channel(messages=tuple((number, b"") for number in range(40_000)))
    path = write_db3(tmp_path / "x.db3", many, tables=f"PRAGMA page_size = 1024; {TABLES}")
    data = bytearray(path.read_bytes())
    with closing(sqlite3.connect(path)) as database:
        (root,) = database.execute("SELECT rootpage FROM sqlite_master WHERE name = 'messages'")
    size, page = int.from_bytes(data[16:18], "big"), root[0]

    def children(number: int) -> list[int]:
        """List where an interior page has the numbers of its children; none of a leaf."""
        start = (number - 1) * size
        if data[start] != 5:
            return []
        count = int.from_bytes(data[start + 3 : start + 5], "big")
        cells = range(start + 12, start + 12 + 2 * count, 2)
        return [start + 8, *(start + int.from_bytes(data[c : c + 2], "big") for c in cells)]

    def child(place: int) -> int:
        return int.from_bytes(data[place : place + 4], "big")

    # The last page of interior ones is the least full.
    _, one, two, *_ = (child(place) for place in children(page))
    leaf = child(children(two)[1])
    for parent, only in ((page, one), (one, two), (two, leaf)):
        for place in children(parent):
            data[place : place + 4] = only.to_bytes(4, "big")
    path.write_bytes(data)
    assert "SQLite takes more steps than its size allows for" in refused(path)


def test_values_that_the_file_has_once_count_for_each_row(tmp_path: Path) -> None:
    rows = "".join(f"INSERT INTO messages VALUES ({n}, 1, 1);" for n in range(1000))
    path = change(
        write_db3(tmp_path / "x.db3", Channel(messages=())),
        "DROP TABLE messages; CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id, timestamp);"
        f"{rows} ALTER TABLE messages ADD COLUMN data DEFAULT x'{'00' * 500_000}'",
    )
    assert "it expands to more than" in refused(path)


def test_the_distribution_and_definitions_without_a_topic_are_read(tmp_path: Path) -> None:
    event = Channel(type="p/srv/S_Event", schema="p/srv/S", text="int8 a\n---\nint8 b\n")
    recording = Recording(write_db3(tmp_path / "x.db3", GOOD, event, distro="kilted"))
    assert recording.distro == "kilted"
    assert [schema.type for schema in recording.schemas] == ["std_msgs/msg/String", "p/srv/S"]
    assert [topic.type for topic in recording.topics] == ["std_msgs/msg/String", "p/srv/S_Event"]


def test_databases_of_old_releases_have_fewer_tables_and_columns(tmp_path: Path) -> None:
    old = TABLES[: TABLES.index("CREATE TABLE message_definitions")]
    old = old.replace(",\n  type_description_hash TEXT NOT NULL", "", 1)
    old += TABLES[TABLES.index("CREATE TABLE messages") :]
    path = write_db3(tmp_path / "x.db3", GOOD, distro="humble", tables=old)
    for distro in ("humble", ""):
        recording = Recording(path)
        assert (recording.distro, recording.schemas) == (distro, [])
        assert [data for _, _, data in messages(path)] == [b"\0\1\0\0"]
        change(path, "DROP TABLE IF EXISTS schema")


def test_texts_that_are_too_long_are_left_out(tmp_path: Path) -> None:
    qos = {"qos": "x" * 10_000_000}
    long = Channel(type="p/msg/A", text="#" * (MAX_TEXT_BYTES + 1), metadata=qos)
    recording = Recording(write_db3(tmp_path / "x.db3", long, GOOD))
    assert [schema.data for schema in recording.schemas] == [None, b"string data\n"]


@pytest.mark.parametrize("table", ["topics", "message_definitions"])
def test_the_numbers_of_topics_and_of_definitions_have_a_limit(tmp_path: Path, table: str) -> None:
    path = write_db3(tmp_path / "x.db3", GOOD)
    with closing(sqlite3.connect(path)) as database, database:
        count = len(list(database.execute(f"PRAGMA table_info({table})"))) - 1
        rows = ((number, *["x"] * count) for number in range(2, MAX_TOPICS + 2))
        database.executemany(f"INSERT INTO {table} VALUES (?{', ?' * count})", rows)
    assert f"it has more than {MAX_TOPICS} topics or types" in refused(path)


@pytest.mark.parametrize("values", ["'x', x'00'", "1, 'text'", "NULL, x'00'", "1, 7"])
def test_messages_without_a_time_or_bytes_are_damage(tmp_path: Path, values: str) -> None:
    path = change(
        write_db3(tmp_path / "x.db3", GOOD),
        "DROP TABLE messages; CREATE TABLE messages(topic_id, timestamp, data);"
        f"INSERT INTO messages VALUES (1, {values})",
    )
    assert "it is damaged: a message has no time or no bytes" in refused(path)


def test_nothing_is_written_beside_the_file(tmp_path: Path) -> None:
    path = write_db3(tmp_path / "x.db3", GOOD)
    # A journal that SQLite would roll back, into the file.
    (tmp_path / "x.db3-journal").write_bytes(b"\xd9\xd5\x05\xf9\x20\xa1\x63\xd7" + bytes(1000))
    before = {each.name: each.read_bytes() for each in tmp_path.iterdir()}
    assert len(messages(path)) == 1
    assert {each.name: each.read_bytes() for each in tmp_path.iterdir()} == before


def test_a_large_database_may_take_more_steps(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr("firm_hdl.recordings.database._MIN_CALLS", 20)
    rows = "WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c LIMIT 10000)"
    path = change(
        write_db3(tmp_path / "x.db3", Channel(messages=())),
        f"{rows} INSERT INTO messages(topic_id, timestamp, data) SELECT 1, x, x'00' FROM c",
    )
    assert len(messages(path)) == 10_000
