"""Results of a run as JSON lines, so that they survive the end of the process.

The first line has the options of the run and its planned tests. Each other line is a record, or the
environment or the end of a session. A record is on the disk before it is counted. A run that was
stopped can be continued with the same file, and does not repeat the tests in the file. A last line
without a line end is dropped, because its writer was killed. Only a run with the same options and
the same tests can continue a file. Otherwise, the figures of the file would mean nothing.
"""

from __future__ import annotations

import fcntl
import hashlib
import json
import math
import os
import platform
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import datetime, timezone
from importlib.metadata import PackageNotFoundError, version
from io import FileIO
from pathlib import Path
from typing import Any

import firm_hdl
from firm_hdl.errors import UserError
from firm_hdl.files import read_file
from firm_hdl.verify.results.records import Record, Test, from_json, to_json

__all__ = [
    "FORMAT",
    "Results",
    "ResultsError",
    "ResultsWriter",
    "code_digest",
    "environment",
    "inputs_digest",
    "read_results",
]

FORMAT = "firm-hdl results 2"


# The results of a thousand types on seven widths have a hundredth of this size.
_MOST_BYTES = 1 << 28
# The first line has all tests. Each line is read as a whole, and takes up to thirty times its size.
_MOST_LINE_BYTES = 1 << 25


class ResultsError(UserError):
    """A file contains no results, or the results of another run; the text names file and reason."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Results:
    """The content of a file."""

    options: Mapping[str, Any] = field(default_factory=dict)  # The options of the run.
    planned: tuple[Test, ...] = ()  # All tests of the run, with and without records.
    # Records by key. The last of several records with the same key counts.
    records: Mapping[str, Record] = field(default_factory=dict)
    sessions: tuple[Mapping[str, str], ...] = ()  # The environment of each session.
    # Why the last session failed; empty if it did not, `None` if it has not ended.
    failure: str | None = ""

    @property
    def missing(self) -> tuple[Test, ...]:
        """Tests without a record."""
        return tuple(test for test in self.planned if test.key not in self.records)


def read_results(path: str | os.PathLike[str]) -> Results:
    """Read a file of results, without a last line that has no line end.

    Raises `OSError`. Raises `ResultsError` if the file does not contain results.
    """
    return _read(Path(path))[0]


def _read(path: Path) -> tuple[Results, int]:
    """Return the content of a file, and the number of bytes in its complete lines."""
    data = read_file(path, _MOST_BYTES)
    whole = data.rfind(b"\n") + 1
    lines = data[:whole].splitlines()
    if not lines:
        if data and not f'{{"format": "{FORMAT}"'.encode().startswith(data[:20]):
            raise ResultsError(f"'{path}' has no results of firm-hdl verify")
        return Results(failure=None), 0
    options, planned = _header(path, lines[0])
    records: dict[str, Record] = {}
    sessions: list[Mapping[str, str]] = []
    failure: str | None = None
    for number, line in enumerate(lines[1:], 2):
        try:
            given = _value(line)
            if "session" in given:
                sessions.append(_texts(given["session"]))
                failure = None
            elif "failure" in given:
                failure = _texts(given)["failure"]
            else:
                record = from_json(Record, given["record"])
                records[record.test.key] = record
        except _DAMAGE:
            raise ResultsError(f"'{path}', line {number}: it is damaged") from None
    found = Results(
        options=options,
        planned=planned,
        records=records,
        sessions=tuple(sessions),
        failure=failure,
    )
    return found, whole


_DAMAGE = (ValueError, KeyError, TypeError, AttributeError, RecursionError)


def _header(path: Path, line: bytes) -> tuple[Mapping[str, Any], tuple[Test, ...]]:
    is_ours = line.startswith(f'{{"format": "{FORMAT}"'.encode())
    try:
        given = _value(line)
        is_ours = given["format"] == FORMAT
        if not is_ours or not isinstance(given["options"], dict):
            raise ValueError("no options")
        return given["options"], tuple(from_json(Test, test) for test in given["planned"])
    except _DAMAGE:
        if not is_ours:
            raise ResultsError(f"'{path}' has no results of firm-hdl verify") from None
        raise ResultsError(f"'{path}', line 1: it is damaged") from None


def _value(line: bytes) -> Any:
    """Read a line. Refuse numbers that Python reads, but that reports cannot write."""

    def finite(text: str) -> float:
        if not math.isfinite(value := float(text)):
            raise ValueError(text)
        return value

    if len(line) > _MOST_LINE_BYTES:
        raise ValueError("too long")
    return json.loads(line, parse_float=finite, parse_constant=finite)


def _texts(given: object) -> Mapping[str, str]:
    if not isinstance(given, dict) or not all(isinstance(each, str) for each in given.values()):
        raise ValueError("not an object of texts")
    return given


class ResultsWriter:
    """A file of results to add to; a context manager.

    Parameters
    ----------
    path : path
        A new file, or one to continue.
    options : mapping of str to object
        The options of the run, in values that JSON can represent.
    planned : sequence of Test
        All tests of the run.
    session : mapping of str to str
        The environment of this session.

    Attributes
    ----------
    before : Results
        The content of the file when it was opened.

    Raises
    ------
    ResultsError
        If the file does not contain results, or those of a run with other options or tests, or
        if another process writes to it.
    OSError
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        *,
        options: Mapping[str, Any],
        planned: Sequence[Test],
        session: Mapping[str, str] | None = None,
    ):
        self.path = Path(path)
        self.path.parent.mkdir(parents=True, exist_ok=True)
        # Unbuffered, and each write is appended.
        self._file = FileIO(os.open(self.path, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o666), "a")
        try:
            self.before = self._open(json.loads(json.dumps(dict(options))), planned)
            if session:
                self._write({"session": dict(session)})
        except BaseException:
            self._file.close()
            raise

    def _open(self, options: Mapping[str, Any], planned: Sequence[Test]) -> Results:
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise ResultsError(f"'{self.path}' is being written by another run") from None
        found, whole = _read(self.path)
        os.ftruncate(self._file.fileno(), whole)
        if not whole:
            tests = tuple(planned)
            self._write({"format": FORMAT, "options": options, "planned": to_json(tests)})
            _sync_folder(self.path.parent)
            return Results(options=options, planned=tests)
        if different := "; ".join(_differences(found, options, planned)):
            raise ResultsError(
                f"'{self.path}' is of another run: {different}; name another file, or remove it"
            )
        return found

    def add(self, *records: Record) -> None:
        """Add records; they are on the disk when this returns."""
        self._write(*({"record": to_json(record)} for record in records))

    def conclude(self, failure: str) -> None:
        """Add the end of the session: why it failed, or an empty text."""
        self._write({"failure": failure})

    def _write(self, *lines: Mapping[str, Any]) -> None:
        text = "".join(f"{json.dumps(line, allow_nan=False)}\n" for line in lines)
        left = memoryview(text.encode())
        while left:
            left = left[self._file.write(left) :]
        os.fsync(self._file.fileno())

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def __enter__(self) -> ResultsWriter:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()


