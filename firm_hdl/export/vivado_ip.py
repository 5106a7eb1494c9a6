"""IP of Vivado: a Verilog module with a ``component.xml``, and a script that packages the same.

Facts are those of UG1118 (2024.1). "Top-Level HDL Requirements": "The IP packager supports Verilog
and VHDL as a top-level", so neither VHDL-2008 nor SystemVerilog. "Inferring AXI Signals": "the port
name consists of an interface name followed by the AXI signal name". No version of Vivado has read
what is written here.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

import firm_hdl
from firm_hdl.export.backend import Converters, Output, module_name
from firm_hdl.export.registers import register_ports
from firm_hdl.export.templates import render
from firm_hdl.export.top import DIRECTIONS, Direction, ports_of
from firm_hdl.export.verilog.backend import converter_axis_ports
from firm_hdl.plan import Plan

if TYPE_CHECKING:
    from firm_hdl.registers import RegisterMap

__all__ = ["FOLDER", "Bus", "Ip", "buses_of", "ip_facts", "ip_files", "write"]

FOLDER = "ip"
"""Subfolder that is an IP repository."""

_VENDOR = "firm-hdl"

_FAMILIES = (
    *("artix7", "kintex7", "spartan7", "virtex7", "zynq", "kintexu", "virtexu"),
    *("kintexuplus", "virtexuplus", "zynquplus"),
)

_VIEWS = (
    ("xilinx_anylanguagesynthesis", "Synthesis", "synthesis"),
    ("xilinx_anylanguagebehavioralsimulation", "Simulation", "simulation"),
    ("xilinx_xpgui", "UI Layout", "xgui.ui"),
)

_XGUI = """\
# The dialogue of the IP: it has no parameters.
proc init_gui { IPINST } {
  ipgui::add_param $IPINST -name "Component_Name"
}
"""

_AXIS = ("tdata", "tkeep", "tlast", "tuser", "tdest", "tid", "tvalid", "tready")
_AXI = (
    *("awaddr", "awvalid", "awready", "wdata", "wstrb", "wvalid", "wready"),
    *("bresp", "bvalid", "bready"),
    *("araddr", "arvalid", "arready", "rdata", "rresp", "rvalid", "rready"),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Ip:
    """What is packaged.

    Attributes
    ----------
    name : str
        Name of the IP, a word of Verilog.
    library : str
        Second part of the name: the distribution of the types, or ``node``.
    module : str
        The outermost module.
    files : mapping of str to str
        Verilog by file name, the outermost module last.
    ports : sequence
        Each with `name`, `direction` ("in" or "out") and `width`.
    title, description : str
        For people, in one line.
    table : RegisterMap or None
        The registers behind ``s_axi``, if there are any.
    defaults : mapping of str to int
        Values of inputs that are not connected; all others are 0, and TREADY is 1.
    """

    name: str
    library: str
    module: str
    files: Mapping[str, str]
    ports: Sequence[Any]
    title: str
    description: str
    table: RegisterMap | None = None
    defaults: Mapping[str, int] = field(default_factory=dict)

    @property
    def vendor(self) -> str:
        """The first part of the name of every IP."""
        return _VENDOR

    @property
    def version(self) -> str:
        """Version of firm-hdl; an IP has two parts."""
        return ".".join(firm_hdl.__version__.split(".")[:2])

    @property
    def revision(self) -> str:
        """The part of the version that is left, as a number."""
        last = firm_hdl.__version__.split(".")[2:3]
        return last[0] if last and last[0].isdigit() else "0"


@dataclass(frozen=True, slots=True, kw_only=True)
class Bus:
    """A bus interface of an IP.

    Attributes
    ----------
    name : str
    type, abstraction : str
        Names of definitions of Vivado, with vendor, library and version.
    mode : "master" or "slave"
    ports : mapping of str to str
        Names of ports, by the names that the definition has for them.
    parameters : mapping of str to str
    memory_map : str
        Of a slave with registers.
    """

    name: str
    type: str
    abstraction: str
    mode: Literal["master", "slave"]
    ports: Mapping[str, str]
    parameters: Mapping[str, str] = field(default_factory=dict)
    memory_map: str = ""


def _bus(name: str, kind: str, mode: Any, ports: Mapping[str, str], **more: Any) -> Bus:
    library, word = kind.split(":")
    return Bus(
        name=name,
        type=f"xilinx.com:{library}:{word}:1.0",
        abstraction=f"xilinx.com:{library}:{word}_rtl:1.0",
        mode=mode,
        ports=ports,
        **more,
    )


def buses_of(ports: Sequence[Any]) -> list[Bus]:
    """Return the buses of a design, by the names of its ports: streams, registers, clock, reset.

    A stream has ``NAME_tdata``, ``NAME_tvalid`` and ``NAME_tready`` at least. The clock is
    ``aclk``, its reset ``aresetn``, the interrupt ``irq``, and registers are ``s_axi``.
    """
    by_name = {port.name: port for port in ports}
    streams = list(_streams(by_name))
    axi = {name.upper(): f"s_axi_{name}" for name in _AXI if f"s_axi_{name}" in by_name}
    if axi:
        streams.append(_bus("s_axi", "interface:aximm", "slave", axi, memory_map="s_axi"))
    clocked = ":".join(bus.name for bus in streams)
    # UG994, "Common Internal Bus Interfaces": a list with colons of all that the clock drives.
    clock = {"ASSOCIATED_BUSIF": clocked, "ASSOCIATED_RESET": "aresetn"}
    return [
        *streams,
        _bus("aclk", "signal:clock", "slave", {"CLK": "aclk"}, parameters=clock),
        _bus(
            "aresetn",
            "signal:reset",
            "slave",
            {"RST": "aresetn"},
            parameters={"POLARITY": "ACTIVE_LOW"},
        ),
        *(
            [
                _bus(
                    "irq",
                    "signal:interrupt",
                    "master",
                    {"INTERRUPT": "irq"},
                    parameters={"SENSITIVITY": "LEVEL_HIGH"},
                )
            ]
            if "irq" in by_name
            else []
        ),
    ]


def _streams(by_name: Mapping[str, Any]) -> Iterator[Bus]:
    for name, port in by_name.items():
        base = name.removesuffix("_tdata")
        own = {each.upper(): f"{base}_{each}" for each in _AXIS if f"{base}_{each}" in by_name}
        if base != name and {"TVALID", "TREADY"} <= own.keys():
            mode = "slave" if port.direction == "in" else "master"
            yield _bus(base, "interface:axis", mode, own)


def ip_files(ip: Ip) -> dict[str, str]:
    """Return the files of an IP, by paths in the folder of the design.

    The folder ``ip`` is the repository, and has a folder for each IP.
    """
    buses = buses_of(ip.ports)
    xgui = f"{ip.name}_v{ip.version.replace('.', '_')}.tcl"
    # All that leaves a stream that is not connected is taken.
    ready = {
        bus.ports["TREADY"]: 1 for bus in buses if bus.mode == "master" and "TREADY" in bus.ports
    }
    values: dict[str, Any] = {"ip": ip, "buses": buses, "table": ip.table}
    component = render(
        "packaging/component.xml",
        **values,
        views=_VIEWS,
        families=_FAMILIES,
        xgui=xgui,
        defaults={**ready, **ip.defaults},
    )
    script = render(
        "packaging/vivado_ip.tcl",
        **values,
        properties={
            "name": ip.name,
            "version": ip.version,
            "display_name": ip.title,
            "description": ip.description,
            "core_revision": ip.revision,
            "supported_families": " ".join(f"{family} Production" for family in _FAMILIES),
        },
    )
    here = f"{FOLDER}/{ip.name}"
    return {
        f"{here}/component.xml": component,
        f"{here}/package.tcl": script,
        **{f"{here}/{file}": text for file, text in ip.files.items()},
        f"{here}/xgui/{xgui}": _XGUI,
    }


def write(converters: Converters, texts: Mapping[str, str]) -> Output:
    """Write the IP of a type: each converter, and each with registers if there are some.

    Parameters
    ----------
    texts : mapping of str to str
        The Verilog, by the name of the file.
    """
    plan, message = converters.plan, converters.message.name
    library = str(converters.inputs["distro"])
    designs = []

    def chosen(*modules: str) -> dict[str, str]:
        return {f"{module}.v": texts[f"{module}.v"] for module in modules}

    for way in DIRECTIONS:
        modules = [module_name(converters.name, way)]
        ports: Sequence[Any] = ports_of(plan, way)
        if converters.options.leaf_ports == "axis":
            modules.append(module_name(converters.name, way, "axis"))
            ports = converter_axis_ports(plan, way)
        designs.append(
            Ip(
                name=f"{converters.name}_{way}",
                library=library,
                module=modules[-1],
                files=chosen(*modules),
                ports=ports,
                title=f"{way.capitalize()} of {message}",
                description=f"{_WHAT[way]} of {message}, on a bus of {plan.bus_bytes} bytes.",
                defaults=_tied(plan, ports) if way == "serializer" else {},
            )
        )
    for way, layout in converters.registers.items():
        module = module_name(converters.name, way, "registers")
        designs.append(
            Ip(
                name=f"{converters.name}_{way}_registers",
                library=library,
                module=module,
                files=chosen(module),
                ports=register_ports(layout, plan).ports,
                title=f"{way.capitalize()} of {message}, registers",
                description=f"{_WHAT[way]} of {message}, with registers on AXI4-Lite.",
                table=layout.table,
            )
        )
    files = {name: text for ip in designs for name, text in ip_files(ip).items()}
    return Output(files=files, manifest={"ip": ip_facts(designs)})


_WHAT: dict[Direction, str] = {
    "deserializer": "Reads packets of ROS messages",
    "serializer": "Writes packets of ROS messages",
}


def _tied(plan: Plan, ports: Sequence[Any]) -> dict[str, int]:
    """Return what makes fields 0 or empty whose leaves are not connected."""
    inner = {port.name: port for port in ports_of(plan, "serializer") if port.leaf is not None}
    found = {}
    for port in ports:
        plain = inner.get(getattr(port, "inner", port.name))
        if plain is not None and plain.leaf is not None:
            kind = plan.leaves[plain.leaf].kind
            is_one = plain.member == "valid" or (plain.member == "data" and kind == "trigger")
            if is_one and kind != "items":
                found[port.name] = 1
    return found


def ip_facts(designs: Iterable[Ip]) -> dict[str, Any]:
    """Return the manifest's entry `ip`."""
    return {
        "tool": "vivado",
        "repository": FOLDER,
        "components": [
            {
                "name": f"{ip.vendor}:{ip.library}:{ip.name}:{ip.version}",
                "component": f"{FOLDER}/{ip.name}/component.xml",
                "module": ip.module,
                "buses": [bus.name for bus in buses_of(ip.ports)],
            }
            for ip in designs
        ],
    }
