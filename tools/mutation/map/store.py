"""Measure which tests run which lines, once for each test file, and store the result.

The part of a test file is valid until that file changes. If only the program has changed, the lines
of the part are those of the old text. They are mapped to lines of the new text, and the part is
`stale`. ``--fresh`` runs such files again.
"""

from __future__ import annotations

import difflib
import hashlib
import json
import os
import shutil
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from queue import Queue
from statistics import mean
from typing import Any

from coverage import CoverageData
from coverage.exceptions import DataError

from tools.mutation.map import trace
from tools.mutation.map.coverage_map import SHARED, CoverageMap, Part, Test
from tools.mutation.systems import test_files
from tools.mutation.workshop import Workshop

__all__ = ["BrokenTreeError", "moved", "read_map", "tree_digest"]

PROGRAM = ("firm_hdl", "examples", "pyproject.toml")
SECONDS = 7200
# Number of attempts, because a test that waits may fail on a busy machine.
ATTEMPTS = 2
Lines = Mapping[str, Mapping[str, int]]


class BrokenTreeError(Exception):
    """A test fails without any fault."""


def tree_digest(root: Path, files: Sequence[str]) -> str:
    """Return a digest of the program and of some of its tests."""
    program = [path for name in PROGRAM for path in _files(root / name)]
    return _digest_of(root, [*program, *_helpers(root), *(root / name for name in files)])


@dataclass(frozen=True)
class _Kept:
    """A part, and the digests of the files from which it was made.

    Attributes
    ----------
    part : Part
    made_of : mapping
        Data that must be unchanged. Otherwise the part is not valid.
    around : str
        Digest of the files that tests share, other than the program's modules.
    sources : mapping
        Digests of the modules that have lines in the part.
    """

    part: Part
    made_of: Mapping[str, Any]
    around: str
    sources: Mapping[str, str]


def read_map(
    root: Path,
    folder: Path,
    files: Sequence[str],
    *,
    each: float | None,
    complete: bool,
    fresh: bool,
    workshops: Queue[Workshop],
    say: Callable[[str], None],
) -> CoverageMap:
    """Return the map of test files; measure the parts that `folder` does not have.

    Parameters
    ----------
    files : sequence of str
    each : float or None
        Processor time after which no more sets of parameters of a test are measured.
    complete : bool
        Whether `files` are all test files.
    fresh : bool
        Run files with a stale part again.
    workshops : Queue of Workshop
        Copies in which tests run. All are put back into the queue.
    say : callable
        Called with a line of text for each file that is run.

    Raises
    ------
    BrokenTreeError
        If a test fails.
    """
    around = _digest_of(root, [*_helpers(root), *_files(root / "firm_hdl", ".lark")])

    def one(name: str) -> Part:
        place = folder / f"{name.replace('/', '--')}.json"
        made_of = {"test": _content(root / name), "each": each, "python": sys.version}
        part = _today(root, folder, _load(place), made_of, around)
        if part is None or (part.stale and fresh):
            workshop = workshops.get()
            try:
                part = _trace(workshop, name, each)
                sources = _sources(workshop.root, part)
                _store(workshop.root, folder, place, _Kept(part, made_of, around, sources))
            finally:
                workshops.put(workshop)
            seconds = sum(test.cpu_seconds for test in part.tests if test.measured)
            say(f"map: {name}, {len(part.tests)} tests, {seconds:.1f} s")
        return part

    pool = ThreadPoolExecutor(workshops.qsize())
    try:
        parts = list(pool.map(one, files))
    finally:
        pool.shutdown(cancel_futures=True)
    stale = sum(part.stale for part in parts)
    if stale:
        say(f"map: {stale} of {len(parts)} files as they were before the program changed")
    return CoverageMap(parts=parts, complete=complete, tree=tree_digest(root, test_files(root)))


def _today(
    root: Path, folder: Path, kept: _Kept | None, made_of: Mapping[str, Any], around: str
) -> Part | None:
    """Return a part with line numbers of the present text, or `None` if it is not valid."""
    if kept is None or kept.made_of != made_of:
        return None
    now = _sources(root, kept.part)
    kept = replace(kept, sources={path: kept.sources.get(path, "") for path in kept.part.lines})
    other = [path for path, digest in kept.sources.items() if now.get(path) != digest]
    if not other and kept.around == around:
        return kept.part
    lines = dict(kept.part.lines)
    for path in other:
        old = folder / "sources" / kept.sources[path]
        masks = lines.pop(path)
        if path in now and old.exists():
            before, after = (each.read_text(encoding="utf-8") for each in (old, root / path))
            lines[path] = moved(masks, before, after)
    return replace(kept.part, lines=lines, stale=True)


def moved(masks: Mapping[str, int], before: str, after: str) -> dict[str, int]:
    """Map line numbers of a text to those of its new version.

    If a test ran one of some replaced lines, it is assumed to run all the lines that replace them.
    If it ran a line, it is assumed to run lines that were inserted after that line.
    """
    matcher = difflib.SequenceMatcher(None, before.splitlines(), after.splitlines(), autojunk=False)
    steps = matcher.get_opcodes()
    result: dict[str, int] = {}
    for owner, mask in masks.items():
        found = 0
        for kind, old, old_end, new, new_end in steps:
            # Bit n is line n, counted from 1.
            here = mask >> (old + 1) & (1 << old_end - old) - 1
            whole = (1 << new_end - new) - 1
            if kind == "insert":
                here = whole if mask >> old & 1 else 0
            elif kind == "replace":
                here = whole if here else 0
            elif kind == "delete":
                here = 0
            found |= here << (new + 1)
        result[owner] = found
    return result


