"""Make the program of a design by Verilator and a compiler, and keep it for the next time.

The name of a program is made from all that it depends on: the Verilog, the server, the versions of
Verilator and of the compiler, and its options. :mod:`firm_hdl.jobs.caches` keeps the program, and
each object that was compiled for it: whoever interrupts a long compilation goes on with the rest.
"""

from __future__ import annotations

import functools
import os
import shlex
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, field
from pathlib import Path

import jinja2

from firm_hdl.garbage import search_put_off
from firm_hdl.jobs import ToolError, made_by, run_tool
from firm_hdl.jobs.caches import cache_folder, kept_program
from firm_hdl.jobs.programs import (
    find_compiler,
    find_verilator,
    verilator_headers,
    verilator_sources,
)
from firm_hdl.rtlil import convert_fragment
from firm_hdl.sim.fast.top import Top
from firm_hdl.verilog import convert

__all__ = [
    "COMPILER_OPTIONS",
    "SERVER",
    "BuildError",
    "Report",
    "VerilatedSource",
    "program_of",
    "translate",
    "verilated_source",
]

COMPILER_OPTIONS = ("-O2",)
"""Options of the compiler, unless the user has others."""

Report = Callable[[str], object]
"""Called with a line on what is being done, when it begins and as it goes on."""

_ALWAYS = ("-std=c++17", "-w")
_COMPILE_SECONDS = 3600.0
_REPORT_SECONDS = 5.0
# Lines of a compiler's messages: the first ones say what is wrong.
_MOST_LINES = 12
_MOST_CHARACTERS = 2000


SERVER = Path(__file__).parent / "server.h"
"""The part of the program that is the same for all designs."""

MOST_WAVE_BYTES = 1 << 30
"""Where a waveform ends: a live simulation has no end."""

_TRACES = {"": (), "vcd": ("--trace",), "fst": ("--trace-fst",)}

_FST = (
    "A waveform as FST needs zlib and lz4 (Debian, Ubuntu: apt install zlib1g-dev liblz4-dev); one "
    "as VCD does not"
)

_MODULE, _PREFIX = "firm_hdl_design", "Vdesign"
_OPTIONS = (
    *("--cc", "-Wno-lint", "-Wno-style", "-Wno-fatal", "--no-timing"),
    # Amaranth's `Assert` and `Print`.
    "--assert",
    # Registers and memories have initial values, and wires have drivers.
    *("--x-assign", "fast", "--x-initial", "fast", "-O3"),
    # Files of a user's may have words that are keywords of SystemVerilog only.
    "+1364-2005ext+v",
    # Several files, for the processors of the machine.
    *("--output-split", "20000"),
    *("--top-module", _MODULE, "--prefix", _PREFIX, "--Mdir", "."),
)
_templates = jinja2.Environment(
    loader=jinja2.FileSystemLoader(Path(__file__).parent),
    trim_blocks=True,
    lstrip_blocks=True,
    undefined=jinja2.StrictUndefined,
)


class BuildError(ToolError):
    """The program of a design could not be made; the text has the command and what it said."""


def program_of(
    source: Callable[[], VerilatedSource],
    *,
    options: Sequence[str] = COMPILER_OPTIONS,
    cache: Path | None = None,
    report: Report | None = None,
) -> Path:
    """Return the program of a design; compile it unless it is in the cache.

    * `source`: elaborates the design; it is called once there are Verilator and a compiler.
    * `options`: for the compiler, such as ``-O1``, which compiles faster.
    * `cache`: folder of programs, which other users must not be able to write. `None`: the user's
      cache.
    * `report`: told the stages of a compilation.

    Raises `BuildError`. Raises `ProgramMissingError` if there is no Verilator, or no C++ compiler.
    """
    verilator = find_verilator("A fast simulation")
    compiler = find_compiler("A fast simulation", with_zig=True)
    tell = report or _nothing
    tell("elaborates the design")
    build = _Build(source(), verilator, (*compiler, *options, *_ALWAYS), cache, tell)
    versions = _said(verilator, "--version"), _said(compiler, "--version")
    text = SERVER.read_text(encoding="utf-8")
    more = [each for module in build.source.modules.items() for each in module]
    parts = (build.source.verilog, build.source.main, text, *more, *versions, *build.command)
    try:
        return kept_program("simulation", parts, build.make, cache)
    except OSError as error:
        raise BuildError(f"The program of a design cannot be kept: {error}") from None


