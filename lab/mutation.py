"""``python -m lab.mutation``: put faults into the program, and see which test notices each.

A fault is a small change of a module of `firm_hdl`, such as ``<`` in place of ``<=``. The tests of
the part that the module belongs to run in a copy of the repository, until one fails. What no test
notices is a place to look at: a missing test, or a change that means the same. There is no score.
"""

from __future__ import annotations

import argparse
import ast
import contextlib
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from collections import defaultdict
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from itertools import count
from pathlib import Path
from queue import Queue

__all__ = ["Fault", "faults_of", "main", "sample"]

ROOT = Path(__file__).parents[1]
LEFT_OUT = shutil.ignore_patterns(
    ".git", ".venv", "__pycache__", ".*_cache", ".hypothesis", "build", "dist"
)
OPERATORS: dict[type[ast.AST], tuple[str, str]] = {
    ast.Lt: ("<", "<="),
    ast.LtE: ("<=", "<"),
    ast.Gt: (">", ">="),
    ast.GtE: (">=", ">"),
    ast.Eq: ("==", "!="),
    ast.NotEq: ("!=", "=="),
    ast.In: ("in", "not in"),
    ast.NotIn: ("not in", "in"),
    ast.Is: ("is", "is not"),
    ast.IsNot: ("is not", "is"),
    ast.And: ("and", "or"),
    ast.Or: ("or", "and"),
    ast.Add: ("+", "-"),
    ast.Sub: ("-", "+"),
    ast.LShift: ("<<", ">>"),
    ast.RShift: (">>", "<<"),
    ast.BitAnd: ("&", "|"),
    ast.BitOr: ("|", "&"),
}
"""Operators, each as it is written, and the one that takes its place."""
FAILED = re.compile(r"^(?:FAILED|ERROR) (\S+)", re.MULTILINE)


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault:
    """A change of a file.

    Attributes
    ----------
    path : str
        The file, from the root of the repository.
    line : int
    start, end : int
        The bytes of the file that are replaced.
    old, new : str
        What stands there, and what takes its place.
    """

    path: str
    line: int
    start: int
    end: int
    old: str
    new: str

    def __str__(self) -> str:
        return f"{self.path}:{self.line}: {' '.join(self.old.split())} -> {self.new}"

    def applied(self, text: bytes) -> bytes:
        """Return the text of the file with the fault."""
        return text[: self.start] + self.new.encode() + text[self.end :]

    def compiles(self, root: Path) -> bool:
        """Return whether Python compiles the file with the fault."""
        try:
            compile(self.applied((root / self.path).read_bytes()), self.path, "exec")
        except (SyntaxError, ValueError):
            return False
        return True


def faults_of(path: str, text: bytes) -> Iterator[Fault]:
    """Yield all faults of a module; Python may refuse some."""
    tree = ast.parse(text)
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))

    def at(line: int | None, column: int | None) -> int:
        assert line is not None and column is not None
        return starts[line - 1] + column

    for node in _code(tree):
        for first, last, new in _changes(node):
            if first is last:
                start = at(first.lineno, first.col_offset)
                end = at(first.end_lineno, first.end_col_offset)
                old = text[start:end].decode()
                new = new.replace("\1", old)
            else:
                # Between two operands: there may be parentheses and comments, too.
                start = at(first.end_lineno, first.end_col_offset)
                between = text[start : at(last.lineno, last.col_offset)]
                old, new = new.split("\0")
                word = rf"(?<![<>=!\w]){re.escape(old)}(?![<>=\w])"
                if (found := re.search(word.encode(), between)) is None:
                    continue
                start, end = start + found.start(), start + found.end()
            number = text.count(b"\n", 0, start) + 1
            yield Fault(path=path, line=number, start=start, end=end, old=old, new=new)


