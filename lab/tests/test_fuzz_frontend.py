"""Smoke tests of the fuzzer of the front end."""

from __future__ import annotations

import os
import random
from pathlib import Path

from firm_hdl.frontend import interfaces, parse
from lab.fuzz_frontend import Fuzzer, main
from tests.depth import by_depth

FOLDER = Path(__file__).parents[2] / "tests" / "frontend" / "errors"


def test_damaged_files_end_in_a_model_or_an_error():
    folder = Path(os.environ.get("FIRM_HDL_CORPUS") or FOLDER)
    seed = random.SystemRandom().randrange(10**6)
    print(f"--seed {seed}")
    counts, findings = Fuzzer(folder, seed).run(range(by_depth(30, 300)))
    assert findings == []
    # The folder with errors has few files that still give a model.
    assert counts["error"] and counts["model"] + counts["error"] == counts.total()


def test_an_exception_of_another_kind_is_found_and_cut_down(monkeypatch):
    fuzzer = Fuzzer(FOLDER, 1)
    original = parse.read_message

    def broken(source, *arguments, **keywords):
        if "Fuzz" in source.name and "int" in source.text:
            raise RuntimeError("this is a bug")
        return original(source, *arguments, **keywords)

    monkeypatch.setattr(interfaces, "read_message", broken)
    numbers = [n for n in range(100) if fuzzer.input(n)[0].language == "msg"]
    _, findings = fuzzer.run(numbers[:10])
    assert findings
    for finding in findings:
        assert finding.problem.startswith("RuntimeError in test_fuzz_frontend.py:")
        assert finding.text == "int"


def test_command_prints_its_seed_and_what_came_out(tmp_path, monkeypatch, capsys):
    monkeypatch.delenv("FIRM_HDL_CORPUS", raising=False)
    arguments = ["-n", "20", "--seed", "7", "--jobs", "1", "--out", str(tmp_path)]
    assert main(arguments) == 0
    first, last = capsys.readouterr().out.splitlines()
    assert first.startswith("--seed 7, 20 inputs from ")
    assert ", 0 findings; " in last
