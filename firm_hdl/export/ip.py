"""IP of Vivado and Quartus, and modules of LiteX: Verilog, and what a tool asks about its ports.

Vivado: ``component.xml``, and a script that packages the same. Facts are those of UG1118 (2024.1).
"Top-Level HDL Requirements": "The IP packager supports Verilog and VHDL as a top-level", so neither
VHDL-2008 nor SystemVerilog. "Inferring AXI Signals": "the port name consists of an interface name
followed by the AXI signal name".

Quartus: ``_hw.tcl``, a component of Platform Designer, and ``.qip``, the list of files. Facts are
those of the user guide 683609 (24.2), "Component Interface Tcl Reference", and of the Avalon
specification 683091, "Reset Sink Interface Properties".

LiteX: one Python file for a folder, with a ``LiteXModule`` for each design.

No version of Vivado or Quartus has read what is written here; LiteX has.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Literal

import firm_hdl
from firm_hdl.export.axis_leaves import AxisPort, axis_module
from firm_hdl.export.backend import Converters, Output, module_name
from firm_hdl.export.manifest import digest, to_json
from firm_hdl.export.options import IpTool
from firm_hdl.export.ports import PlainPort
from firm_hdl.export.registers import register_ports
from firm_hdl.export.templates import render
from firm_hdl.export.top import DIRECTIONS, Direction, ports_of
from firm_hdl.export.verilog.backend import converter_axis_ports
from firm_hdl.plan import Plan

if TYPE_CHECKING:
    from firm_hdl.registers import Register, RegisterMap
    from firm_hdl.registers.table import Kind

__all__ = ["Bus", "Ip", "buses_of", "ip_facts", "ip_files", "write"]

_FOLDER = "ip"
"""Subfolder with a folder for each IP: a repository of Vivado, a search path of Quartus."""

_VENDOR = "firm-hdl"

# As AMD's IP "Mini ISP" (2025) names them, and the RFSoCs; "zynquplus" has the Kria. An "a" in
# front is for cars, a "q" for defence, an "l" behind is of low power.
_FAMILIES = (
    *("artix7", "artix7l", "aartix7", "qartix7"),
    *("kintex7", "kintex7l", "akintex7", "qkintex7", "qkintex7l"),
    *("spartan7", "aspartan7", "virtex7", "qvirtex7", "zynq", "azynq", "qzynq"),
    *("kintexu", "virtexu", "artixuplus", "kintexuplus", "spartanuplus"),
    *("virtexuplus", "virtexuplusHBM", "virtexuplus58g", "zynquplus", "zynquplusRFSOC", "versal"),
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

# IEEE Std 1685-2009, 6.11.9: access, and what a write does if it does not store the value.
_ACCESS: dict[Kind, tuple[str, str]] = {
    "constant": ("read-only", ""),
    "status": ("read-only", ""),
    "setting": ("read-write", ""),
    # High for one cycle, and never read: "any write to this field may modify that data".
    "pulse": ("write-only", "modify"),
    "unused": ("write-only", ""),
    "event": ("read-write", "oneToClear"),
}

_DMA_RESETS = ("mm2s_aresetn", "s2mm_aresetn")
"""Of a node beside an AXI DMA, which makes them low for a reset by software."""

_AXIS = ("tdata", "tkeep", "tlast", "tuser", "tdest", "tid", "tvalid", "tready")
_AXI = (
    *("awaddr", "awprot", "awvalid", "awready", "wdata", "wstrb", "wvalid", "wready"),
    *("bresp", "bvalid", "bready"),
    *("araddr", "arprot", "arvalid", "arready", "rdata", "rresp", "rvalid", "rready"),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Ip:
    """What is packaged."""

    name: str  # Name of the IP, a word of Verilog.
    library: str  # Second part of the name: the distribution of the types, or `node`.
    module: str  # The outermost module.
    files: Mapping[str, str]  # Verilog by file name, the outermost module last.
    ports: Sequence[PlainPort]
    # For people, in one line.
    title: str
    description: str
    table: RegisterMap | None = None  # The registers behind `s_axi`, if there are any.
    # Values of inputs that are not connected, beside those that AXI has. All others are 0.
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
    def revision(self) -> int:
        """A number from 1 to 2**31 - 1 that differs for other files.

        By it, ``report_ip_status`` of Vivado sees that an instance is of an earlier build.
        """
        return 1 + int(digest(to_json({**self.files})), 16) % (2**31 - 1)


@dataclass(frozen=True, slots=True, kw_only=True)
class Bus:
    """A bus interface of an IP."""

    name: str
    # Name of its definition in Vivado: `axis` and `aximm` are AXI4-Stream and AXI4-Lite.
    kind: Literal["axis", "aximm", "clock", "reset", "interrupt"]
    mode: Literal["master", "slave"]
    ports: Mapping[str, str]  # Names of ports, by the names that the definition has for them.
    parameters: Mapping[str, str] = field(default_factory=dict)  # Those of Vivado.

    @property
    def definition(self) -> str:
        """Name of the definition, with vendor and library, without version."""
        library = "interface" if self.kind in ("axis", "aximm") else "signal"
        return f"xilinx.com:{library}:{self.kind}"


def buses_of(ports: Sequence[PlainPort]) -> list[Bus]:
    """Return the buses of a design, by the names of its ports: streams, registers, clock, reset.

    A stream has ``NAME_tdata``, ``NAME_tvalid`` and ``NAME_tready`` at least. The clock is
    ``aclk``, its resets ``aresetn`` and those of a DMA, the interrupt ``irq``, and registers are
    ``s_axi``.
    """
    by_name = {port.name: port for port in ports}
    buses = list(_streams(by_name))
    axi = {name.upper(): f"s_axi_{name}" for name in _AXI if f"s_axi_{name}" in by_name}
    if axi:
        buses.append(Bus(name="s_axi", kind="aximm", mode="slave", ports=axi))
    # UG994, "Common Internal Bus Interfaces": a list with colons of all that the clock drives.
    clocked = ":".join(bus.name for bus in buses)
    resets = [name for name in ("aresetn", *_DMA_RESETS) if name in by_name]
    clock = {"ASSOCIATED_BUSIF": clocked, "ASSOCIATED_RESET": ":".join(resets)}
    reset, interrupt = {"POLARITY": "ACTIVE_LOW"}, {"SENSITIVITY": "LEVEL_HIGH"}
    signals: list[tuple[Any, ...]] = [
        ("aclk", "clock", "slave", {"CLK": "aclk"}, clock),
        *((name, "reset", "slave", {"RST": name}, reset) for name in resets),
        ("irq", "interrupt", "master", {"INTERRUPT": "irq"}, interrupt),
    ]
    return buses + [
        Bus(name=name, kind=kind, mode=mode, ports=inside, parameters=parameters)
        for name, kind, mode, inside, parameters in signals
        if name in by_name
    ]


def _streams(by_name: Mapping[str, PlainPort]) -> Iterator[Bus]:
    for name, port in by_name.items():
        base = name.removesuffix("_tdata")
        own = {each.upper(): f"{base}_{each}" for each in _AXIS if f"{base}_{each}" in by_name}
        if base != name and {"TVALID", "TREADY"} <= own.keys():
            mode: Literal["master", "slave"] = "slave" if port.direction == "in" else "master"
            yield Bus(name=base, kind="axis", mode=mode, ports=own)


def ip_files(tool: IpTool, name: str, designs: Sequence[Ip]) -> dict[str, str]:
    """Return the files of a folder's IP, by paths in it.

    * `name`: name of the folder, with which names of designs begin.
    """
    designs = [_for_tool(tool, ip) for ip in designs]
    if tool == "litex":
        texts = {file: text for ip in designs for file, text in ip.files.items()}
        return {**texts, f"{name}_litex.py": _litex_module(name, designs)}
    make = _vivado_files if tool == "vivado" else _quartus_files
    return {
        f"{_FOLDER}/{ip.name}/{file}": text for ip in designs for file, text in make(ip).items()
    }


def _pins(ip: Ip, buses: Sequence[Bus]) -> list[PlainPort]:
    """Return the ports that are in no interface."""
    inside = {port for bus in buses for port in bus.ports.values()}
    return [port for port in ip.ports if port.name not in inside]


def _vivado_files(ip: Ip) -> dict[str, str]:
    buses = buses_of(ip.ports)
    xgui = f"{ip.name}_v{ip.version.replace('.', '_')}.tcl"
    values: dict[str, Any] = {
        "ip": ip,
        "buses": buses,
        "table": ip.table,
        "registers": [
            (each, _access(each), _reset(each)) for each in (ip.table.registers if ip.table else ())
        ],
        "field_access": _ACCESS,
        "defaults": {**_defaults(ip, buses), **ip.defaults},
    }
    component = render(
        "packaging/component.xml",
        **values,
        views=_VIEWS,
        families=_FAMILIES,
        xgui=xgui,
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
    return {
        "component.xml": component,
        "package.tcl": script,
        **ip.files,
        f"xgui/{xgui}": _XGUI,
    }


# Names of Platform Designer: kinds of interfaces, what others refer to first, and roles of ports
# unless they are those of AXI.
_QUARTUS_KINDS = {
    "clock": "clock",
    "reset": "reset",
    "aximm": "axi4lite",
    "axis": "axi4stream",
    "interrupt": "interrupt",
}
_QUARTUS_ROLES = {"CLK": "clk", "RST": "reset_n", "INTERRUPT": "irq"}


def _quartus_files(ip: Ip) -> dict[str, str]:
    buses = buses_of(ip.ports)
    by_name = {port.name: port for port in ip.ports}
    order = list(_QUARTUS_KINDS)
    script = render(
        "packaging/quartus_hw.tcl",
        ip=ip,
        interfaces=[
            (
                bus,
                _QUARTUS_KINDS[bus.kind],
                # An interrupt begins where it is received.
                "start" if bus.kind == "axis" and bus.mode == "master" else "end",
                [
                    (by_name[port], _QUARTUS_ROLES.get(role, role.lower()))
                    for role, port in bus.ports.items()
                ],
            )
            for bus in sorted(buses, key=lambda bus: order.index(bus.kind))
        ],
        pins=_pins(ip, buses),
    )
    listed = "".join(
        f"set_global_assignment -name {'SYSTEM' if file.endswith('.sv') else ''}VERILOG_FILE "
        f'[file join $::quartus(qip_path) "{file}"]\n'
        for file in ip.files
    )
    return {f"{ip.name}_hw.tcl": script, f"{ip.name}.qip": listed, **ip.files}


def _for_tool(tool: IpTool, ip: Ip) -> Ip:
    """For Quartus, add AWPROT and ARPROT to AXI4-Lite: they are required (IHI 0022, Table B1-1)."""
    if tool != "quartus" or ip.table is None:
        return ip
    module = f"{ip.module.removesuffix('_verilog')}_quartus_verilog"
    ports = [
        AxisPort(
            name=port.name,
            direction=port.direction,
            width=port.width,
            inner=port.name,
            inner_width=port.width,
        )
        for port in ip.ports
    ]
    ports += [
        AxisPort(name=f"s_axi_{name}", direction="in", width=3, inner="", inner_width=3)
        for name in ("awprot", "arprot")
    ]
    text = axis_module(module, ip.module, ports, "")
    return replace(ip, module=module, ports=ports, files={**ip.files, f"{module}.v": text})


def _litex_module(name: str, designs: Sequence[Ip]) -> str:
    def design(ip: Ip) -> dict[str, Any]:
        buses = buses_of(ip.ports)
        return {
            "ip": ip,
            "name": ip.name.removeprefix(name).title().replace("_", "") or "Node",
            "streams": [bus for bus in buses if bus.kind == "axis"],
            "has_status": ip.library != "node" and "m_axis_status" in {bus.name for bus in buses},
            "ports": {port.name: port for port in ip.ports},
            "pins": _pins(ip, buses),
            "defaults": {**_defaults(ip, buses), **ip.defaults},
        }

    return render("packaging/litex.py", name=name, designs=[design(ip) for ip in designs])


def _access(register: Register) -> str:
    found = {_ACCESS[field.kind][0] for field in register.fields}
    return found.pop() if len(found) == 1 else "read-write"


def _reset(register: Register) -> int | None:
    """Return the value after a reset, unless hardware shows some of it."""
    if any(field.kind == "status" for field in register.fields):
        return None
    return sum(field.reset << field.low for field in register.fields)


def _defaults(ip: Ip, buses: Sequence[Bus]) -> dict[str, int]:
    """Return the values of AXI's inputs that the other side does not have: all ones.

    TREADY and TKEEP are those of IHI 0051, "Default value signaling", so what leaves a stream that
    is not connected is taken; WSTRB is that of IHI 0022. TLAST has no default.
    """
    signals = ("TREADY", "TKEEP", "WSTRB")
    ones = {bus.ports[signal] for bus in buses for signal in signals if signal in bus.ports}
    return {
        port.name: (1 << port.width) - 1
        for port in ip.ports
        if port.direction == "in" and port.name in ones
    }


def write(converters: Converters, texts: Mapping[str, str]) -> Output:
    """Write the IP of a type: each converter, and each with registers if there are some.

    * `texts`: the Verilog, by the name of the file.
    """
    plan, message = converters.plan, converters.message.name
    library = str(converters.inputs["distro"])
    designs = []

    def chosen(*modules: str) -> dict[str, str]:
        return {f"{module}.v": texts[f"{module}.v"] for module in modules}

    for way in DIRECTIONS:
        modules = [module_name(converters.name, way)]
        ports: Sequence[PlainPort] = ports_of(plan, way)
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
                defaults=_tied(plan, ports, way),
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
    tool = converters.options.ip
    assert tool is not None
    return Output(
        files=ip_files(tool, converters.name, designs),
        manifest={"ip": ip_facts(tool, converters.name, designs)},
    )


_WHAT: dict[Direction, str] = {
    "deserializer": "Reads packets of ROS messages",
    "serializer": "Writes packets of ROS messages",
}


def _tied(plan: Plan, ports: Sequence[PlainPort], way: Direction) -> dict[str, int]:
    """Return what takes leaves that are not connected, or what makes their fields 0 or empty."""
    inner = {port.name: port for port in ports_of(plan, way) if port.leaf is not None}
    found = {}
    for port in ports:
        plain = inner.get(getattr(port, "inner", port.name))
        if plain is not None and plain.leaf is not None:
            kind = plan.leaves[plain.leaf].kind
            is_one = plain.member == "ready" or (
                kind != "items" and (plain.member == "valid" or kind == "trigger")
            )
            if is_one and port.direction == "in":
                found[port.name] = 1
    return found


def ip_facts(tool: IpTool, name: str, designs: Sequence[Ip]) -> dict[str, Any]:
    """Return the manifest's entry `ip`."""
    designs = [_for_tool(tool, ip) for ip in designs]
    component = {
        "vivado": f"{_FOLDER}/{{0}}/component.xml",
        "quartus": f"{_FOLDER}/{{0}}/{{0}}_hw.tcl",
        "litex": f"{name}_litex.py",
    }[tool]
    return {
        "tool": tool,
        "repository": "." if tool == "litex" else _FOLDER,
        "components": [
            {
                "name": f"{ip.vendor}:{ip.library}:{ip.name}:{ip.version}",
                "component": component.format(ip.name),
                "module": ip.module,
                "buses": [bus.name for bus in buses_of(ip.ports)],
            }
            for ip in designs
        ],
    }
