# amaranth: UnusedElaboratable=no
"""The files of a node: the design in each language, the manifest, and the summary."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import firm_hdl
from firm_hdl import rtlil
from firm_hdl.errors import DefinitionError, Diagnostic, UserError
from firm_hdl.export.axis_leaves import axis_module, axis_ports
from firm_hdl.export.component import ComponentPort
from firm_hdl.export.design import (
    BuiltDesign,
    core_file,
    design_folder,
    inputs_of_design,
    shared_unit,
    verilog_file,
    verilog_module,
    vhdl_folder,
    write_design,
)
from firm_hdl.export.folder import read_manifest
from firm_hdl.export.ip import Ip, ip_files
from firm_hdl.export.manifest import digest
from firm_hdl.export.message_ports import (
    RecordPort,
    message_ports,
    record_facts,
    record_files,
    struct_files,
)
from firm_hdl.export.options import IpTool
from firm_hdl.export.ports import PlainPort
from firm_hdl.export.verilog.backend import waivers
from firm_hdl.garbage import search_put_off
from firm_hdl.names.identifiers import identifier
from firm_hdl.node.accelerator import conflicts_reported
from firm_hdl.node.benches import FRAMES, LinkScript, Stimuli, bench_core, bench_files, link_script
from firm_hdl.node.boards.zynq_header import zynq_header
from firm_hdl.node.description import Description
from firm_hdl.node.hdl.copies import AcceleratorFiles, accelerator_files
from firm_hdl.node.node import Node
from firm_hdl.node.records import found_messages
from firm_hdl.node.register_map import register_files, register_map
from firm_hdl.node.summary import facts_of, summary
from firm_hdl.node.top import NodeTop, node_ports
from firm_hdl.vhdl.convert import convert

__all__ = ["build_node", "check_units", "design_name", "placed_on"]

SUMMARY = "summary.txt"
DATASHEET = "datasheet.html"

_OF_VHDL = ("_tb.vhd", "firm_hdl_bench_pkg.vhd", "bench_files.txt", "run_ghdl.sh")
_OF_VERILOG = ("_tb.v", "run_iverilog.sh", "run_verilator.sh")
"""How files of benches end, by the language of the simulator."""

_UNDRIVEN = """
// Outputs of parts that the node does not use are wires without a driver.
lint_off -rule UNDRIVEN -file "*{file}"
"""

_OTHER_CLOCK = """
// The reset of the node is a synchronous one there, and ends late in the clock domain of the PHY.
lint_off -rule SYNCASYNCNET -file "*{file}"
"""


def design_name(description: Description) -> str:
    """Return the name of a node's design, which is that of its folder and of its IP."""
    name = identifier(description.node)
    if description.hdl is not None and description.hdl.entity.lower() == name.lower():
        # Both would be one entity.
        name += "_node"
    return name


def build_node(
    description: Description,
    out: str | os.PathLike[str] = "node_out",
    *,
    force: bool = False,
    stimuli: Stimuli | None = None,
    datasheet: bool = False,
    ip: IpTool | None = None,
) -> BuiltDesign:
    """Write the design of a node into a folder of its own, ``out/NAME``.

    * `out`: created if it does not exist.
    * `force`: write the folder even if it is current.
    * `stimuli`: returns good packets of a type for the test benches. `None`: these send control
      messages only.
    * `datasheet`: write the datasheet, too. It has the figures of bitstreams that are in the
      folder.
    * `ip`: write an IP for this tool, too; of a node whose link is AXI4-Stream.

    Raises `DefinitionError` or `UserError` if the accelerator cannot be used, the node is too
    large, two design units would have one name, or the folder cannot be written.
    """
    kind = description.link.kind
    # AXI DMA is AMD's.
    kinds = ("stream", "axi_dma") if ip == "vivado" else ("stream",)
    if ip and kind not in kinds:
        needed = " or ".join(f"'{each}'" for each in kinds)
        message = f"IP needs the link {needed}, not '{kind}'"
        raise DefinitionError([Diagnostic(message=message, span=description.link_span)])
    name = design_name(description)
    folder = design_folder(out, name)
    node = Node(description)
    ports = node_ports(node)
    has_accelerator = node.accelerator is not None
    messages: Sequence[RecordPort] = ()
    reason = "The accelerator takes all messages" if has_accelerator else ""
    if not has_accelerator:
        try:
            messages = message_ports(list(found_messages(description)), ports)
        except UserError as error:
            # The plain ports are there all the same.
            reason = str(error)
    with conflicts_reported(description), search_put_off():
        circuit = rtlil.rtlil_of(NodeTop(node), name=name)
    script = link_script(description, stimuli, has_accelerator=has_accelerator)
    own = accelerator_files(node.accelerator)
    if ip and (own.language == "vhdl" or own.headers):
        message = "IP takes an accelerator in Amaranth, or in Verilog without include files"
        raise DefinitionError([Diagnostic(message=message, span=description.accelerator_span)])
    facts = facts_of(description)
    accelerator = {f: digest(t) for f, t in {**own.texts, **own.headers}.items()}
    placed = placed_on(folder, digest(circuit), accelerator) if datasheet else None
    return write_design(
        folder,
        inputs=inputs_of_design(
            {
                "node": description.node,
                "facts": facts,
                # The accelerator's code is part of the circuit; packets of the benches are not.
                "frames_sha256": None if script is None else digest(script.text),
                "accelerator_files": accelerator,
                **({} if placed is None else {"datasheet": placed}),
                **({"ip": ip} if ip else {}),
            },
            circuit,
        ),
        facts={
            **facts,
            "records": record_facts(name, messages, reason),
            **_register_facts(description, name),
            "accelerator_files": own.facts(),
            "bench": None if script is None else _bench(name, own),
            "clock": "aclk",
            "reset": "aresetn",
        },
        ports=[asdict(port) for port in ports],
        make_files=lambda: _files(
            description, name, circuit, ports, messages, script, own, placed=placed, ip=ip
        ),
        force=force,
    )