def _code(tree: ast.AST) -> Iterator[ast.expr | ast.stmt]:
    """Yield statements and expressions, without annotations and decorators."""
    for name, value in ast.iter_fields(tree):
        if name in ("annotation", "returns", "decorator_list", "type_comment"):
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, (ast.expr, ast.stmt)):
                yield child
            if isinstance(child, ast.AST):
                yield from _code(child)


def _changes(
    node: ast.expr | ast.stmt,
) -> Iterator[tuple[ast.expr | ast.stmt, ast.expr | ast.stmt, str]]:
    r"""Yield two nodes and a text: two operands with ``OLD\0NEW``, or one node twice with a text.

    In the text for a node, ``\1`` is the node itself.
    """
    match node:
        case ast.Compare(left=left, ops=[operator], comparators=[right]):
            yield left, right, "\0".join(OPERATORS[type(operator)])
        case ast.BinOp(left=left, op=operator, right=right) if type(operator) in OPERATORS:
            yield left, right, "\0".join(OPERATORS[type(operator)])
        case ast.BoolOp(op=operator, values=[left, right]):
            yield left, right, "\0".join(OPERATORS[type(operator)])
        case ast.UnaryOp(op=ast.Not()):
            yield node, node, f"({ast.unparse(node.operand)})"
        case ast.Constant(value=bool(value)):
            yield node, node, str(not value)
        case ast.Constant(value=int(value)):
            yield node, node, str(value + 1)
        case ast.If(test=test) | ast.While(test=test) | ast.IfExp(test=test):
            yield test, test, "(not (\1))"
        case ast.Expr(value=ast.Call()) | ast.AugAssign():
            yield node, node, "pass"


def all_faults(root: Path, patterns: Sequence[str]) -> dict[str, list[Fault]]:
    """Return the faults of all modules that fit, by module."""
    found = {}
    for path in sorted({path for each in patterns for path in root.glob(each)}):
        name = path.relative_to(root).as_posix()
        if path.suffix == ".py" and (faults := list(faults_of(name, path.read_bytes()))):
            found[name] = faults
    return found


def sample(root: Path, faults: dict[str, list[Fault]], most: int, seed: int) -> list[Fault]:
    """Choose faults: first a part of the package, then one of its modules, then a fault."""
    rng = random.Random(seed)
    left: dict[str, dict[str, list[Fault]]] = defaultdict(dict)
    for name, each in faults.items():
        left[part_of(name)][name] = each.copy()
    chosen: list[Fault] = []
    while left and len(chosen) < most:
        part = rng.choice(sorted(left))
        name = rng.choice(sorted(left[part]))
        fault = left[part][name].pop(rng.randrange(len(left[part][name])))
        if fault.compiles(root):
            chosen.append(fault)
        if not left[part][name]:
            del left[part][name]
        if not left[part]:
            del left[part]
    return chosen


def part_of(path: str) -> str:
    """Return the part that a module belongs to, such as ``plan`` or ``verify/ts1``."""
    parts = path.removesuffix(".py").split("/")[1:]
    return "/".join(parts[: 2 if parts[0] == "verify" and len(parts) > 2 else 1])


def tests_of(root: Path, path: str) -> str:
    """Return the folder or file with the tests of a module's part."""
    part = part_of(path)
    for name in (f"tests/{part}", f"tests/test_{part}.py", f"tests/{part.partition('/')[0]}"):
        if (root / name).exists():
            return name
    return "tests"


