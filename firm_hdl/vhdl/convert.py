"""Convert any Amaranth design to VHDL-2008.

The design's hierarchy stays: one entity and architecture for each module, in a file of its own.
Signals and instances keep their names if VHDL allows them; `Vhdl.entities` lists all names. A copy
of a value that nothing reads has no signal, unless it has an attribute such as ``keep``. The
text depends on the design only: it has no paths, no dates and no source locations.

A signal of one bit is `std_logic`. A signal of several bits is `unsigned`, even if it is signed in
Amaranth, because in RTLIL each operator has its own flag for signed operands. Ports of the
outermost entity are `std_logic_vector`, or `unsigned` by option.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

from firm_hdl.rtlil.ir import Cell, Design, Module
from firm_hdl.rtlil.simplify import netlist_of
from firm_hdl.rtlil.write import rtlil_of
from firm_hdl.vhdl.declare import fixed_names, part_names
from firm_hdl.vhdl.module import EntityNames, ModuleWriter
from firm_hdl.vhdl.names import AMS, Scope
from firm_hdl.vhdl.package import PACKAGE, PACKAGE_NAME

__all__ = ["EntityNames", "Netlist", "Vhdl", "convert"]

_REFUSED = {
    "$anyconst": "AnyConst",
    "$anyseq": "AnySeq",
    "$initstate": "Initial",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Vhdl:
    """A design in VHDL.

    Attributes
    ----------
    top : str
        The outermost entity.
    files : mapping of str to str
        Texts by file name, in an order in which they compile.
    entities : mapping of str to EntityNames
        Names of ports, signals, memories and instances, by module of the netlist. A wire without
        bits has no entry, nor has a copy that nothing reads, nor a generated wire (``$1``) that
        became part of an expression.
    """

    top: str
    files: Mapping[str, str]
    entities: Mapping[str, EntityNames]


def convert(
    design: Any,
    *,
    name: str = "top",
    ports: Any = None,
    platform: Any = None,
    header: str = "",
) -> Vhdl:
    """Write a design as VHDL-2008.

    Parameters
    ----------
    design : elaboratable or str
        An Amaranth component or other elaboratable, RTLIL text of `amaranth.back.rtlil`, or a
        netlist that was read already.
    name : str
        Name of the outermost entity; the names of inner entities are this name and their path.
    ports, platform
        As for `amaranth.back.rtlil.convert`; a component needs no ports.
    header : str
        Lines for a comment at the head of every entity's file.

    Returns
    -------
    Vhdl
        Files in compile order, and all names.

    Raises
    ------
    TypeError
        If the design or its name is none, or an elaboratable that is no component has no ports.
    ValueError
        If the design has a construct that VHDL cannot express, such as `AnyConst`, or the text is
        not RTLIL that Amaranth 0.5 prints.
    wiring.ConnectionError
        If a stream of a component is connected twice.
    """
    netlist = Netlist.of(design, name=name, ports=ports, platform=platform)
    entities, port_names, top = netlist.entities, netlist.port_names, netlist.design.top
    remark = "".join(f"-- {line}".rstrip() + "\n" for line in header.splitlines())
    files = {f"{PACKAGE_NAME}.vhd": PACKAGE}
    names: dict[str, EntityNames] = {}
    for module in netlist.bottom_up():
        writer = ModuleWriter(
            module,
            entities=entities,
            port_names=port_names,
            modules=netlist.design.modules,
            vectors=module is top,
        )
        files[f"{entities[module.name]}.vhd"] = remark + writer.text()
        names[module.name] = writer.entity_names()
    return Vhdl(top=entities[top.name], files=files, entities=names)


@dataclass(frozen=True, slots=True, kw_only=True)
class Netlist:
    """A design with the names of its modules and ports, which are the same in all languages."""

    design: Design  # Simplified.
    entities: Mapping[str, str]  # Identifiers of all modules.
    port_names: Mapping[str, dict[str, str]]  # Identifiers of ports, by module and wire.

    @classmethod
    def of(cls, design: Any, *, name: str, ports: Any, platform: Any) -> Netlist:
        """Read a design; parameters and errors are those of :func:`convert`."""
        if not isinstance(design, Design):
            design = netlist_of(rtlil_of(design, name=name, ports=ports, platform=platform))
        _refuse(design)
        prefix = design.top.name
        entities = Scope([PACKAGE_NAME]).give_all(
            {module: name + module.removeprefix(prefix) for module in design.modules}
        )
        return cls(design=design, entities=entities, port_names=_port_names(design, entities))

    def bottom_up(self) -> list[Module]:
        """Order modules so that each module comes after those that it instantiates."""
        order: dict[str, Module] = {}
        stack = [(self.design.top, False)]
        while stack:
            module, visited = stack.pop()
            if visited:
                order.setdefault(module.name, module)
                continue
            stack.append((module, True))
            for item in reversed(module.items):
                if isinstance(item, Cell) and item.kind in self.design.modules:
                    stack.append((self.design.modules[item.kind], False))
        return list(order.values())


def _port_names(netlist: Design, entities: Mapping[str, str]) -> dict[str, dict[str, str]]:
    """Name the ports of all modules."""
    found = {}
    for name, module in netlist.modules.items():
        reserved = [entities[name], "rtl", *fixed_names(module, netlist.modules)]
        found[name] = _names_of_ports(module, Scope(reserved, _avoided(netlist, module)))
    return found


def _avoided(netlist: Design, module: Module) -> Collection[str]:
    """Return the words that only ports of the outermost entity may have, because users see them."""
    return () if module is netlist.top else AMS


def _names_of_ports(module: Module, scope: Scope) -> dict[str, str]:
    """Name the ports of a module, clocks and resets first."""
    ports = [wire.name for wire in module.wires.values() if wire.direction and wire.width]
    parts = part_names(module)
    given = scope.give_all({port: parts.get(port, port) for port in ports})
    clocks = ("clk", "rst", "_clk", "_rst")
    first = [p for p in ports if p in clocks[:2] or p.endswith(clocks[2:])]
    return {port: given[port] for port in dict.fromkeys([*first, *ports])}


def _refuse(netlist: Design) -> None:
    for module in netlist.modules.values():
        for item in module.items:
            if isinstance(item, Cell) and item.kind in _REFUSED:
                raise ValueError(
                    f"module {module.name!r} has {_REFUSED[item.kind]} ({item.kind}), whose value "
                    "only a formal tool chooses; no other tool has an equivalent"
                )