def _files(
    description: Description,
    name: str,
    circuit: str,
    ports: Sequence[ComponentPort],
    messages: Sequence[RecordPort],
    script: LinkScript | None,
    own: AcceleratorFiles,
    *,
    placed: Mapping[str, Any] | None,
    ip: IpTool | None,
) -> dict[str, str]:
    """Write the design and its benches in each language."""
    header = (
        f"{name}: a node of ROS {description.distro}, made by firm-hdl {firm_hdl.__version__}\n"
    )
    module = verilog_module(name)
    lint = _UNDRIVEN + (_OTHER_CLOCK if description.link.ethernet == "mii" else "")
    netlist = rtlil.netlist_of(circuit)
    node = convert(netlist, name=name, header=header)
    vhdl_ports = node.entities[name].ports
    records = record_files(name, ports, messages, kind="node", vhdl_ports=vhdl_ports, header=header)
    structs = struct_files(name, module, ports, messages, kind="node", header=header)
    is_vhdl = own.language == "vhdl"
    inside = {file.removeprefix("vhdl/"): text for file, text in own.texts.items()}
    vhdl = {**(inside if is_vhdl else {}), **node.files, **records}
    benches: dict[str, str] = {}
    if script is not None:
        benches = bench_files(
            description,
            name,
            ports,
            script,
            module=module,
            vhdl_ports=vhdl_ports,
            vhdl_files=list(vhdl),
            header=header,
            more=list(own.texts),
            verilog_tool=own.verilog_tool,
        )
        # A simulator reads one language.
        other = () if not own.language else _OF_VERILOG if is_vhdl else _OF_VHDL
        benches = {file: text for file, text in benches.items() if not file.endswith(other)}
    owners = {"the node": node.files, "its messages": records, "its structs": structs}
    if own.language:
        # With records, also its packages and the wrapper; files of the user's have other names.
        around = {file for file in own.texts if file.count("/") == 1 and own.wrapper}
        owners[_ACCELERATOR] = {f"{own.entity}.vhd": "", **dict.fromkeys(around, "")}
    check_units(description, name, top=node.top, files={**owners, "its benches": benches})
    documents: dict[str, str] = {}
    if placed is not None:
        # Not before it is asked for: it imports much.
        from firm_hdl.node.datasheet import node_datasheet

        page = node_datasheet(
            description, name, ports, module=module, vhdl_ports=vhdl_ports, placed=placed
        )
        documents[DATASHEET] = page
    verilog = verilog_file(netlist, name=name, header=header)
    return {
        **verilog,
        **(register_files(description, name, header) if description.registers else {}),
        "waivers.vlt": waivers([module]) + lint.format(file=f"{module}.v"),
        **{f"systemverilog/{file}": text for file, text in structs.items()},
        **({} if is_vhdl else own.texts),
        **own.headers,
        **vhdl_folder(vhdl),
        SUMMARY: summary(description) + "\n",
        **_host_files(description, name),
        **core_file(
            name,
            {**node.files, **records},
            kind="node",
            description=f"Node {description.node} of ROS {description.distro}",
            more=None if script is None else bench_core(name),
            change=own.core,
        ),
        **benches,
        **documents,
        **(
            ip_files(ip, name, [_ip(description, name, ports, messages, {**own.texts, **verilog})])
            if ip
            else {}
        ),
    }