class Copy:
    """A copy of the repository, in which tests run."""

    # Modification times: Python finds outdated bytecode by them, and by the size.
    _now = count(2_000_000_000)

    def __init__(self, root: Path, folder: Path) -> None:
        self.folder = folder
        shutil.copytree(root, folder, ignore=LEFT_OUT, symlinks=True)

    def judge(self, fault: Fault, tests: Sequence[str], seconds: float) -> tuple[str, str]:
        """Return whether tests notice a fault, and the first that does; undo the fault."""
        path = self.folder / fault.path
        before = path.read_bytes()
        try:
            self._write(path, fault.applied(before))
            return self.run(tests, seconds)
        finally:
            self._write(path, before)

    def _write(self, path: Path, data: bytes) -> None:
        path.write_bytes(data)
        now = next(self._now)
        os.utime(path, (now, now))

    def run(self, tests: Sequence[str], seconds: float) -> tuple[str, str]:
        """Run tests until one fails; return "noticed" or "survived", and the test's name."""
        # Hypothesis would give a later fault the examples that failed before.
        shutil.rmtree(self.folder / ".hypothesis", ignore_errors=True)
        command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *tests]
        process = subprocess.Popen(
            command,
            cwd=self.folder,
            env={**os.environ, "PYTHONPATH": str(self.folder)},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            start_new_session=True,
        )
        try:
            said, _ = process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            return "noticed", f"the limit of {seconds:.0f} s"
        finally:
            # Also what the tests have started.
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        if process.returncode == 0:
            return "survived", ""
        found = FAILED.search(said)
        return "noticed", found[1] if found else said.strip().rpartition("\n")[2]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; return 1 if tests fail without a fault."""
    parser = argparse.ArgumentParser(prog="python -m lab.mutation", description=__doc__)
    add = parser.add_argument
    add("modules", nargs="*", default=["firm_hdl/**/*.py"], help="default: %(default)s")
    add("--count", type=int, default=24, help="faults; default: %(default)s")
    add("--seed", type=int, help="chooses them; default: others each time")
    add("--tests", action="append", help="tests to run; repeatable; default: those of the part")
    add("--seconds", type=float, default=600, help="limit of a run of tests; default: %(default)s")
    add("--jobs", type=int, default=1, help="copies of the repository; default: %(default)s")
    add("--out", type=Path, help="append a line of JSON for each fault")
    add("--list", action="store_true", help="list the faults, and run nothing")
    add("--root", type=Path, default=ROOT, help=argparse.SUPPRESS)
    given = parser.parse_args(arguments)
    seed = random.SystemRandom().randrange(10**6) if given.seed is None else given.seed
    chosen = sample(given.root, all_faults(given.root, given.modules), given.count, seed)
    print(f"--seed {seed}, {len(chosen)} faults", flush=True)
    if given.list:
        print(*chosen, sep="\n")
        return 0
    tests = {each: tuple(given.tests or [tests_of(given.root, each.path)]) for each in chosen}
    counts: dict[str, int] = defaultdict(int)
    with tempfile.TemporaryDirectory(prefix="firm-hdl-mutation-") as folder:
        copies: Queue[Copy] = Queue()
        for number in range(given.jobs):
            copies.put(Copy(given.root, Path(folder, str(number))))

        def in_copy(fault: Fault | None, names: Sequence[str]) -> tuple[str, str]:
            copy = copies.get()
            try:
                if fault is None:
                    return copy.run(names, given.seconds)
                return copy.judge(fault, names, given.seconds)
            finally:
                copies.put(copy)

        with ThreadPoolExecutor(given.jobs) as pool:
            usual = [*dict.fromkeys(tests.values())]
            for names, (result, test) in zip(
                usual, pool.map(lambda names: in_copy(None, names), usual), strict=True
            ):
                if result != "survived":
                    print(f"error: {' '.join(names)} fails without a fault: {test}")
                    return 1
            found = pool.map(lambda fault: in_copy(fault, tests[fault]), chosen)
            for fault, (result, test) in zip(chosen, found, strict=True):
                counts[result] += 1
                print(f"{result:8} {fault}{f' ({test})' if test else ''}", flush=True)
                if given.out is not None:
                    line = json.dumps({**asdict(fault), "result": result, "test": test})
                    with given.out.open("a", encoding="utf-8") as file:
                        file.write(f"{line}\n")
    print(f"{counts['noticed']} noticed, {counts['survived']} survived")
    return 0


if __name__ == "__main__":
    sys.exit(main())
