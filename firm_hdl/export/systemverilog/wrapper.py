"""Modules in SystemVerilog whose ports are structs, around the Verilog modules with plain ports."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from firm_hdl.export.remarks import remark
from firm_hdl.export.systemverilog.structs import package_name
from firm_hdl.export.systemverilog.types import BEAT, STATUS, STATUS_STREAM, TYPES_NAME, bus_name
from firm_hdl.export.top import Direction, Port, ports_of
from firm_hdl.export.tree import Node, Tree
from firm_hdl.plan import Plan

__all__ = ["instance", "leaf_actual", "wrapper"]

_STATUS = "m_axis_status"


def wrapper(plan: Plan, tree: Tree, direction: Direction, *, name: str, core: str) -> str:
    """Write a module.

    * `name`: name of the module.
    * `core`: name of the Verilog module inside.
    """
    head = remark(f"The {direction} of {plan.message} with structs. {core} has plain ports.", "")
    return "".join(
        [
            *head,
            f"\nmodule {name} (\n",
            *_ports(plan, tree, direction),
            ");\n",
            *_body(plan, tree, direction, core),
            f"\nendmodule : {name}\n",
        ]
    )


def instance(plan: Plan, tree: Tree, direction: Direction, *, name: str) -> str:
    """Write an instance of a module, and the variables that it needs.

    * `name`: name of the module.
    """
    lines = _lines(plan, tree, direction)
    own, base = package_name(tree.package.name), tree.package.base.upper()
    tied = (
        f"rdy = {own}::{base}_ALL_READY"
        if direction == "deserializer"
        else (f"msg = {own}::{base}_IDLE")
    )
    variables = (
        f"{kind} {port};\n"
        for _, kind, port, _ in lines
        if port not in ("aclk", "aresetn", f"{_STATUS}_tready")
    )
    # A packet waits until its status is taken.
    parts = (
        f"  .{port}(1'b1)" if port == f"{_STATUS}_tready" else f"  .{port}({port})"
        for _, _, port, _ in lines
    )
    joined = ",\n".join(parts)
    return f"{''.join(variables)}\nalways_comb {tied};\n\n{name} {direction} (\n{joined}\n);\n"


def _ports(plan: Plan, tree: Tree, direction: Direction) -> Iterator[str]:
    lines = _lines(plan, tree, direction)
    for number, (way, kind, name, meaning) in enumerate(lines):
        end = "," if number < len(lines) - 1 else ""
        yield from remark(meaning)
        yield f"  {way:6} {kind} {name}{end}\n"


def _lines(plan: Plan, tree: Tree, direction: Direction) -> list[tuple[str, str, str, str]]:
    """List the ports: direction, type, name and meaning."""
    own, bus = package_name(tree.package.name), bus_name(plan.bus_bytes)
    reads = direction == "deserializer"
    forward, backward = ("output", "input") if reads else ("input", "output")
    beats = "s_axis" if reads else "m_axis"
    return [
        ("input", "logic", "aclk", "Clock; the rising edge is active."),
        ("input", "logic", "aresetn", "Synchronous reset, active low."),
        (backward, f"{bus}::{BEAT}", beats, "Packets."),
        (forward, "logic", f"{beats}_tready", "beat: ready."),
        (forward, f"{own}::{tree.root.type}", "msg", f"Data and valid of {plan.message}."),
        (backward, f"{own}::{tree.root.ready_type}", "rdy", "Ready of the fields."),
        ("output", f"{TYPES_NAME}::{STATUS_STREAM}", _STATUS, "Status of each packet."),
        ("input", "logic", f"{_STATUS}_tready", "status: ready."),
    ]


def _body(plan: Plan, tree: Tree, direction: Direction, core: str) -> Iterator[str]:
    # The status is an enumeration, so it is assigned by a cast from plain bits.
    yield "\n  logic [7:0] status;\n\n"
    yield f"  assign {_STATUS}.tdata = {TYPES_NAME}::{STATUS}'(status);\n"
    if direction == "deserializer":
        yield "\n  wire unused = &{1'b0, s_axis.tuser};\n"
    nodes = {node.leaf: node for node in tree.root.leaves()}
    actuals = {port.name: _actual(port, nodes) for port in ports_of(plan, direction)}
    width = max(map(len, actuals))
    joined = ",\n".join(f"    .{name:{width}} ({actual})" for name, actual in actuals.items())
    yield f"\n  {core} core (\n{joined}\n  );\n"


def _actual(port: Port, nodes: Mapping[int | None, Node]) -> str:
    """Return the expression that a port of the core is connected to."""
    if port.leaf is not None:
        return leaf_actual(port, nodes[port.leaf])
    stream, _, member = port.name.rpartition("_")
    if not stream or member == "tready":
        return port.name
    return "status" if port.name == f"{_STATUS}_tdata" else f"{stream}.{member}"


def leaf_actual(port: Port, node: Node, msg: str = "msg", rdy: str = "rdy") -> str:
    """Return the expression for a port of a leaf; `msg` and `rdy` are names of structs."""
    if port.member == "ready":
        return f"{rdy}.{node.access}"
    return f"{msg}.{node.access}.{port.member}"