def _host_files(description: Description, name: str) -> dict[str, str]:
    """Write what a program on the processor beside the node includes."""
    if description.link.kind != "axi_dma":
        return {}
    return {f"{name}_zynq.hpp": zynq_header(description, name)}


def placed_on(folder: Path, design: str, accelerator: Mapping[str, str]) -> dict[str, Any]:
    """Return figures of the bitstreams of a circuit, by the name of the board.

    * `folder`: the folder of the node.
    * `design`: SHA-256 of the circuit.
    * `accelerator`: SHA-256 of the files of its accelerator.
    """
    found = {place.name: read_manifest(place) or {} for place in folder.glob("boards/*")}
    of = {"design_sha256": design, "accelerator_files": accelerator}
    return {
        board: {key: each["bitstream"][key] for key in ("cells", "clocks", "tools")}
        for board, each in sorted(found.items())
        if each.get("bitstream") and of.items() <= each["inputs"].items()
    }


def _register_facts(description: Description, name: str) -> dict[str, Any]:
    """Describe the registers on a bus of the chip for the manifest, if there are some."""
    if not description.registers:
        return {}
    return {
        "bus_registers": {
            "bus": description.registers,
            "system_rdl": f"{name}_registers.rdl",
            "c_header": f"{name}_registers.h",
            "registers": [asdict(each) for each in register_map(description).registers],
        }
    }


def _ip(
    description: Description,
    name: str,
    ports: Sequence[ComponentPort],
    messages: Sequence[RecordPort],
    files: Mapping[str, str],
) -> Ip:
    """Return the node as IP. Messages that come out of it are AXI4-Stream."""
    module = verilog_module(name)
    members = {name: port.member for each in messages for name, port in each.ports.items()}
    shown: Sequence[PlainPort] = ports
    if members:
        inner, module = module, f"{name}_axis_verilog"
        shown = axis_ports(ports, members)
        files = {**files, f"{module}.v": axis_module(module, inner, shown, "")}
    return Ip(
        name=name,
        library="node",
        module=module,
        files=files,
        ports=shown,
        title=f"Node {name}",
        description=f"Node {description.node} of ROS {description.distro}: frames on AXI4-Stream.",
        table=register_map(description) if description.registers == "axi4lite" else None,
    )


def _bench(name: str, own: AcceleratorFiles) -> dict[str, str]:
    """Describe the benches for the manifest: those that read the language of the accelerator."""
    vhdl = {
        "vhdl": f"{name}_tb",
        "vhdl_files": "vhdl/bench_files.txt",
        "run_ghdl": "vhdl/run_ghdl.sh",
    }
    verilog = {
        "verilog": f"{name}_tb",
        "verilog_file": f"{name}_tb.v",
        f"run_{own.verilog_tool}": f"run_{own.verilog_tool}.sh",
    }
    return {
        "frames": FRAMES,
        **(vhdl if own.language in ("", "vhdl") else {}),
        **(verilog if own.language != "vhdl" else {}),
    }


_ACCELERATOR = "its accelerator"


def check_units(
    description: Description, name: str, *, top: str, files: Mapping[str, Iterable[str]]
) -> None:
    """Refuse a name of a node if two design units would have one name; see `shared_unit`.

    * `name`: name that the outermost entity is to have.
    * `top`: name that this entity has in VHDL.

    Raises `DefinitionError`: at the name of the node in the description, or at the accelerator.
    """
    if top != name:
        raise _refused(description, f"the VHDL of every node uses the name '{name}' itself")
    if what := shared_unit(files):
        if _ACCELERATOR in what:
            message = f"{what}; give the entity of the accelerator another name"
            span = description.accelerator_span
            raise DefinitionError([Diagnostic(message=message, span=span)])
        raise _refused(description, what)


def _refused(description: Description, reason: str) -> DefinitionError:
    message = f"{reason}; give the node another name"
    return DefinitionError([Diagnostic(message=message, span=description.node_span)])
