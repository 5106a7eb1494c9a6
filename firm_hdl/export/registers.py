# amaranth: UnusedElaboratable=no
"""The back end for registers: converters on AXI4-Lite, their table in SystemRDL, and C headers."""

from __future__ import annotations

from dataclasses import asdict

from firm_hdl.export.backend import BuildError, Converters, Output, module_name
from firm_hdl.export.component import ComponentTop, Path, PlainPorts
from firm_hdl.export.top import DIRECTIONS, Direction
from firm_hdl.garbage import search_put_off
from firm_hdl.model import Message
from firm_hdl.names.identifiers import identifier
from firm_hdl.plan import Plan
from firm_hdl.registers import (
    MessageMap,
    RegisterReceiver,
    RegisterSender,
    c_header,
    message_map,
    system_rdl,
)
from firm_hdl.rtlil import netlist_of, rtlil_of
from firm_hdl.rtlil.ir import Design
from firm_hdl.verilog import convert

__all__ = ["register_circuits", "register_maps", "register_ports", "write"]


def register_maps(message: Message, plan: Plan) -> dict[Direction, MessageMap]:
    """Lay out the registers of a type.

    Raises `BuildError` if it has no fields of fixed size, or too many.
    """
    try:
        return {way: message_map(message, plan, way) for way in DIRECTIONS}
    except ValueError as error:
        raise BuildError(f"{message.name} cannot have registers: {error}") from None


def register_ports(layout: MessageMap, plan: Plan) -> PlainPorts:
    """Return the ports of a converter with registers: AXI4-Lite is ``s_axi``."""
    way = layout.direction
    component = RegisterReceiver if way == "deserializer" else RegisterSender
    names = {
        "axi": "s_axi",
        "interrupt": "irq",
        "packets": "s_axis" if way == "deserializer" else "m_axis",
    }

    def spell(path: Path) -> Path:
        return (names.get(path[0], path[0]), *path[1:])

    return PlainPorts(
        component(layout, plan),
        kind="registers",
        clocks={"sync": ("aclk", "aresetn")},
        spell=spell,
    )


@search_put_off()
def register_circuits(converters: Converters) -> dict[Direction, Design]:
    """Make the circuits of a type's registers; none, if they were not asked for."""
    tops = {
        way: ComponentTop(register_ports(layout, converters.plan))
        for way, layout in converters.registers.items()
    }
    return {way: netlist_of(rtlil_of(top, name=f"{way}_registers")) for way, top in tops.items()}


def write(converters: Converters) -> Output:
    """Write Verilog, SystemRDL and headers, and the manifest's entry `registers`."""
    files, section = {}, {}
    for way, layout in converters.registers.items():
        name = f"{converters.name}_{way}_registers"
        module = module_name(converters.name, way, "registers")
        header = converters.header(name, f"registers of the {way}")
        files[f"{module}.v"] = convert(
            converters.register_circuits[way], name=module, header=header
        )
        files[f"{name}.rdl"] = system_rdl(layout.table, header)
        files[f"{name}.h"] = c_header(layout, header)
        section[way] = {
            "module": module,
            "verilog": f"{module}.v",
            "entity": f"{identifier(converters.name).lower()}_{way}_registers",
            "system_rdl": f"{name}.rdl",
            "c_header": f"{name}.h",
            "clock": "aclk",
            "reset": "aresetn",
            "ports": [asdict(port) for port in register_ports(layout, converters.plan).ports],
            "registers": [asdict(each) for each in layout.table.registers],
        }
    return Output(files=files, manifest={"registers": section} if section else {})
