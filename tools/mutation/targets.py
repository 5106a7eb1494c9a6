"""The parts of the program into which faults are injected, and the sampling of faults."""

from __future__ import annotations

import hashlib
from collections import Counter, defaultdict
from collections.abc import Collection
from math import sqrt
from pathlib import Path

from tools.mutation.mutants import Change, Mutant, identify
from tools.mutation.rules import grammar_rules, python_rules, semantic_rules
from tools.mutation.rules.index import Index, index_of_program

__all__ = ["TARGETS", "all_mutants", "files", "is_fault", "sample"]

# All of the program. A file belongs to the first target that fits.
TARGETS = {
    "grammar": ["firm_hdl/frontend/**/*.lark"],
    "idl": ["firm_hdl/frontend/idl/*.py"],
    "frontend": ["firm_hdl/frontend/*.py"],
    "identity": ["firm_hdl/identity/*.py"],
    "wire": ["firm_hdl/wire/*.py"],
    "plan": ["firm_hdl/plan/*.py"],
    "gateware": ["firm_hdl/gateware/*.py"],
    "sim": ["firm_hdl/sim/*.py"],
    "vhdl": ["firm_hdl/vhdl/*.py", "firm_hdl/rtlil/*.py"],
    "export": ["firm_hdl/export/**/*.py", "firm_hdl/names/*.py"],
    "equivalence": ["firm_hdl/equivalence/*.py"],
    "metrics": ["firm_hdl/metrics/*.py"],
    "rtps": ["firm_hdl/rtps/**/*.py"],
    "ts1": ["firm_hdl/verify/ts1/**/*.py"],
    "sut": ["firm_hdl/verify/clients/*.py", "firm_hdl/verify/references/*.py"],
    "report": ["firm_hdl/verify/report/*.py", "firm_hdl/drawing/*.py"],
    "verify": ["firm_hdl/verify/**/*.py"],
    "top": ["firm_hdl/**/*.py"],
}
# Start rules of the grammars.
IDL_STARTS, MESSAGE_STARTS = ["start"], ["line", "reference"]


def files(root: Path, target: str) -> list[Path]:
    """Return the files of a target."""
    taken: set[Path] = set()
    for name, patterns in TARGETS.items():
        found = {path for pattern in patterns for path in root.glob(pattern)} - taken
        if name == target:
            return sorted(found)
        taken |= found
    raise KeyError(target)


def all_mutants(
    root: Path, targets: list[str] | None = None, only: Collection[str] = ()
) -> list[Mutant]:
    """Return all mutants of the repository at `root`, or of some of its files."""
    index = index_of_program(root)
    mutants: list[Mutant] = []
    for target in targets or list(TARGETS):
        for path in files(root, target):
            text = path.read_text(encoding="utf-8")
            where = path.relative_to(root).as_posix()
            if only and where not in only:
                continue
            mutants += identify(where, target, text, _changes(path, text, index))
    return mutants


def _changes(path: Path, text: str, index: Index) -> list[Change]:
    if path.suffix == ".lark":
        return grammar_rules.changes(text)
    # If two rules make the same change, keep one mutant, preferably that of a semantic rule.
    found = [*semantic_rules.changes(text, index), *python_rules.changes(text)]
    first = {(each.start, each.end, each.new): each for each in reversed(found)}
    return sorted(first.values(), key=lambda each: (each.start, each.end, each.rule, each.new))


def is_fault(root: Path, mutant: Mutant) -> bool:
    """Return whether a mutant can be loaded, and is not obviously the same program."""
    text = (root / mutant.path).read_text(encoding="utf-8")
    if mutant.path.endswith(".lark"):
        starts = IDL_STARTS if "/idl/" in mutant.path else MESSAGE_STARTS
        return grammar_rules.is_fault(text, mutant.change, starts)
    return python_rules.is_fault(text, mutant.change)


def sample(root: Path, mutants: list[Mutant], count: int, seed: int) -> list[Mutant]:
    """Choose faults by target, by file, and equally by rule.

    The share of a target is proportional to the square root of its size, so that small targets have
    a share. The share of a file in its target is proportional to its size. The order is random
    across targets, so that the first faults are a sample as well. A mutant's rank depends on its
    content alone, so that an edit elsewhere hardly changes the choice.
    """
    by_target: dict[str, list[Mutant]] = defaultdict(list)
    for mutant in mutants:
        by_target[mutant.target].append(mutant)
    chosen: list[Mutant] = []
    for target, quota in _quotas(by_target, count).items():
        chosen += _of_target(root, by_target[target], quota, seed)
    return sorted(chosen, key=lambda mutant: _rank(seed + 1, mutant.key))


def _quotas(by_target: dict[str, list[Mutant]], count: int) -> dict[str, int]:
    quotas = dict.fromkeys(by_target, 0)
    for _ in range(count if by_target else 0):
        behind = min(quotas, key=lambda name: (quotas[name] + 0.5) / sqrt(len(by_target[name])))
        quotas[behind] += 1
    return quotas


def _of_target(root: Path, mutants: list[Mutant], quota: int, seed: int) -> list[Mutant]:
    by_file: dict[str, dict[str, list[Mutant]]] = defaultdict(lambda: defaultdict(list))
    for mutant in sorted(mutants, key=lambda each: _rank(seed, each.key), reverse=True):
        by_file[mutant.path][mutant.change.rule].append(mutant)
    sizes = Counter(mutant.path for mutant in mutants)
    # Take the next mutant from the file that is furthest behind its share, by the least used rule.
    chosen: list[Mutant] = []
    taken, used = Counter[str](), Counter[str]()
    while len(chosen) < quota and by_file:
        path = min(
            by_file,
            key=lambda path: ((taken[path] + 0.5) / sizes[path], _rank(seed, path)),
        )
        rules = by_file[path]
        rule = min(rules, key=lambda rule: (used[rule], _rank(seed, f"{path} {rule}")))
        mutant = rules[rule].pop()
        if is_fault(root, mutant):
            chosen.append(mutant)
            taken[path] += 1
            used[rule] += 1
        if not rules[rule]:
            del rules[rule]
        if not rules:
            del by_file[path]
    return chosen


def _rank(seed: int, what: str) -> str:
    return hashlib.sha256(f"{seed} {what}".encode()).hexdigest()
