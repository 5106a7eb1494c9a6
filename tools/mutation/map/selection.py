"""Select the tests for a mutant, and their order.

Two kinds of tests can notice a change: those that run a changed line, and those with processes
whose lines are not known. If a statement has several lines, all of them count as changed. For a
change of a grammar, the changed lines are those that load the grammar.
"""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path, PurePosixPath

from tools.mutation.map.coverage_map import CoverageMap, Test
from tools.mutation.mutants import Mutant
from tools.mutation.systems import mirrored, mirrors

__all__ = ["BATCH_SECONDS", "FOREIGN", "batches", "changed_lines", "judges"]

# Largest processor time of the tests of each run. The last value applies to all further runs.
BATCH_SECONDS = (4.0, 15.0, 60.0, 300.0)
# Processor time for sets of parameters of one test before other tests get a turn. It then doubles.
TURN_SECONDS = 0.25
# Prefix of modules that another Python runs, and the module that starts them.
FOREIGN = "worker_"
STARTS_THEM = "firm_hdl/verify/ros_python/worker.py"
Place = tuple[str, frozenset[int]]


def changed_lines(root: Path, mutant: Mutant) -> list[Place]:
    """Return files and lines. A test can notice the change only if it runs one of the lines."""
    path = root / mutant.path
    if path.suffix == ".lark":
        return list(_loaders(root, path))
    if path.name.startswith(FOREIGN):
        return [(STARTS_THEM, frozenset(_bodies(root / STARTS_THEM)))]
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return [(mutant.path, frozenset(_statement(tree, mutant.line)))]


def judges(root: Path, found: CoverageMap, mutant: Mutant) -> list[Test]:
    """Return the tests that may notice a mutant, most promising first.

    First come the tests that run the line themselves, unless the line runs once for several tests.
    Then come tests that run other lines of the file, then those of its folder, then others. Opaque
    tests come last. In all groups but the first, tests in the folder that mirrors the module come
    first. Then come measured tests, then tests of functions of which less time is spent so far,
    then tests that mirror the module, then cheap tests.
    """
    own: set[str] = set()
    tests: dict[str, Test] = {}
    same_file: set[str] = set()
    for path, lines in changed_lines(root, mutant):
        same_file |= found.touching(path)
        for test, itself in found.running(path, lines):
            tests[test.name] = test
            own |= {test.name} if itself else set()
    # If the line is shared, the test that ran it may only have loaded something for others.
    shared = len(own) < len(tests)
    # Tests that were measured with an older program may now run the line.
    for test in found.named(found.touching(mutant.path, stale=True)):
        tests.setdefault(test.name, test)
    same_folder = found.touching(str(PurePosixPath(mutant.path).parent) + "/")
    unseen = {test.name: test for test in found.opaque() if test.name not in tests}

    def group(test: Test) -> int:
        mine = test.name in own
        near = (mine and not shared, mine or test.name in same_file, test.name in same_folder)
        return 4 if test.name in unseen else near.index(True) if any(near) else 3

    seconds: dict[str, float] = defaultdict(float)
    ranks: dict[str, tuple[int, bool, bool, int, bool, float]] = {}
    every = [*tests.values(), *unseen.values()]
    for test in sorted(every, key=lambda each: (each.cpu_seconds, each.name)):
        seconds[test.function] += test.cpu_seconds
        turn = int(seconds[test.function] / TURN_SECONDS).bit_length()
        mirror = mirrors(test.file, mutant.path)
        # Of tests that do not run the line, prefer those in the folder that mirrors the module.
        beside = mirror or test.file.startswith(mirrored(mutant.path) + "/")
        first = group(test)
        far = first > 0 and not beside
        unsure = not test.measured
        ranks[test.name] = first, far, unsure, turn, not mirror, test.cpu_seconds
    return sorted(every, key=lambda each: (ranks[each.name], each.name))


def batches(tests: Sequence[Test]) -> list[list[Test]]:
    """Split a sequence of tests into runs; within each run, a file's tests stay together."""
    result: list[list[Test]] = []
    batch: list[Test] = []
    seconds = 0.0
    for test in tests:
        most = BATCH_SECONDS[min(len(result), len(BATCH_SECONDS) - 1)]
        if batch and seconds + test.cpu_seconds > most:
            result.append(batch)
            batch, seconds = [], 0.0
        batch.append(test)
        seconds += test.cpu_seconds
    if batch:
        result.append(batch)
    return [_by_file(batch) for batch in result]


def _by_file(tests: list[Test]) -> list[Test]:
    files = list(dict.fromkeys(test.file for test in tests))
    return sorted(tests, key=lambda test: files.index(test.file))


def _statement(tree: ast.Module, line: int) -> set[int]:
    """Return the lines of the smallest statement at a line, without the lines of its body."""
    lines, above = {line}, line
    for node in ast.walk(tree):  # From outer to inner ones.
        first, head, last = _span(node)
        if first <= line <= last:
            lines = {*range(first, head + 1), line}
            if isinstance(node, ast.match_case):
                # Tracing shows the test of a case at the line of the enclosing statement.
                lines.add(above)
            above = first
    return lines


def _span(node: ast.AST) -> tuple[int, int, int]:
    """Return the first line of a statement, the last one before its body, and its last one."""
    if isinstance(node, ast.match_case):
        first, last = node.pattern.lineno, node.body[-1].end_lineno or 0
    elif isinstance(node, (ast.stmt, ast.ExceptHandler)):
        first, last = node.lineno, node.end_lineno or 0
    else:
        return 0, 0, -1
    inner = getattr(node, "body", None) or getattr(node, "cases", None)
    if not inner:
        return first, last, last
    start = inner[0].pattern if isinstance(inner[0], ast.match_case) else inner[0]
    decorators = getattr(start, "decorator_list", [])
    after = min([start.lineno, *(each.lineno for each in decorators)])
    return first, max(first, after - 1), last


def _bodies(path: Path) -> set[int]:
    """Return the lines of the bodies of all functions."""
    functions = [
        node
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.FunctionDef)
    ]
    return {
        line
        for node in functions
        for line in range(node.body[0].lineno, (node.end_lineno or 0) + 1)
    }


def _loaders(root: Path, grammar: Path) -> Iterator[Place]:
    """Yield the lines that name a grammar, or the end of its name, to load it."""
    for path in sorted(grammar.parent.glob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        lines = {
            node.lineno
            for function in ast.walk(tree)
            if isinstance(function, ast.FunctionDef)
            for node in ast.walk(function)
            if isinstance(node, ast.Constant)
            and str(node.value).endswith(".lark")
            and grammar.name.endswith(str(node.value))
        }
        if lines:
            yield path.relative_to(root).as_posix(), frozenset(lines)
