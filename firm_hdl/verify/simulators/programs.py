"""Simulators of exported text: each exports devices, replays a trace, and returns what it saw.

A bench is a template beside this file, and knows nothing of the devices but their ports.
:mod:`firm_hdl.verify.simulators.trace` describes the rows that it reads and writes. To add a
simulator, write a class with the members of `TextSimulator`, and name it in `SIMULATORS`. A program
around a model of Verilator also needs Verilator's runtime, as objects.
"""

from __future__ import annotations

import functools
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Protocol

from firm_hdl.export.templates import templates
from firm_hdl.export.top import Top
from firm_hdl.export.verilog import module_name
from firm_hdl.jobs.processes import made_by, run_tool
from firm_hdl.jobs.programs import (
    ProgramMissingError,
    find_compiler,
    find_ghdl,
    find_program,
    find_verilator,
    verilator_sources,
    version_of,
    which,
)
from firm_hdl.names.identifiers import identifier
from firm_hdl.verify.simulators.trace import ARESETN, Trace
from firm_hdl.verilog import convert as convert_to_verilog
from firm_hdl.vhdl.convert import convert as convert_to_vhdl

__all__ = [
    "SIMULATORS",
    "Ghdl",
    "Icarus",
    "TextSimulator",
    "Verilator",
    "runtime_of",
    "simulator",
]


class Runtime:
    """Sources, such as those of Verilator's runtime, as objects that programs are linked with.

    * `options`: options of the compiler.
    * `sources`: their folders are searched for headers.
    """

    def __init__(self, compiler: Sequence[str], options: Sequence[str], sources: Sequence[Path]):
        # Removed with this object, at the end of the process.
        self._folder = tempfile.TemporaryDirectory(prefix="firm-hdl-")
        folder = Path(self._folder.name)
        # Compiler options with the folders of the headers.
        self.includes = [f"-I{each}" for each in dict.fromkeys(path.parent for path in sources)]
        self.objects = []
        for source in sources:
            self.objects.append(str(folder / f"{source.stem}.o"))
            command = [*compiler, *options, *self.includes, "-c", str(source)]
            run_tool([*command, "-o", self.objects[-1]], folder)


@functools.cache
def runtime_of(
    compiler: tuple[str, ...], options: tuple[str, ...], sources: tuple[Path, ...]
) -> Runtime:
    """Return a runtime, compiled once in a process."""
    return Runtime(compiler, options, sources)


_HERE = Path(__file__).parent
_STIMULI, _RESULTS = "stimuli.txt", "results.txt"


class TextSimulator(Protocol):
    """A simulator of exported text. To make one raises `ProgramMissingError` if it is missing."""

    title: str  # The name of the simulator in messages.

    @property
    def version(self) -> str:
        """What the simulator says of its version."""

    def replay(self, trace: Trace, tops: Sequence[Top], folder: Path) -> list[str]:
        """Run a trace; return rows of outputs as they are in `Trace.expected`.

        A bit that is undefined in the simulator is a letter, such as ``X``.

        * `tops`: the tops of the devices to export, in order.
        * `folder`: an empty folder for the files of the simulator.

        Raises `ToolError`.
        """


class Ghdl:
    """GHDL, on the VHDL that ``firm-hdl build`` writes for the ``_flat`` entities."""

    title = "GHDL"

    def __init__(self) -> None:
        self.path = find_ghdl()

    @property
    def version(self) -> str:
        return version_of(self.path)

    def replay(self, trace: Trace, tops: Sequence[Top], folder: Path) -> list[str]:
        made = [
            convert_to_vhdl(top, name=device.name)
            for device, top in zip(trace.devices, tops, strict=True)
        ]
        files = {name: text for vhdl in made for name, text in vhdl.files.items()}
        # The outermost entity is the last one.
        ports = [list(vhdl.entities.values())[-1].ports for vhdl in made]
        files["replay.vhd"] = _bench("replay.vhd", trace, ports=ports)
        for name, text in files.items():
            (folder / name).write_text(text, encoding="utf-8")
        (folder / _STIMULI).write_text("".join(f"{row}\n" for row in trace.stimuli))
        run_tool([self.path, "-a", "--std=08", *files], folder)
        run = [self.path, "--elab-run", "--std=08", "replay", "--ieee-asserts=disable-at-0"]
        run_tool(run, folder)
        return made_by(self.title, folder / _RESULTS).read_text().splitlines()