def _sync_folder(folder: Path) -> None:
    # Write the new file's name to the disk as well, if the system can sync folders.
    with suppress(OSError):
        number = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(number)
        finally:
            os.close(number)


def _differences(
    before: Results, options: Mapping[str, Any], planned: Collection[Test]
) -> Iterator[str]:
    for name in sorted({*before.options, *options}):
        old, new = (_option_text(each, name) for each in (before.options, options))
        if old != new:
            yield f"{name} was {old}, and is {new}"
    new_keys = {test.key for test in planned}
    old_keys = {test.key for test in before.planned}
    for what, keys in (("not in it", new_keys - old_keys), ("only in it", old_keys - new_keys)):
        if keys:
            tests = "test is" if len(keys) == 1 else "tests are"
            yield f"{len(keys)} {tests} {what}, such as '{min(keys)}'"


def _option_text(options: Mapping[str, Any], name: str) -> str:
    return json.dumps(options[name]) if name in options else "not given"


PACKAGES = (
    "amaranth",
    "rosbags",
    "cyclonedds",
    "mcap-ros1-support",
    "mcap-ros2-support",
    "numpy",
    "lark",
)

_INPUTS = (".msg", ".srv", ".action", ".idl", ".xml", ".yaml")
"""Suffixes of the files that definitions, packages and golden plans are read from."""

_MOST_INPUT_BYTES = 1 << 22
"""No definition is larger (`firm_hdl.frontend.sources`). Of a larger file, only the size counts."""


def environment() -> dict[str, str]:
    """Return names and versions, none of which identifies a user or a machine."""
    found = {
        "started": datetime.now(timezone.utc).strftime("%Y-%m-%d %H:%M UTC"),
        "firm-hdl": firm_hdl.__version__,
        "Python": platform.python_version(),
        "system": f"{platform.system()} {platform.machine()}",
        "processors": str(os.cpu_count()),
    }
    for name in PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found


def code_digest() -> str:
    """Return a digest of the package's own files. Results of other code cannot be continued."""
    root = Path(firm_hdl.__file__).parent
    digest = hashlib.sha256()
    for path in sorted(root.rglob("*")):
        if path.suffix in (".py", ".lark", ".cpp", ".h", ".j2", ".vhd"):
            digest.update(f"{path.relative_to(root).as_posix()}\0".encode())
            digest.update(path.read_bytes() + b"\0")
    return digest.hexdigest()[:12]


def inputs_digest(paths: Iterable[str]) -> str:
    """Return a digest of the files that a run reads. Results of other inputs cannot be continued.

    In folders, the names and texts of definitions, ``package.xml`` and golden plans count. Of any
    other file, such as a recording, the size and the time of the last change count.
    """
    digest = hashlib.sha256()
    for path in paths:
        for name in _files(path):
            digest.update(f"{os.path.relpath(name, path)}\0".encode(errors="surrogateescape"))
            digest.update(_content(name) + b"\0")
    return digest.hexdigest()[:12]


def _files(path: str) -> Iterator[str]:
    """Yield a file itself, or the relevant files of a folder in order; links are followed."""
    if not os.path.isdir(path):
        yield path
    seen: set[str] = set()
    for folder, folders, names in os.walk(path, followlinks=True):
        real = os.path.realpath(folder)
        if real in seen:
            folders.clear()
            continue
        seen.add(real)
        folders.sort()
        is_bag = "metadata.yaml" in names
        yield from (
            os.path.join(folder, name) for name in sorted(names) if is_bag or name.endswith(_INPUTS)
        )


def _content(path: str) -> bytes:
    try:
        if path.endswith(_INPUTS):
            return read_file(path, _MOST_INPUT_BYTES)
        status = os.stat(path)
    except OSError as error:
        return str(error.strerror).encode()
    return f"{status.st_size} {status.st_mtime_ns}".encode()
