"""The module of a node with structs, around the module of Verilog with plain ports."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from firm_hdl.export.remarks import remark
from firm_hdl.export.systemverilog.backend import WAIVERS_TEXT
from firm_hdl.export.systemverilog.package import shared_packages
from firm_hdl.export.systemverilog.structs import package_name
from firm_hdl.export.systemverilog.types import WORDS
from firm_hdl.export.systemverilog.wrapper import leaf_actual
from firm_hdl.node.records.messages import MessagePort, other_ports
from firm_hdl.node.top import NodePort

__all__ = ["struct_files"]


def struct_files(
    name: str,
    module: str,
    ports: Sequence[NodePort],
    messages: Sequence[MessagePort],
    *,
    header: str,
) -> dict[str, str]:
    """Write the packages of all messages, the module ``NAME_sv``, and the list of files.

    Parameters
    ----------
    module : str
        The module of Verilog, ``MODULE.v`` in the folder above.
    header : str
        Lines of a comment at the head of the module's file.

    Returns
    -------
    dict of str to str
        Texts by file name, in compile order; then ``files.f`` and waivers of Verilator.
    """
    files: dict[str, str] = {}
    for each in messages:
        files |= shared_packages(each.plan, each.tree(WORDS))
    top = f"{name}_sv"
    listed = [*files, f"../{module}.v", f"{top}.sv"]
    files[f"{top}.sv"] = "".join(
        [
            *remark(header, ""),
            *remark(f"The node with structs of messages. {module} has plain ports.", ""),
            f"\nmodule {top} (\n",
            *_ports(ports, messages),
            ");\n",
            *_core(module, ports, messages),
            f"\nendmodule : {top}\n",
        ]
    )
    files["files.f"] = "".join(f"{file}\n" for file in listed)
    files["waivers.vlt"] = WAIVERS_TEXT
    return files


def _ports(ports: Sequence[NodePort], messages: Sequence[MessagePort]) -> Iterator[str]:
    ways = {"in": "input", "out": "output"}
    lines: list[tuple[str, str, str, str]] = []
    for port in other_ports(ports, messages):
        kind = "logic" if port.width == 1 else f"logic [{port.width - 1}:0]"
        lines.append((ways[port.direction], kind, port.name, f"{port.member}."))
    for each in messages:
        root, own = each.tree(WORDS).root, package_name(each.tree(WORDS).package.name)
        forward, backward = (
            ("output", "input") if each.direction == "deserializer" else ("input", "output")
        )
        about = f"Data and valid of {each.message.name}."
        lines += [
            (forward, f"{own}::{root.type}", each.name, about),
            (backward, f"{own}::{root.ready_type}", each.ready, "Ready of the fields."),
        ]
    for number, (way, kind, name, meaning) in enumerate(lines):
        end = "," if number < len(lines) - 1 else ""
        yield from remark(meaning)
        yield f"  {way:6} {kind} {name}{end}\n"


def _core(module: str, ports: Sequence[NodePort], messages: Sequence[MessagePort]) -> Iterator[str]:
    actuals = {port.name: port.name for port in ports}
    for each in messages:
        nodes = {node.leaf: node for node in each.tree(WORDS).root.leaves()}
        for name, port in each.ports.items():
            actuals[name] = leaf_actual(port, nodes[port.leaf], each.name, each.ready)
    width = max(map(len, actuals))
    joined = ",\n".join(f"    .{name:{width}} ({actual})" for name, actual in actuals.items())
    yield f"\n  {module} node (\n{joined}\n  );\n"
