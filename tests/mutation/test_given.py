"""Faults that somebody wrote by hand."""

from __future__ import annotations

import pytest
import yaml

from tools.mutation.__main__ import main
from tools.mutation.given import read_faults

NAME = "firm_hdl/wire/toy.py"
FAULT = {"path": NAME, "old": "x + x", "new": "x - x"}


@pytest.fixture
def root(tmp_path):
    """A repository with one module."""
    path = tmp_path / "repository" / NAME
    path.parent.mkdir(parents=True)
    path.write_text("def double(x):\n    return x + x  # x\n")
    return tmp_path / "repository"


def test_an_entry_is_one_change(root):
    path = root / "faults.yaml"
    path.write_text(yaml.safe_dump([FAULT, {**FAULT, "new": "x", "why": "half"}]))
    first, second = read_faults(root, path)
    assert (first.path, first.target, first.line) == (NAME, "wire", 2)
    text = (root / NAME).read_text()
    assert first.change.apply(text) == "def double(x):\n    return x - x  # x\n"
    assert (second.place.old, second.place.new) == ("return x + x  # x", "return x  # x")
    assert (second.change.rule, second.change.scope) == ("by hand", "half")
    assert first.key != second.key


@pytest.mark.parametrize(
    ("new", "line"),
    [
        ("if x:\n        x = 1\n    return y", 6),
        ("if x:\n        x = 1\n        x = 2\n    return x", 6),
        ("if x:\n        x = 2\n    return x", 5),
        ("if x:\n        x = 1\n    ", 6),
        ("if x:\n        x = 1", 6),
        ("if x:", 5),
        ("", 4),
    ],
)
def test_a_change_starts_at_the_first_line_that_differs(root, new, line):
    """Tests are chosen by this line, and the lines before it may run in other ones."""
    (root / NAME).write_text("# x\n\ndef f(x):\n    if x:\n        x = 1\n    return x\n")
    path = root / "faults.yaml"
    old = "if x:\n        x = 1\n    return x"
    path.write_text(yaml.safe_dump([{"path": NAME, "old": old, "new": new}]))
    (fault,) = read_faults(root, path)
    text = (root / NAME).read_text()
    assert (fault.line, fault.change.apply(text)) == (line, text.replace(old, new))


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({**FAULT, "old": "x * x"}, "fault 2: 0 places have the text in firm_hdl/wire/toy.py"),
        ({**FAULT, "old": "x"}, "fault 2: 4 places have the text"),
        ({**FAULT, "old": ""}, "fault 2: 0 places"),
        ({**FAULT, "new": "x + x"}, "fault 2: the new text is the old one"),
        ({**FAULT, "path": "tests/test_toy.py"}, "fault 2: tests/test_toy.py is no file of"),
        ({"path": NAME, "old": "x + x"}, "fault 2: needs the texts path, old and new"),
        ({**FAULT, "new": 3}, "fault 2: needs the texts"),
        ("x + x", "fault 2: needs the texts"),
    ],
)
def test_what_cannot_be_planted_ends_the_command(root, capsys, given, message):
    path = root / "faults.yaml"
    path.write_text(yaml.safe_dump([FAULT, given]))
    (root / "tests").mkdir()
    (root / "tests/test_toy.py").write_text("")
    assert main(["--root", str(root), "--faults", str(path)]) == 1
    assert f"error: {path}: {message}" in capsys.readouterr().err


@pytest.mark.parametrize("text", ["a: b\n", "[a\n", None])
def test_a_file_that_is_no_list_ends_the_command(root, capsys, text):
    path = root / "faults.yaml"
    if text is not None:
        path.write_text(text)
    (root / "tests").mkdir()
    (root / "tests/test_toy.py").write_text("")
    assert main(["--root", str(root), "--faults", str(path)]) == 1
    assert f"error: {path}: " in capsys.readouterr().err
