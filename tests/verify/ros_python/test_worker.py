"""The process that runs ROS's modules: its answers, its limits, and its environment.

A module of this test takes the place of ROS's, and this Python that of ROS's Python.
"""

from __future__ import annotations

import math
import sys
from contextlib import closing

import pytest

from firm_hdl.verify.ros_python import worker as module
from firm_hdl.verify.ros_python.worker import DIED, Worker

FAMILY = """
import os, sys, time

def readers(folder):
    paths = list(sys.path)
    if folder == "none":
        import a_module_that_is_not_there

    def repeat(request):
        print("noise")
        os.system("echo noise")
        print("noise", file=sys.stderr)
        return {"request": request, "folder": folder, "paths": paths}

    def fail(request):
        raise ValueError("x" * 2000)

    def deep(request):
        return deep(request)

    def slow(request):
        until = time.process_time() + 20
        while time.process_time() < until:
            pass

    judges = {
        "repeat": repeat,
        "fail": fail,
        "leave": lambda request: sys.exit("bye"),
        "deep": deep,
        "slow": slow,
        "large": lambda request: len(bytes(4 << 30)),
        "numbers": lambda request: [float("nan"), float("-inf"), -0.0],
        "environment": lambda request: dict(os.environ),
        "die": lambda request: os._exit(3),
    }
    return judges, ("pytest", "no-package-of-this-name")
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "worker_fake.py").write_text(FAMILY)
    return tmp_path


@pytest.fixture
def mine(folder, monkeypatch):
    """A worker that may take a tenth of a second of processor time for an answer."""
    text = module._SCRIPT.read_text()
    assert "MOST_SECONDS = 60 " in text
    script = folder / "script.py"
    script.write_text(text.replace("MOST_SECONDS = 60 ", "MOST_SECONDS = 0.1 "))
    monkeypatch.setattr(module, "_SCRIPT", script)
    with closing(Worker("fake", "here", modules=folder, python=sys.executable)) as found:
        assert found.missing is None
        yield found


def test_the_process_of_a_worker_that_nobody_closes_ends_with_it(folder):
    found = Worker("fake", "here", modules=folder, python=sys.executable)
    process = found._process
    assert process.poll() is None
    del found
    assert process.poll() is not None


def test_requests_arrive_whole_and_what_is_printed_does_no_harm(mine, folder):
    for number in range(3):
        request = {"oracle": "repeat", "text": "é\n\ud800", "number": number}
        facts = mine.ask(request)["facts"]
        assert (facts["request"], facts["folder"]) == (request, "here")
    # ROS may have modules with the names of ours.
    assert str(folder) not in facts["paths"] and "" not in facts["paths"]
    nan, *others = mine.ask({"oracle": "numbers"})["facts"]
    assert math.isnan(nan) and str(others) == "[-inf, -0.0]"


def test_a_program_that_prints_a_line_without_end_is_ended(folder):
    (folder / "endless").write_text("#!/bin/sh\nexec cat /dev/zero\n")
    (folder / "endless").chmod(0o755)
    found = Worker("fake", "here", modules=folder, python=str(folder / "endless"))
    assert found.missing == "its Python does not start" and found._process is None


def test_what_a_reader_raises_is_a_refusal(mine):
    answer = mine.ask({"oracle": "fail"})["refused"]
    assert answer.startswith("ValueError: xxx") and len(answer) == 1000
    assert mine.ask({"oracle": "leave"}) == {"refused": "SystemExit: bye"}
    assert mine.ask({"oracle": "deep"}) == {"refused": "RecursionError: it never ends"}


def test_a_reader_that_takes_too_much_has_failed(mine):
    assert mine.ask({"oracle": "slow"}) == {"failed": "it took over 0.1 s"}
    assert mine.ask({"oracle": "large"}) == {"failed": "it took over 3 GiB"}
    # The same process answers the next request.
    assert "facts" in mine.ask({"oracle": "repeat"})


def test_a_worker_that_died_is_replaced_by_the_next_request(mine):
    first = mine._process
    assert mine.ask({"oracle": "die"}) == {"failed": DIED}
    assert first.poll() == 3
    assert "facts" in mine.ask({"oracle": "repeat"})
    assert mine._process is not first
    assert mine.ask({"oracle": "no such judge"}) == {"failed": DIED}


def test_modules_that_cannot_be_loaded_are_missing(folder):
    for family, given, name in (
        ("fake", "none", "a_module_that_is_not_there"),
        ("other", "here", "worker_other"),
    ):
        found = Worker(family, given, modules=folder, python=sys.executable)
        assert found.missing == f"ModuleNotFoundError: No module named '{name}'"
        assert (found.versions, found._process, found.cpu_seconds) == ({}, None, 0)
    silent = Worker("fake", "here", modules=folder, python="/bin/false")
    assert silent.missing == "its Python does not start" and silent._process is None
    nowhere = Worker("fake", "here", modules=folder, python="/nowhere/python")
    assert nowhere.missing == "/nowhere/python cannot be run: No such file or directory"


ODD_LINES = ["", "hello", "{", "3", "null", "true", '"ab"', "[]", "[1]", "[[1, 2]]", "{}"]


def other_program(folder, *lines):
    """Make a program that prints lines in place of answers: one at first, one for each request."""
    first, *others = (f"printf '%s\\n' '{line}'" for line in lines)
    asked = "".join(f"read -r request\n{line}\n" for line in others)
    path = folder / "other"
    path.write_text(f"#!/bin/sh\n{first}\n{asked}read -r request\n")
    path.chmod(0o755)
    return str(path)


@pytest.mark.parametrize("line", ODD_LINES)
def test_a_program_that_is_no_python_of_ros_is_missing(tmp_path, line):
    python = other_program(tmp_path, line)
    with closing(Worker("fake", "here", modules=tmp_path, python=python)) as found:
        assert found.missing == "its Python does not start" and found._process is None
        # It may be asked nevertheless.
        assert found.ask({"oracle": "repeat"}) == {"failed": found.missing}