class _Build:
    """The compilation of one program."""

    def __init__(
        self,
        source: VerilatedSource,
        verilator: tuple[str, ...],
        command: tuple[str, ...],
        cache: Path | None,
        report: Report,
    ):
        self.source, self.verilator, self.command = source, verilator, command
        self.cache, self.report = cache, report

    def make(self, folder: Path) -> Path:
        """Compile all files side by side, and link them."""
        libraries = self._libraries(folder) if self.source.traced == "fst" else []
        self.report("Verilator translates it to C++")
        try:
            files, headers = translate(self.source, self.verilator, folder)
        except ToolError as error:
            raise BuildError(f"Verilator failed: {_shortened(str(error))}") from None
        include = (f"-I{headers}", f"-I{headers / 'vltstd'}")
        own = "".join(path.read_text(encoding="utf-8") for path in sorted(folder.glob("*.h")))
        stop = threading.Event()
        started = told = time.monotonic()
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            futures = [
                pool.submit(self._object, path, folder, include, own, stop) for path in files
            ]
            try:
                objects = []
                for future in as_completed(futures):
                    objects.append(future.result())
                    now = time.monotonic()
                    if now > told + _REPORT_SECONDS or len(objects) == len(files):
                        told = now
                        done = f"{len(objects)} of {len(files)} files"
                        self.report(f"compiled {done} in {now - started:.0f} s")
            except BaseException:
                # Also Ctrl-C. What has been compiled is kept.
                stop.set()
                pool.shutdown(cancel_futures=True)
                raise
        linked = [*self.command, *sorted(map(str, objects)), "-pthread", *libraries]
        return self._run(linked, folder / "program", folder)

    def _libraries(self, folder: Path) -> list[str]:
        """Return the libraries that compress FST, once a program of one line has been linked."""
        names = {"z": "zlib.h"}
        try:
            if (verilator_headers(self.verilator) / "fstcpp").exists():
                # Newer versions of Verilator do not bring their own lz4.
                names["lz4"] = "lz4.h"
        except ToolError as error:
            raise BuildError(f"Verilator failed: {error}") from None
        # `translate` compiles the files of another folder.
        probe = folder / "probe" / "probe.cpp"
        probe.parent.mkdir()
        text = "".join(f"#include <{header}>\n" for header in names.values())
        probe.write_text(f"{text}int main() {{}}\n", encoding="utf-8")
        libraries = [f"-l{name}" for name in names]
        try:
            self._run([*self.command, str(probe), *libraries], probe.with_suffix(""), folder)
        except BuildError as error:
            raise BuildError(f"{error}\n{_FST}") from None
        return libraries

    def _object(
        self, path: Path, folder: Path, include: Sequence[str], own: str, stop: threading.Event
    ) -> Path:
        """Compile a file, unless its object is kept."""
        # What runs once, at the start, is a third of the text.
        command = [*self.command, *(["-O0"] if "Slow" in path.name else []), *include]
        whole = [*command, "-c", str(path)]

        def make(scratch: Path) -> Path:
            return self._run(whole, scratch / "object.o", folder, stop)

        version = _said(tuple(self.command), "--version")
        parts = (path.read_text(encoding="utf-8"), own, version, *command)
        return kept_program("object", parts, make, self.cache)

    def _run(
        self,
        command: Sequence[str],
        output: Path,
        folder: Path,
        stop: threading.Event | None = None,
    ) -> Path:
        whole = [*command, "-o", str(output)]
        try:
            run_tool(whole, folder, environment=_environment(), timeout=_COMPILE_SECONDS, stop=stop)
            return made_by(command[0], output)
        except ToolError as error:
            said = _shortened(str(error))
            raise BuildError(f"The compiler failed: {shlex.join(whole)}\n{said}") from None


