"""A design as C++: what Verilator makes of its Verilog, with the table of its ports."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

import jinja2

from firm_hdl.garbage import search_put_off
from firm_hdl.jobs import ToolError, made_by, run_tool
from firm_hdl.rtlil import convert_fragment
from firm_hdl.sim.fast.top import Top
from firm_hdl.verilog import convert

__all__ = ["SERVER", "VerilatedSource", "translate", "verilated_source"]

SERVER = Path(__file__).parent / "server.h"
"""The part of the program that is the same for all designs."""

MOST_WAVE_BYTES = 1 << 30
"""Where a waveform ends: a live simulation has no end."""

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


class VerilatedSource:
    """The source of a program that simulates a design, before Verilator has run.

    Attributes
    ----------
    verilog : str
        It has no paths, so that it is the same for the same design.
    main : str
        C++ with the table of the ports.
    modules : mapping of str to str
        More Verilog by file name: modules that the design has instances of.
    traced : bool
        The program writes a waveform.
    """

    def __init__(
        self,
        verilog: str,
        main: str,
        modules: Mapping[str, str] | None = None,
        *,
        traced: bool = False,
    ):
        self.verilog, self.main, self.modules = verilog, main, modules or {}
        self.traced = traced


@search_put_off()
def verilated_source(
    top: Top, modules: Mapping[str, str] | None = None, *, traced: bool = False
) -> VerilatedSource:
    """Elaborate a design.

    Raises
    ------
    ClockDomainError, wiring.ConnectionError
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
    return VerilatedSource(convert(netlist, name=_MODULE), main, modules, traced=traced)


def translate(
    source: VerilatedSource, verilator: tuple[str, ...], folder: Path
) -> tuple[list[Path], Path]:
    """Write the C++ of a design into a folder.

    Returns
    -------
    list of Path, Path
        The files that are to be compiled, those of Verilator's runtime included, and the folder
        of its headers.

    Raises
    ------
    ToolError
    """
    (folder / "design.v").write_text(source.verilog, encoding="utf-8")
    (folder / "main.cpp").write_text(source.main, encoding="utf-8")
    (folder / SERVER.name).write_bytes(SERVER.read_bytes())
    for name, text in source.modules.items():
        (folder / name).write_text(text, encoding="utf-8")
    options = [*_OPTIONS, *(["--trace"] if source.traced else [])]
    run_tool([*verilator, *options, "design.v", *source.modules], folder)
    makefile = made_by("Verilator", folder / f"{_PREFIX}_classes.mk").read_text(encoding="utf-8")
    # Which parts of the runtime a model needs depends on the version.
    parts = re.search(r"^VM_GLOBAL_FAST \+= ((?:\\\n|[^\n])*)", makefile, re.MULTILINE)
    root = run_tool([*verilator, "--getenv", "VERILATOR_ROOT"], folder).strip()
    if not parts or not root:
        raise ToolError("Verilator did not say where its runtime is, or which parts a model needs")
    headers = Path(root, "include")
    runtime = [headers / f"{part}.cpp" for part in parts[1].replace("\\", " ").split()]
    return [*sorted(folder.glob("*.cpp")), *runtime], headers
