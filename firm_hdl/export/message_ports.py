"""The messages of a design as records of VHDL and as structs of SystemVerilog.

A layer around a design with plain ports has a record or a struct for each message: the types of
single converters.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from firm_hdl.errors import UserError
from firm_hdl.export.remarks import remark
from firm_hdl.export.systemverilog.backend import WAIVERS_TEXT
from firm_hdl.export.systemverilog.package import shared_packages as struct_packages
from firm_hdl.export.systemverilog.structs import package_name
from firm_hdl.export.systemverilog.types import WORDS
from firm_hdl.export.systemverilog.wrapper import leaf_actual
from firm_hdl.export.top import Direction, Port, ports_of
from firm_hdl.export.tree import Tree, tree_of
from firm_hdl.export.vhdl.constants import comment
from firm_hdl.export.vhdl.layer import shared_packages as record_packages
from firm_hdl.export.vhdl.values import values_of
from firm_hdl.export.vhdl.wrapper import Conversions, Core, Line, entity_around
from firm_hdl.gateware.members import member_tree
from firm_hdl.model import Message
from firm_hdl.names.identifiers import flat_names
from firm_hdl.plan import Plan

if TYPE_CHECKING:
    from firm_hdl.export.component import ComponentPort

__all__ = [
    "FoundMessage",
    "RecordPort",
    "message_ports",
    "other_ports",
    "record_facts",
    "record_files",
    "struct_files",
]


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordPort:
    """A message at the top level of a design."""

    # Names of the record with data and valid, and of the record with ready.
    name: str
    ready: str
    member: str  # The member, such as `subscribe.cmd_vel`.
    message: Message
    direction: Direction  # `deserializer` if the message comes out of the design.
    plan: Plan
    # The plain ports of the message's leaves, by their names at the design.
    ports: Mapping[str, Port]

    def tree(self, reserved: Collection[str] = ()) -> Tree:
        """Return the records of the message; `reserved` as for :func:`tree_of`."""
        return tree_of(self.message, self.plan, reserved)


class FoundMessage(NamedTuple):
    """A message among the members of a design."""

    path: tuple[str, ...]  # The member.
    direction: Direction  # `deserializer` if the message comes out of the design.
    message: Message
    plan: Plan


def message_ports(
    found: Sequence[FoundMessage], ports: Sequence[ComponentPort]
) -> list[RecordPort]:
    """List the messages that come out of a design, and go into it.

    * `ports`: all ports of the top level.

    Raises `UserError` if two types of the design would have one package of records.
    """
    taken = [port.name for port in ports]
    paths = [each.path for each in found]
    names = flat_names([*paths, *((*path, "rdy") for path in paths)], taken)
    by_member = {port.member: port.name for port in ports}
    messages = []
    for path, direction, message, plan in found:
        places = dict(member_tree(leaf.path for leaf in plan.leaves).leaves())
        own = {
            by_member[".".join((*path, *places[port.leaf], port.member))]: port
            for port in ports_of(plan, direction)
            if port.leaf is not None
        }
        messages.append(
            RecordPort(
                name=names[path],
                ready=names[(*path, "rdy")],
                member=".".join(path),
                message=message,
                direction=direction,
                plan=plan,
                ports=own,
            )
        )
    _check_packages(messages)
    return messages


def other_ports(
    ports: Sequence[ComponentPort], messages: Sequence[RecordPort]
) -> list[ComponentPort]:
    """Return the ports of a design that belong to no message."""
    own = {name for each in messages for name in each.ports}
    return [port for port in ports if port.name not in own]


def _check_packages(messages: Sequence[RecordPort]) -> None:
    """Refuse types whose names differ only where packages of VHDL do not."""
    owners: dict[str, str] = {}
    for each in messages:
        for package in each.tree().packages:
            owner = owners.setdefault(package.name, package.message.name)
            if owner != package.message.name:
                raise UserError(
                    f"{package.message.name} and {owner} would have one package of VHDL, "
                    f"'{package.name}', so the design has no records"
                )


def record_files(
    name: str,
    ports: Sequence[ComponentPort],
    messages: Sequence[RecordPort],
    *,
    kind: str,
    vhdl_ports: Mapping[str, str],
    header: str,
) -> dict[str, str]:
    """Write the packages of all messages, and the entity ``NAME_records``.

    * `name`: the entity with plain ports.
    * `kind`: what the design is: ``"node"``.
    * `vhdl_ports`: names of its ports, by those of the netlist.
    * `header`: lines of a comment at the head of the entity's file.

    Returns: texts by file name, in compile order; they compile after the design. None without
    messages.
    """
    if not messages:
        return {}
    files: dict[str, str] = {}
    # An actual is the port of the same name, unless it is a part of a record.
    actuals = {port.name: port.name for port in ports}
    lines = [_line(port) for port in other_ports(ports, messages)]
    signals: list[tuple[str, str]] = []
    assignments: list[str] = []
    packages: dict[str, None] = {}
    for each in messages:
        tree = each.tree()
        files |= record_packages(each.plan, tree, values_of(tree, each.plan))
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
        *comment(f"The {kind} with records of messages. {name} has plain ports.", ""),
    ]
    core = Core(entity=name, names=dict(vhdl_ports))
    text = entity_around(entity, packages, lines, core, actuals, signals, assignments)
    files[f"{entity}.vhd"] = "".join([*head, *text])
    return files


def _line(port: ComponentPort) -> Line:
    return Line(port.name, port.direction, port.vhdl_type, f"{port.member}.")


def _lines(port: RecordPort, package: str) -> list[Line]:
    root = port.tree().root
    forwards, backwards = ("out", "in") if port.direction == "deserializer" else ("in", "out")
    # Two types of a design may have the same name, in packages of their own.
    return [
        Line(
            port.name,
            forwards,
            f"{package}.{root.type}",
            f"Data and valid of {port.message.name}.",
        ),
        Line(port.ready, backwards, f"{package}.{root.ready_type}", "Ready of the fields."),
    ]


def struct_files(
    name: str,
    module: str,
    ports: Sequence[ComponentPort],
    messages: Sequence[RecordPort],
    *,
    kind: str,
    header: str,
) -> dict[str, str]:
    """Write the packages of all messages, the module ``NAME_sv``, and the list of files.

    * `module`: the module of Verilog, ``MODULE.v`` in the folder above.
    * `kind`: what the design is: ``"node"``.
    * `header`: lines of a comment at the head of the module's file.

    Returns: texts by file name, in compile order; then ``files.f`` and waivers of Verilator. None
    without messages.
    """
    if not messages:
        return {}
    files: dict[str, str] = {}
    for each in messages:
        files |= struct_packages(each.plan, each.tree(WORDS))
    top = f"{name}_sv"
    listed = [*files, f"../{module}.v", f"{top}.sv"]
    files[f"{top}.sv"] = "".join(
        [
            *remark(header, ""),
            *remark(f"The {kind} with structs of messages. {module} has plain ports.", ""),
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


def _ports(ports: Sequence[ComponentPort], messages: Sequence[RecordPort]) -> Iterator[str]:
    ways = {"in": "input", "out": "output"}
    lines: list[tuple[str, str, str, str]] = []
    for port in other_ports(ports, messages):
        kind = f"logic {port.verilog_range}".rstrip()
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


def _core(
    module: str, ports: Sequence[ComponentPort], messages: Sequence[RecordPort]
) -> Iterator[str]:
    actuals = {port.name: port.name for port in ports}
    for each in messages:
        nodes = {node.leaf: node for node in each.tree(WORDS).root.leaves()}
        for name, port in each.ports.items():
            actuals[name] = leaf_actual(port, nodes[port.leaf], each.name, each.ready)
    width = max(map(len, actuals))
    joined = ",\n".join(f"    .{name:{width}} ({actual})" for name, actual in actuals.items())
    yield f"\n  {module} plain (\n{joined}\n  );\n"


def record_facts(name: str, messages: Sequence[RecordPort], reason: str) -> dict[str, Any]:
    """Describe the message ports with records and structs, or why there are none."""
    if not messages:
        return {"built": False, "reason": reason}
    return {
        "built": True,
        "entity": f"{name}_records",
        "module": f"{name}_sv",
        "sv_files": "systemverilog/files.f",
        "ports": [_record(each) for each in messages],
    }


def _record(port: RecordPort) -> dict[str, Any]:
    tree, structs = port.tree(), port.tree(WORDS)
    return {
        "name": port.name,
        "ready": port.ready,
        "member": port.member,
        "message": port.message.name,
        "package": tree.package.name,
        "message_type": tree.root.type,
        "ready_type": tree.root.ready_type,
        "sv_package": package_name(structs.package.name),
        "sv_message_type": structs.root.type,
        "sv_ready_type": structs.root.ready_type,
    }
