"""Faults that somebody wrote by hand, from a YAML file.

The file is a list. Each entry has a ``path``, the ``old`` text, which occurs once in that file, the
``new`` text, and optionally ``why``, which is for people::

    - path: firm_hdl/wire/alignment.py
      old: "-offset % alignment"
      new: "offset % alignment"
      why: the padding goes the wrong way
"""

from __future__ import annotations

from pathlib import Path

import yaml

from tools.mutation.mutants import Change, Mutant, identify
from tools.mutation.targets import TARGETS, files

__all__ = ["GivenFaultError", "read_faults"]

RULE = "by hand"


class GivenFaultError(Exception):
    """A fault that cannot be planted. The message has the number of its entry, from 1."""


def read_faults(root: Path, path: Path) -> list[Mutant]:
    """Return the faults of a file, to be planted in the repository at `root`.

    Raises
    ------
    GivenFaultError
        If the file is no such list, or the program has the old text of an entry not exactly once.
    """
    try:
        entries = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (OSError, yaml.YAMLError) as error:
        raise GivenFaultError(f"{path}: {error}") from None
    if not isinstance(entries, list):
        raise GivenFaultError(f"{path}: no list of faults")
    owners = {
        each.relative_to(root).as_posix(): name for name in TARGETS for each in files(root, name)
    }
    return [
        _fault(root, owners, f"{path}: fault {number}", entry)
        for number, entry in enumerate(entries, start=1)
    ]


def _fault(root: Path, owners: dict[str, str], where: str, entry: object) -> Mutant:
    given = entry if isinstance(entry, dict) else {}
    name, old, new = (given.get(key) for key in ("path", "old", "new"))
    if not (isinstance(name, str) and isinstance(old, str) and isinstance(new, str)):
        raise GivenFaultError(f"{where}: needs the texts path, old and new")
    if name not in owners:
        raise GivenFaultError(f"{where}: {name} is no file of the program")
    text = (root / name).read_text(encoding="utf-8")
    count = text.count(old) if old else 0
    if count != 1 or old == new:
        problem = "the new text is the old one" if count == 1 else f"{count} places have the text"
        raise GivenFaultError(f"{where}: {problem} in {name}")
    start = text.index(old)
    # Up to the line end, so that whole lines are compared.
    rest = text[start + len(old) :].partition("\n")
    old, new = (each + rest[0] + rest[1] for each in (old, new))
    same = _same_lines(old, new)
    end = start + len(old)
    change = Change(start + same, end, new[same:], RULE, scope=str(given.get("why", "")))
    return identify(name, owners[name], text, [change])[0]


def _same_lines(old: str, new: str) -> int:
    """Return the characters of the first lines, which stay as they are.

    Tests are chosen by the line where a change starts. The last line of `old` counts as changed.
    """
    count = 0
    for before, after in zip(old.splitlines(True)[:-1], new.splitlines(True), strict=False):
        if before != after:
            break
        count += len(before)
    return count