def _nothing(line: str) -> None:
    """Report to nobody."""


def _shortened(text: str) -> str:
    """Return the first lines of what a program said, and how many more there are."""
    lines = text.splitlines()
    short = "\n".join(lines[:_MOST_LINES])[:_MOST_CHARACTERS]
    more = len(lines) - _MOST_LINES
    return f"{short}\n... and {more} more lines" if more > 0 else short


@functools.cache
def _said(command: tuple[str, ...], option: str) -> str:
    try:
        return run_tool([*command, option], environment=_environment())
    except (ToolError, OSError) as error:
        raise BuildError(f"{shlex.join(command)} {option} failed: {error}") from None


def _environment() -> dict[str, str]:
    """Return where the compiler of `ziglang` keeps what it has compiled of its library."""
    return {"ZIG_GLOBAL_CACHE_DIR": str(cache_folder() / "zig")}


@dataclass(slots=True)
class VerilatedSource:
    """The source of a program that simulates a design, before Verilator has run."""

    verilog: str  # It has no paths, so that it is the same for the same design.
    main: str  # C++ with the table of the ports.
    # More Verilog by file name: modules that the design has instances of.
    modules: Mapping[str, str] = field(default_factory=dict)
    traced: str = ""  # The format of the waveform that the program writes.


@search_put_off()
def verilated_source(
    top: Top, modules: Mapping[str, str] | None = None, *, traced: str = ""
) -> VerilatedSource:
    """Elaborate a design.

    Raises `ClockDomainError` or `wiring.ConnectionError`.
    """
    netlist = convert_fragment(top.prepare(name=_MODULE), (), name=_MODULE)
    main = _templates.get_template("model.cc.j2").render(
        prefix=_PREFIX,
        streams=[*zip(top.ports.streams, top.clock_of, strict=True)],
        plain=top.ports.plain,
        clocks=top.clocks,
        traced=traced,
        most_bytes=MOST_WAVE_BYTES,
    )
    return VerilatedSource(convert(netlist, name=_MODULE), main, modules or {}, traced)


def translate(
    source: VerilatedSource, verilator: tuple[str, ...], folder: Path
) -> tuple[list[Path], Path]:
    """Write the C++ of a design into a folder.

    Returns the files that are to be compiled, those of Verilator's runtime included, and the folder
    of its headers.

    Raises `ToolError`.
    """
    (folder / "design.v").write_text(source.verilog, encoding="utf-8")
    (folder / "main.cpp").write_text(source.main, encoding="utf-8")
    (folder / SERVER.name).write_bytes(SERVER.read_bytes())
    for name, text in source.modules.items():
        (folder / name).write_text(text, encoding="utf-8")
    options = [*_OPTIONS, *_TRACES[source.traced]]
    run_tool([*verilator, *options, "design.v", *source.modules], folder)
    makefile = made_by("Verilator", folder / f"{_PREFIX}_classes.mk").read_text(encoding="utf-8")
    runtime = verilator_sources(verilator, makefile)
    files = sorted(folder.glob("*.cpp"))
    if "VM_PARALLEL_BUILDS = 0" in makefile:
        # A small design, whose files Verilator did not split: most of the time goes into headers.
        texts = {"all.cpp": "", "all__Slow.cpp": ""}
        for path in files:
            name = "all__Slow.cpp" if "Slow" in path.name else "all.cpp"
            texts[name] += f'#line 1 "{path.name}"\n{path.read_text(encoding="utf-8")}\n'
        files = [folder / name for name in texts]
        for path in files:
            path.write_text(texts[path.name], encoding="utf-8")
    return [*files, *runtime], runtime[0].parent
