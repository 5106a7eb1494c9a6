"""Tools that end without output and without doing anything never cause a pass."""

from __future__ import annotations

import functools
import os
import stat

import pytest

import firm_hdl.verify.ros_python.worker as worker
from firm_hdl.cases.make import make_cases
from firm_hdl.cases.oracle import distro_oracle
from firm_hdl.cli import main
from firm_hdl.frontend import Library
from firm_hdl.jobs.programs import ProgramMissingError
from firm_hdl.verify.clients.system import compare
from firm_hdl.verify.references.clients import CLIENTS
from firm_hdl.verify.results.verdict import Passed
from firm_hdl.verify.simulators.programs import Verilator
from firm_hdl.verify.systems.options import CaseOptions
from firm_hdl.verify.systems.system import Trial
from firm_hdl.verify.ts3.confirm import confirm
from tests.depth import by_depth
from tests.tools import need
from tests.verify.judged import accept
from tests.verify.report.samples import a_test

BOOL = "std_msgs/msg/Bool"
SILENT = {0: "#!/bin/sh\nexit 0\n", 1: "#!/bin/sh\nexit 1\n"}
ANY = pytest.mark.parametrize("status", SILENT)


@pytest.fixture
def fake(tmp_path, monkeypatch):
    """Put programs on the PATH, before the real ones; return the path of the last."""
    folder = tmp_path / "bin"
    folder.mkdir()
    monkeypatch.setenv("PATH", f"{folder}{os.pathsep}{os.environ['PATH']}")
    for name in ("GHDL", "IVERILOG", "VERILATOR", "CXX"):
        monkeypatch.delenv(name, raising=False)

    def put(text, *names):
        for name in names:
            (folder / name).write_text(text)
            (folder / name).chmod(stat.S_IRWXU)
        return str(folder / names[-1])

    return put


@pytest.mark.thorough
@pytest.mark.parametrize("status", [0, pytest.param(1, marks=pytest.mark.thorough)])
def test_bench_does_not_pass_with_a_silent_ghdl(fake, capsys, status):
    fake(SILENT[status], "ghdl")
    # Its VHDL is written in half the time of others.
    name = by_depth("std_msgs/msg/Empty", BOOL)
    call = ["verify", "--systems", "bench", "--distro", "lyrical", "--jobs", "1", name]
    assert main(call) == 1
    output = capsys.readouterr().out
    why = "ended without a word: it has not passed" if status == 0 else "exit status 1"
    assert f"FAIL {name} (lyrical)\n" in output and why in output
    assert "lyrical     0 of    1 benches pass (8-byte bus)\n" in output


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("simulator", "names", "status"),
    [
        # One status of each simulator takes half the time.
        pytest.param(simulator, names, status, marks=[pytest.mark.thorough] * (status != usual))
        for simulator, names, usual in (
            ("ghdl", ["ghdl"], 0),
            ("iverilog", ["vvp", "iverilog"], 1),
            ("verilator", ["verilator"], None),
        )
        for status in SILENT
    ],
)
def test_cross_check_does_not_pass_with_a_silent_simulator(
    fake, monkeypatch, simulator, names, status
):
    monkeypatch.setenv(simulator.upper(), fake(SILENT[status], *names))
    result = accept("lyrical", BOOL, CaseOptions(simulator=simulator, **FEW))
    (failure,) = result.verdict.failures
    assert ("did not write " if status == 0 else "exit status 1") in failure
    assert isinstance(passes().verdict, Passed)


FEW = {"most_cases": 1, "stalled": False, "broken": False, "references": ()}


@functools.cache
def passes():
    return accept("lyrical", BOOL, CaseOptions(**FEW))


HEADERS = '#!/bin/sh\ncase "$1" in -E) echo "#define FASTCDR_VERSION_MAJOR 1"; exit 0;; esac\n'
MAKES_A_PROGRAM = """
while [ "$1" != -o ]; do shift; done
printf '#!/bin/sh\\nexit 0\\n' >"$2"
chmod +x "$2"
"""


@pytest.mark.parametrize(
    ("compiler", "why"),
    [
        (SILENT[0], "Fast CDR's headers are not installed"),
        (SILENT[1], "Fast CDR's headers are not installed"),
        (HEADERS, "g++ ended without an error, but did not write program"),
        (HEADERS + "exit 1\n", "exit status 1"),
        (HEADERS + MAKES_A_PROGRAM, "does not say what it is"),
    ],
)
def test_fast_cdr_is_missing_if_its_compiler_does_nothing(
    fake, tmp_path, monkeypatch, compiler, why
):
    fake(compiler, "g++")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    assert why in CLIENTS["fastcdr"]().missing()


@ANY
def test_genpy_is_missing_if_its_python_prints_nothing(fake, monkeypatch, status):
    monkeypatch.setattr(worker, "ROS_PYTHON", fake(SILENT[status], "python-of-ros"))
    assert "its Python does not start" in CLIENTS["genpy"]().missing()


def given_cases(distro, name):
    wire = "ros1" if distro == "noetic" else "cdr"
    message = Library(distro).message(name)
    return message, wire, list(make_cases(distro_oracle(distro), name, wire=wire, most=3))


@pytest.mark.parametrize("answer", [{}, {"failed": worker.DIED}, {"facts": []}])
def test_reference_without_answers_confirms_nothing(monkeypatch, library_here, answer):
    genpy = library_here("genpy")
    message, wire, cases = given_cases("noetic", BOOL)
    assert confirm(message, wire, cases, ["genpy"]).by == ("genpy",)
    monkeypatch.setattr(type(genpy._worker), "ask", lambda self, request: answer)
    found = confirm(message, wire, cases, ["genpy"])
    assert found.by == () and len(found.failures) == 1
    assert found.failures[0].startswith("genpy broke down: genpy")


class OmitsLastAnswer:
    """A library that omits the last answer."""

    name, wires, byte_orders = "few", frozenset({"cdr"}), ("little",)

    def __init__(self, right):
        self.right = right

    def open(self, message, wire):
        codec = self.right.open(message, wire)
        encode_all = codec.encode_all
        codec.encode_all = lambda values: encode_all(values)[:-1]
        return codec


@pytest.mark.parametrize("is_reference", [False, True])
def test_library_that_does_not_answer_everything_fails(library_here, is_reference):
    rosbags = library_here("rosbags")
    both = (
        (rosbags, OmitsLastAnswer(rosbags)) if is_reference else (OmitsLastAnswer(rosbags), rosbags)
    )
    message = Library("lyrical").message(BOOL)
    trial = Trial.of(a_test())
    compare(*both, message, "cdr", [{"data": True}, {"data": False}], trial)
    (failure,) = trial.verdict.failures
    assert failure.startswith("few gave ") and " questions" in failure


@pytest.mark.thorough
def test_cross_check_does_not_pass_with_a_silent_compiler(fake):
    try:
        Verilator()
    except ProgramMissingError as error:
        need(f"verilator ({error})", None)
    compiler = fake(SILENT[0], "g++")
    # Not with Fast CDR, whose compiler it would be in all further tests.
    options = CaseOptions(simulator="verilator", most_cases=1, references=())
    result = accept("lyrical", BOOL, options)
    (failure,) = result.verdict.failures
    assert failure == f"Verilator: {compiler} ended without an error, but did not write replay"
