"""Which tests run which lines: found out once for each test file, and kept.

A file's part of the map holds as long as the program, what tests share, and the file itself stay
as they are.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from queue import Queue
from typing import Any

from coverage import CoverageData

from tests.mutation import trace
from tests.mutation.systems import test_files
from tests.mutation.workshop import Workshop

__all__ = ["SHARED", "BrokenTreeError", "CoverageMap", "Part", "Test", "read_map", "tree_digest"]

# What is run for all tests of a file, whichever comes first.
SHARED = "+"
PROGRAM = ("firm_hdl", "examples", "pyproject.toml")
SECONDS = 7200


class BrokenTreeError(Exception):
    """Tests fail without any fault."""


@dataclass(frozen=True)
class Test:
    """A test that passes without a fault.

    Attributes
    ----------
    name : str
        As pytest calls it.
    cpu_seconds : float
        What it takes, with the processes that it starts, while lines are counted.
    opaque : bool
        It may run lines that the map does not know of.
    """

    __test__ = False

    name: str
    cpu_seconds: float
    opaque: bool

    @property
    def file(self) -> str:
        """The file it is in."""
        return self.name.partition("::")[0]

    @property
    def function(self) -> str:
        """Its name without parameters."""
        return self.name.partition("[")[0]


@dataclass(frozen=True)
class Part:
    """The map of one test file.

    Attributes
    ----------
    tests : list of Test
    lines : mapping of str to mapping of str to int
        By file of the program, and by number of the test or `SHARED`: the lines that were run; bit
        n for line n.
    """

    tests: list[Test]
    lines: Mapping[str, Mapping[str, int]]


@dataclass(frozen=True)
class CoverageMap:
    """The map of all test files.

    Attributes
    ----------
    parts : list of Part
    complete : bool
        No test of the suite was left out.
    tree : str
        Names the program and its tests.
    """

    parts: list[Part]
    complete: bool
    tree: str

    def running(self, path: str, lines: Iterable[int]) -> Iterator[tuple[Test, bool]]:
        """Yield tests for which one of some lines was run, and whether they ran it themselves."""
        wanted = sum(1 << line for line in set(lines))
        for part in self.parts:
            masks = part.lines.get(path, {})
            shared = bool(masks.get(SHARED, 0) & wanted)
            for number, test in enumerate(part.tests):
                own = bool(masks.get(str(number), 0) & wanted)
                if own or shared:
                    yield test, own

    def opaque(self) -> list[Test]:
        """Return the tests of which not all is known."""
        return [test for part in self.parts for test in part.tests if test.opaque]

    def touching(self, path: str) -> set[str]:
        """Return the names of tests that run something of a file, or folder, themselves."""
        return {
            test.name
            for part in self.parts
            for number, test in enumerate(part.tests)
            if any(
                str(number) in masks
                for name, masks in part.lines.items()
                if name == path or (path.endswith("/") and name.startswith(path))
            )
        }


def tree_digest(root: Path, files: Sequence[str]) -> str:
    """Name the program and some of its tests by what is in them."""
    return _digest([_base(root), *(_content(root / name) for name in sorted(files))])


def read_map(
    root: Path,
    folder: Path,
    files: Sequence[str],
    *,
    each: float | None,
    complete: bool,
    workshops: Queue[Workshop],
    say: Callable[[str], None],
) -> CoverageMap:
    """Return the map of test files; find out what `folder` does not have.

    Parameters
    ----------
    files : sequence of str
    each : float or None
        Take no more sets of parameters of a test that has taken so many seconds of the processor.
    complete : bool
        Whether `files` are all there are.
    workshops : Queue of Workshop
        Copies to run them in; all come back.
    say : callable
        Gets a line on each file that is run.

    Raises
    ------
    BrokenTreeError
        If a test fails.
    """
    base = _base(root)

    def one(name: str) -> Part:
        key = _digest([base, name, _content(root / name), str(each), sys.version])
        kept = folder / f"{key}.json"
        part = _load(kept)
        if part is None:
            workshop = workshops.get()
            try:
                part = _trace(workshop, name, each)
            finally:
                workshops.put(workshop)
            _store(kept, part)
            seconds = sum(test.cpu_seconds for test in part.tests)
            say(f"map: {name}, {len(part.tests)} tests, {seconds:.1f} s")
        return part

    pool = ThreadPoolExecutor(workshops.qsize())
    try:
        parts = list(pool.map(one, files))
    finally:
        pool.shutdown(cancel_futures=True)
    tree = tree_digest(root, test_files(root))
    return CoverageMap(parts=parts, complete=complete and not each, tree=tree)


def _base(root: Path) -> str:
    """Digest what no test file is, and every test may depend on."""
    paths = [path for name in PROGRAM for path in _files(root / name)]
    paths += [path for path in _files(root / "tests") if not path.name.startswith("test_")]
    own = root / "tests" / "mutation"
    kept = sorted(path for path in paths if own not in path.parents)
    return _digest([f"{path.relative_to(root)} {_content(path)}" for path in kept])


def _files(path: Path) -> list[Path]:
    if path.is_file():
        return [path]
    return [each for each in path.rglob("*") if each.is_file() and "__pycache__" not in each.parts]


def _content(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _digest(texts: Iterable[str]) -> str:
    return hashlib.sha256("\n".join(texts).encode()).hexdigest()[:16]


def _trace(workshop: Workshop, name: str, each: float | None) -> Part:
    """Run a test file and see what its tests run."""
    folder = workshop.root.parent / f"{workshop.root.name}.trace"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    source = workshop.root / "firm_hdl"
    (folder / "settings").write_text(trace.SETTINGS.format(folder=folder, source=source))
    environment = {
        trace.FOLDER: str(folder),
        trace.EACH: str(each or ""),
        "COVERAGE_CORE": "ctrace",
    }
    options = ["-p", "tests.mutation.trace", name]
    run = workshop.run(options, SECONDS, environment, seconds=SECONDS)
    if run.status != "passed":
        raise BrokenTreeError(f"fails without a fault: {run.by or name}")
    written = folder / "tests.json"
    if not written.exists():
        raise BrokenTreeError(f"{name} left no lines: {workshop.output()[-300:]}")
    part = _part(workshop.root, json.loads(written.read_text()), folder)
    shutil.rmtree(folder)
    return part


def _part(root: Path, given: list[dict[str, Any]], folder: Path) -> Part:
    """Collect the lines of all processes."""
    lines: dict[str, dict[str, int]] = {}
    saved: Counter[str] = Counter()
    here = os.path.realpath(root)
    for file in sorted(folder.glob("data.*")):
        saved[file.name.split(".")[1]] += 1
        data = CoverageData(str(file))
        data.read()
        for path in data.measured_files():
            masks = lines.setdefault(os.path.relpath(os.path.realpath(path), here), {})
            for line, contexts in data.contexts_by_lineno(path).items():
                for context in contexts:
                    for owner in _owners(context):
                        masks[owner] = masks.get(owner, 0) | 1 << line
        data.close()
    tests = [
        Test(
            name=each["id"],
            cpu_seconds=round(each["cpu"], 3),
            opaque=each["lost"] or saved[str(number)] < each["started"],
        )
        for number, each in enumerate(given)
    ]
    return Part(tests=tests, lines=lines)


def _owners(context: str) -> list[str]:
    number = context.removeprefix("+")
    if not number:
        return [SHARED]
    return [number, SHARED] if context.startswith("+") else [number]


def _load(path: Path) -> Part | None:
    if not path.exists():
        return None
    given = json.loads(path.read_text())
    return Part(
        tests=[Test(**each) for each in given["tests"]],
        lines={
            name: {owner: int(mask, 16) for owner, mask in masks.items()}
            for name, masks in given["lines"].items()
        },
    )


def _store(path: Path, part: Part) -> None:
    """Write a part, whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    lines = {
        name: {owner: f"{mask:x}" for owner, mask in masks.items()}
        for name, masks in part.lines.items()
    }
    new = path.with_suffix(".new")
    new.write_text(json.dumps({"tests": [asdict(each) for each in part.tests], "lines": lines}))
    new.replace(path)
