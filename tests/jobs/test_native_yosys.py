"""Yosys of the package pyosys as a command."""

from __future__ import annotations

import importlib.util
import re
import subprocess
import sys

import pytest

from firm_hdl.jobs import native_yosys
from tests.tools import need

MODULE = "module top(input a, output b); assign b = ~a; endmodule\n"


@pytest.fixture
def yosys(tmp_path):
    """Return a function that runs the command in a folder with ``top.v``."""
    need("pyosys", importlib.util.find_spec("pyosys") and "installed")
    (tmp_path / "top.v").write_text(MODULE)

    def run(*arguments):
        command = [sys.executable, native_yosys.__file__, *arguments]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout, done.stderr

    return run


def test_it_says_its_version(yosys):
    status, said, errors = yosys("-V")
    assert (status, errors) == (0, "")
    assert re.match(r"Yosys \d+\.\d+", said)


def test_a_script_writes_its_files_and_nothing_else(yosys, tmp_path):
    script = "read_verilog top.v; prep -top top; write_json top.json"
    assert yosys("-q", "-p", script) == (0, "", "")
    assert '"$not"' in (tmp_path / "top.json").read_text()


def test_a_command_that_fails_ends_the_script_with_its_error(yosys, tmp_path):
    status, said, errors = yosys("-q", "-p", "read_verilog no.v; write_json top.json")
    assert (status, said) == (1, "")
    assert errors == "ERROR: File `no.v' not found or is a directory\n"
    assert not (tmp_path / "top.json").exists()


def test_the_log_goes_to_its_file_or_to_standard_output(yosys, tmp_path):
    _, said, _ = yosys("-p", "read_verilog top.v")
    assert "Generating RTLIL representation" in said
    assert yosys("-l", "yosys.log", "-q", "-p", "read_verilog top.v") == (0, "", "")
    assert "Generating RTLIL representation" in (tmp_path / "yosys.log").read_text()


@pytest.mark.parametrize("arguments", [(), ("-q", "-s", "file"), ("-V", "-p", "stat")])
def test_other_options_are_refused(yosys, arguments):
    status, said, errors = yosys(*arguments)
    assert (status, said) == (2, "")
    assert errors.startswith("usage: native_yosys ")
