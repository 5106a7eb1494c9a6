"""Convert any Amaranth design to Verilog.

The netlist and the names are those of the VHDL: see :mod:`firm_hdl.vhdl.convert`. So a signal has
one name in both languages. The text depends on the design only: it has no paths, no dates and no
source locations.
"""

from __future__ import annotations

import re
from typing import Any

from firm_hdl.names.keywords import VERILOG
from firm_hdl.verilog.module import ModuleWriter
from firm_hdl.vhdl.convert import Netlist

__all__ = ["convert"]

_IS_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_$]*")


def convert(
    design: Any, *, name: str = "top", ports: Any = None, platform: Any = None, header: str = ""
) -> str:
    """Write a design as Verilog that simulates the same in Verilog-2005 and in SystemVerilog.

    Parameters
    ----------
    design : elaboratable or str
        An Amaranth component or other elaboratable, RTLIL text of `amaranth.back.rtlil`, or a
        netlist that was read already.
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
    wiring.ConnectionError
        If a stream of a component is connected twice.
    """
    netlist = Netlist.of(design, name=name, ports=ports, platform=platform)
    if not _IS_NAME.fullmatch(name) or name in VERILOG:
        raise ValueError(f"Name of a module must be an identifier of SystemVerilog, not {name!r}")
    top = netlist.design.top.name
    entities = {**netlist.entities, top: name}
    # Users connect ports of the outermost module: they keep each name that Verilog allows.
    plain = {
        port: port if _IS_NAME.fullmatch(port) and port not in VERILOG else given
        for port, given in netlist.port_names[top].items()
    }
    comment = "".join(f"// {line}".rstrip() + "\n" for line in header.splitlines())
    texts = (
        ModuleWriter(
            module,
            entities=entities,
            port_names={**netlist.port_names, top: plain},
            modules=netlist.design.modules,
        ).text()
        for module in netlist.bottom_up()
    )
    return "\n".join([*([comment] if comment else []), *texts])
