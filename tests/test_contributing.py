"""The five walks of docs/contributing.md: files and names exist, at most six files in a walk."""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

import firm_hdl

ROOT = Path(firm_hdl.__file__).parent.parent
PAGE = (ROOT / "docs" / "contributing.md").read_text(encoding="utf-8")
# The name of a new file, which the walk creates.
NEW = re.compile(r"NAME|PART")
# A file such as `README.md` is no member of a class.
MEMBER = re.compile(r"`([A-Z]\w*[a-z]\w*)\.(\w+)`")
FILE = re.compile(r"`([\w/]+\.(?:py|md|lark))`")


def tables(page):
    """Yield the rows of each table of files."""
    return [
        [row for row in block.splitlines()[2:] if row.startswith("|")]
        for block in re.findall(r"(?m)^\| File \|.*\n(?:\|.*\n?)+", page)
    ]


def missing(page):
    for name in FILE.findall(page):
        places = (ROOT / name, ROOT / "firm_hdl" / name, ROOT / "firm_hdl" / "cli" / name)
        beside = (ROOT / "firm_hdl" / "wire" / name, ROOT / "docs" / name)
        if not NEW.search(name) and not any(path.is_file() for path in (*places, *beside)):
            yield name


def test_files_that_the_page_names_exist():
    assert list(missing(PAGE)) == []


@cache
def members():
    """Return the members of the package's classes, by the name of the class."""
    found = {}
    for path in (ROOT / "firm_hdl").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ClassDef):
                found.setdefault(node.name, set()).update(_members_of(node))
    return found


def _members_of(node):
    for each in ast.walk(node):
        match each:
            case ast.FunctionDef(name=name) | ast.AnnAssign(target=ast.Name(id=name)):
                yield name
            case ast.Attribute(value=ast.Name(id="self"), attr=name, ctx=ast.Store()):
                yield name


def unknown_members(page):
    return [
        f"{owner}.{name}"
        for owner, name in MEMBER.findall(page)
        if name not in members().get(owner, ())
    ]


def test_members_that_the_page_names_exist():
    assert len(MEMBER.findall(PAGE)) >= 4 and unknown_members(PAGE) == []


def test_a_member_that_is_gone_is_seen():
    page = PAGE.replace("`Plan.begins`", "`Plan.counted`") + "`Plans.begins`"
    assert unknown_members(page) == ["Plan.counted", "Plans.begins"]


def lengths(page):
    """Count the files that each walk touches: those in the first cells of its rows."""
    cells = [[row.split("|")[1] for row in rows] for rows in tables(page)]
    return [sum(cell.count("`") // 2 for cell in each) for each in cells]


def test_a_walk_touches_at_most_six_files():
    # There are six walks: oracles of definitions and of packets have one each.
    assert lengths(PAGE) == [6, 5, 6, 5, 6, 6]


def test_a_file_that_is_gone_is_seen():
    page = PAGE.replace("`firm_hdl/wire/formats.py`", "`firm_hdl/wire/format.py`")
    assert list(missing(page)) == ["firm_hdl/wire/format.py"]


def test_a_walk_that_is_too_long_is_seen():
    row = "| `firm_hdl/wire/formats.py` | Add it to `RULES`. |\n"
    assert lengths(PAGE.replace(row, 3 * row))[0] == 8


def test_a_row_with_two_files_counts_as_two():
    two = PAGE.replace("| `docs/design.md` |", "| `docs/design.md`, `docs/plan.md` |")
    assert lengths(two)[1] == 6
