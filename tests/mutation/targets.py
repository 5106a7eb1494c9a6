"""The parts of the program that get faults, and which of all faults are taken."""

from __future__ import annotations

import hashlib
from collections import defaultdict
from pathlib import Path

from tests.mutation import grammar_rules, python_rules
from tests.mutation.mutants import Change, Mutant, identify

__all__ = ["TARGETS", "all_mutants", "files", "is_fault", "sample"]

TARGETS = {
    "grammar": ["firm_hdl/frontend/**/*.lark"],
    "resolver": ["firm_hdl/frontend/**/*.py"],
    "layout": ["firm_hdl/wire/*.py"],
    "plan": [f"firm_hdl/plan/{name}.py" for name in ("build", "cut", "geometry", "ir", "offsets")],
    "gateware": ["firm_hdl/gateware/*.py"],
    "vhdl": ["firm_hdl/export/vhdl*.py", "firm_hdl/export/rtlil*.py"],
}
# What grammars are asked for.
IDL_STARTS, MESSAGE_STARTS = ["start"], ["line", "reference"]


def files(root: Path, target: str) -> list[Path]:
    """Return the files of a target."""
    found = {path for pattern in TARGETS[target] for path in root.glob(pattern)}
    return sorted(path for path in found if path.name != "__init__.py")


def all_mutants(root: Path, targets: list[str] | None = None) -> list[Mutant]:
    """Return all mutants of the repository at `root`."""
    mutants: list[Mutant] = []
    for target in targets or list(TARGETS):
        for path in files(root, target):
            text = path.read_text(encoding="utf-8")
            where = path.relative_to(root).as_posix()
            mutants += identify(where, target, text, _changes(path, text))
    return mutants


def _changes(path: Path, text: str) -> list[Change]:
    rules = grammar_rules if path.suffix == ".lark" else python_rules
    return rules.changes(text)


def is_fault(root: Path, mutant: Mutant) -> bool:
    """Tell mutants that load, and are not plainly the same program."""
    text = (root / mutant.path).read_text(encoding="utf-8")
    if mutant.path.endswith(".lark"):
        starts = IDL_STARTS if "/idl/" in mutant.path else MESSAGE_STARTS
        return grammar_rules.is_fault(text, mutant.change, starts)
    return python_rules.is_fault(text, mutant.change)


def sample(root: Path, mutants: list[Mutant], count: int, seed: int) -> list[Mutant]:
    """Choose faults: as many of each target, of its files in proportion to what they have.

    The order is random across targets, so that the first of them are a sample as well. A mutant's
    rank depends on its content alone: an edit elsewhere leaves the choice as it was, nearly.
    """
    by_target: dict[str, list[Mutant]] = defaultdict(list)
    for mutant in mutants:
        by_target[mutant.target].append(mutant)
    chosen: list[Mutant] = []
    for index, target in enumerate(by_target):
        quota = count // len(by_target) + (index < count % len(by_target))
        chosen += _of_target(root, by_target[target], quota, seed)
    return sorted(chosen, key=lambda mutant: _rank(mutant, seed + 1))


def _of_target(root: Path, mutants: list[Mutant], quota: int, seed: int) -> list[Mutant]:
    by_file: dict[str, list[Mutant]] = defaultdict(list)
    for mutant in mutants:
        by_file[mutant.path].append(mutant)
    sizes = {path: len(each) for path, each in by_file.items()}
    for each in by_file.values():
        each.sort(key=lambda mutant: _rank(mutant, seed), reverse=True)
    # In turn from the file that is furthest behind its share.
    chosen: list[Mutant] = []
    taken = dict.fromkeys(by_file, 0)
    while len(chosen) < quota and any(by_file.values()):
        path = min(
            (path for path, each in by_file.items() if each),
            key=lambda path: (taken[path] + 0.5) / sizes[path],
        )
        mutant = by_file[path].pop()
        if is_fault(root, mutant):
            chosen.append(mutant)
            taken[path] += 1
    return chosen


def _rank(mutant: Mutant, seed: int) -> str:
    return hashlib.sha256(f"{seed} {mutant.key}".encode()).hexdigest()