def _helpers(root: Path) -> list[Path]:
    """Return the files that tests share."""
    own = root / "tests" / "mutation"
    found = [path for path in _files(root / "tests") if not path.name.startswith("test_")]
    return [path for path in found if own not in path.parents]


def _files(path: Path, suffix: str = "") -> list[Path]:
    if path.is_file():
        return [path]
    found = [each for each in path.rglob(f"*{suffix}") if each.is_file()]
    return [each for each in found if "__pycache__" not in each.parts]


def _content(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()[:16]


def _digest_of(root: Path, paths: Iterable[Path]) -> str:
    texts = [f"{path.relative_to(root).as_posix()} {_content(path)}" for path in sorted(paths)]
    return hashlib.sha256("\n".join(texts).encode()).hexdigest()[:16]


def _sources(root: Path, part: Part) -> dict[str, str]:
    return {path: _content(root / path) for path in part.lines if (root / path).exists()}


def _trace(workshop: Workshop, name: str, each: float | None) -> Part:
    """Run a test file and record the lines that its tests run."""
    folder = workshop.root.parent / f"{workshop.root.name}.trace"
    source = workshop.root / "firm_hdl"
    environment = {
        trace.FOLDER: str(folder),
        trace.EACH: str(each or ""),
        "COVERAGE_CORE": "ctrace",
    }
    options = ["-p", "tools.mutation.map.trace", name]
    failed: Counter[str] = Counter()
    opaque: list[Test] = []
    while True:
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        (folder / "settings").write_text(trace.SETTINGS.format(folder=folder, source=source))
        run = workshop.run(options, SECONDS, environment, seconds=SECONDS)
        if run.status == "passed":
            break
        failed[run.by] += 1
        if failed[run.by] == ATTEMPTS:
            # The test may fail only because of the tracing, so run it without.
            plain = workshop.run_tests([run.by], SECONDS, SECONDS) if "::" in run.by else run
            if plain.status != "passed":
                raise BrokenTreeError(f"fails without a fault: {run.by or name}")
            opaque.append(Test(run.by, plain.cpu_seconds, opaque=True))
            options += ["--deselect", run.by]
    written = folder / "tests.json"
    if not written.exists():
        raise BrokenTreeError(f"{name} left no lines: {workshop.output()[-300:]}")
    part = _part(workshop.root, json.loads(written.read_text()), folder)
    shutil.rmtree(folder)
    return replace(part, tests=[*part.tests, *opaque])


def _part(root: Path, given: Mapping[str, Any], folder: Path) -> Part:
    """Collect the lines of all processes."""
    lines: dict[str, dict[str, int]] = {}
    saved: Counter[str] = Counter()
    here = os.path.realpath(root)
    for file in sorted(folder.glob("data.*")):
        data = CoverageData(str(file))
        try:
            data.read()
        except DataError:
            # Its process was killed while it wrote, so it counts as one that wrote nothing.
            continue
        saved[file.name.split(".")[1]] += 1
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
            snapshot=each["snapshot"],
        )
        for number, each in enumerate(given["tests"])
    ]
    return Part(tests=[*tests, *_skipped(tests, given["skipped"])], lines=lines)


def _skipped(tests: Sequence[Test], given: Sequence[Mapping[str, Any]]) -> list[Test]:
    """Return tests that were left out, with the time of the measured tests of their function."""
    result = []
    for each in given:
        alike = [test for test in tests if test.function == each["id"].partition("[")[0]]
        result.append(
            Test(
                name=each["id"],
                cpu_seconds=round(mean(test.cpu_seconds for test in alike), 3),
                opaque=any(test.opaque for test in alike),
                snapshot=each["snapshot"],
                measured=False,
            )
        )
    return result


def _owners(context: str) -> list[str]:
    number = context.removeprefix("+")
    if not number:
        return [SHARED]
    return [number, SHARED] if context.startswith("+") else [number]


def _load(path: Path) -> _Kept | None:
    if not path.exists():
        return None
    given = json.loads(path.read_text())
    part = Part(
        tests=[Test(**each) for each in given["tests"]],
        lines={
            name: {owner: int(mask, 16) for owner, mask in masks.items()}
            for name, masks in given["lines"].items()
        },
    )
    return _Kept(part, given["made_of"], given["around"], given["sources"])


def _store(root: Path, folder: Path, path: Path, kept: _Kept) -> None:
    """Write a part atomically, and the texts to which its line numbers refer."""
    texts = folder / "sources"
    texts.mkdir(parents=True, exist_ok=True)
    for name, digest in kept.sources.items():
        if not (texts / digest).exists():
            shutil.copyfile(root / name, texts / digest)
    lines = {
        name: {owner: f"{mask:x}" for owner, mask in masks.items()}
        for name, masks in kept.part.lines.items()
    }
    given = {
        "tests": [asdict(each) for each in kept.part.tests],
        "lines": lines,
        "made_of": kept.made_of,
        "around": kept.around,
        "sources": kept.sources,
    }
    new = path.with_suffix(".new")
    new.write_text(json.dumps(given))
    new.replace(path)