class Icarus:
    """Icarus Verilog, on the Verilog that ``firm-hdl build`` writes.

    It has four values, and compiles quickly. The text is read as SystemVerilog, as cocotb does.
    """

    title = "Icarus Verilog"

    def __init__(self) -> None:
        self.path = find_program(self.title, "IVERILOG", ["iverilog"], "iverilog")
        # The compiler and vvp belong together, so look for vvp beside the compiler first.
        run = which(str(Path(self.path).with_name("vvp"))) or which("vvp")
        if run is None:
            raise ProgramMissingError(f"{self.title} has no command vvp beside '{self.path}'")
        self.run_path = run

    @property
    def version(self) -> str:
        # What the compiler writes runs in vvp.
        said = (version_of(path, "-V") for path in (self.path, self.run_path))
        return "; ".join(each.partition("; ")[0] for each in said)

    def replay(self, trace: Trace, tops: Sequence[Top], folder: Path) -> list[str]:
        files = _write_verilog("replay_icarus.v", trace, tops, folder)
        run_tool([self.path, "-g2012", "-s", "replay", "-o", "replay.vvp", *files], folder)
        made_by(self.title, folder / "replay.vvp")
        run_tool([self.run_path, "-n", "replay.vvp"], folder)
        return made_by("vvp", folder / _RESULTS).read_text().upper().splitlines()


_VERILATE = (
    # Warnings are checked elsewhere, with `waivers.vlt`. Invalid Verilog fails all the same.
    *("--cc", "-Wno-lint", "-Wno-style", "-Wno-fatal"),
    *("--x-initial", "unique", "--x-assign", "unique"),
    *("--prefix", "Vreplay", "--top-module", "replay", "--Mdir", "model"),
)
# The program runs for less than a second, so optimization would take longer than it saves.
_COMPILE = ("-O0", "-w", "-std=gnu++17")


class Verilator:
    """Verilator, on the Verilog that ``firm-hdl build`` writes: compiled to C++.

    Verilator knows 0 and 1 only, so there are two copies of the devices. A value that the text does
    not define is 0 in one copy and 1 in the other. An example is a register without an initial
    value. A bit of an output that differs between the two copies is reported as ``X``.
    """

    title = "Verilator"

    def __init__(self) -> None:
        self.command = find_verilator("--simulator verilator")
        self.compiler = find_compiler("Verilator")

    @property
    def version(self) -> str:
        return version_of(self.command[-1])

    def replay(self, trace: Trace, tops: Sequence[Top], folder: Path) -> list[str]:
        files = _write_verilog("replay_verilator.v", trace, tops, folder)
        run_tool([*self.command, *_VERILATE, *files], folder)
        models = folder / "model"
        makefile = made_by(self.title, models / "Vreplay_classes.mk")
        # Compile all sources as one file, because the compiler mostly reads Verilator's headers.
        model = sorted(path.name for path in models.glob("*.cpp"))
        text = _bench("replay_main.cc", trace, sources=model)
        (models / "main.cc").write_text(text, encoding="utf-8")
        sources = verilator_sources(self.command, makefile.read_text(encoding="utf-8"))
        runtime = runtime_of(self.compiler, _COMPILE, (*sources, _HERE / "replay.cpp"))
        command = [*self.compiler, *_COMPILE, *runtime.includes, "model/main.cc"]
        run_tool([*command, *runtime.objects, "-pthread", "-o", "replay"], folder)
        run_tool([str(made_by(self.compiler[0], folder / "replay"))], folder)
        return made_by("the simulation", folder / _RESULTS).read_text().splitlines()


SIMULATORS: dict[str, Callable[[], TextSimulator]] = {
    "ghdl": Ghdl,
    "iverilog": Icarus,
    "verilator": Verilator,
}
"""Simulators by the names that ``firm-hdl verify --simulator`` takes."""


def simulator(name: str) -> TextSimulator | None:
    """Return a simulator by its name; `None` for ``python``, which is always used.

    Raises `ProgramMissingError`.
    """
    return None if name == "python" else SIMULATORS[name]()


def _write_verilog(bench: str, trace: Trace, tops: Sequence[Top], folder: Path) -> list[str]:
    """Write bench, devices and rows of inputs; return the names of the files of Verilog.

    Modules have the names that ``firm-hdl build`` gives them. A row begins with the number of its
    changes, because Verilog's formats cannot find a line end.
    """
    plan = trace.devices[0].plan
    base = f"{identifier(plan.message)}_{plan.wire}_{plan.bus_bytes}"
    modules = [module_name(base, device.direction) for device in trace.devices]
    texts = {
        f"{module}.v": convert_to_verilog(top, name=module)
        for module, top in zip(modules, tops, strict=True)
    }
    texts["replay.v"] = _bench(bench, trace, modules=modules)
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    rows = (f"{row.count(' ') // 2} {row}\n" for row in trace.stimuli)
    (folder / _STIMULI).write_text("".join(rows))
    return list(texts)


def _bench(name: str, trace: Trace, **more: Any) -> str:
    """Write a bench for a trace: the template of that name, with further variables."""
    files = {"STIMULI": _STIMULI, "RESULTS": _RESULTS}
    template = templates(_HERE).get_template(f"{name}.j2")
    return template.render(trace=trace, ARESETN=ARESETN, **files, **more)
