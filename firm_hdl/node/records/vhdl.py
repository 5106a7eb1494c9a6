"""The entity of a node with records, around the entity with plain ports."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from firm_hdl.export.vhdl.constants import comment
from firm_hdl.export.vhdl.layer import shared_packages
from firm_hdl.export.vhdl.values import values_of
from firm_hdl.export.vhdl.wrapper import Conversions, Core, Line, entity_around
from firm_hdl.node.records.messages import MessagePort, other_ports
from firm_hdl.node.top import NodePort

__all__ = ["record_files"]


def record_files(
    name: str,
    ports: Sequence[NodePort],
    messages: Sequence[MessagePort],
    *,
    vhdl_ports: Mapping[str, str],
    header: str,
) -> dict[str, str]:
    """Write the packages of all messages, and the entity ``NAME_records``.

    Parameters
    ----------
    name : str
        The entity with plain ports.
    vhdl_ports : mapping of str to str
        Names of its ports, by those of the netlist.
    header : str
        Lines of a comment at the head of the entity's file.

    Returns
    -------
    dict of str to str
        Texts by file name, in compile order; they compile after the node.
    """
    files: dict[str, str] = {}
    # An actual is the port of the same name, unless it is a part of a record.
    actuals = {port.name: port.name for port in ports}
    lines = [_line(port) for port in other_ports(ports, messages)]
    signals: list[tuple[str, str]] = []
    assignments: list[str] = []
    packages: dict[str, None] = {}
    for each in messages:
        tree = each.tree()
        files |= shared_packages(each.plan, tree, values_of(tree, each.plan))
        packages[tree.package.name] = None
        names = {port.name: outer for outer, port in each.ports.items()}
        made = Conversions(
            each.plan, tree, each.direction, msg=each.name, rdy=each.ready, names=names
        )
        actuals |= {outer: made.actual(port) for outer, port in each.ports.items()}
        signals += made.signals
        assignments += made.assignments
        lines += _lines(each, f"work.{tree.package.name}")
    entity = f"{name}_records"
    head = [
        *comment(header, ""),
        *comment(f"The node with records of messages. {name} has plain ports.", ""),
    ]
    core = Core(entity=name, names=dict(vhdl_ports))
    text = entity_around(entity, packages, lines, core, actuals, signals, assignments)
    files[f"{entity}.vhd"] = "".join([*head, *text])
    return files


def _line(port: NodePort) -> Line:
    kind = "std_logic" if port.width == 1 else f"std_logic_vector({port.width - 1} downto 0)"
    return port.name, f"{port.direction:3} {kind}", f"{port.member}."


def _lines(port: MessagePort, package: str) -> list[Line]:
    root = port.tree().root
    forwards, backwards = ("out", "in ") if port.direction == "deserializer" else ("in ", "out")
    # Two types of a node may have the same name, in packages of their own.
    return [
        (port.name, f"{forwards} {package}.{root.type}", f"Data and valid of {port.message.name}."),
        (port.ready, f"{backwards} {package}.{root.ready_type}", "Ready of the fields."),
    ]
