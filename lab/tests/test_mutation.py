"""Smoke test of the tool that puts faults into the program."""

from __future__ import annotations

import json

import pytest

from lab.mutation import main
from tests.frontend.workspace import make_files


@pytest.mark.thorough
def test_a_fault_is_noticed_or_survives(tmp_path, capsys):
    root, out = tmp_path / "root", tmp_path / "out.jsonl"
    files = {
        "firm_hdl/__init__.py": "",
        "firm_hdl/part.py": "def least(a, b):\n    return a if a < b else b\n",
        "tests/test_part.py": "from firm_hdl.part import least\n"
        "def test_least():\n    assert least(1, 2) == least(2, 1) == 1\n",
    }
    make_files(root, files)
    assert main(["--root", str(root), "--seed", "1", "--out", str(out)]) == 0
    found = {(f["old"], f["new"]): f for f in map(json.loads, out.read_text().splitlines())}
    # Of equal numbers, either is the least.
    assert found["<", "<="]["result"] == "survived"
    turned = found["a < b", "(not (a < b))"]
    assert (turned["result"], turned["test"]) == ("noticed", "tests/test_part.py::test_least")
    assert (root / "firm_hdl/part.py").read_text() == files["firm_hdl/part.py"]
    assert capsys.readouterr().out.endswith("1 noticed, 1 survived\n")
