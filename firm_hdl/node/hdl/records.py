"""Ports of an accelerator as records of VHDL, or as structs of SystemVerilog.

The types are those of single converters, in the packages that these have. A wrapper with plain
ports goes around the entity, so that the node has the same instance as otherwise.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from firm_hdl.export.message_ports import RecordPort, message_ports
from firm_hdl.export.systemverilog.package import shared_packages as struct_packages
from firm_hdl.export.systemverilog.structs import package_name
from firm_hdl.export.systemverilog.types import WORDS
from firm_hdl.export.systemverilog.wrapper import leaf_actual
from firm_hdl.export.tree import Tree
from firm_hdl.export.vhdl.layer import shared_packages as record_packages
from firm_hdl.export.vhdl.values import values_of
from firm_hdl.export.vhdl.wrapper import Conversions, Core, Line, entity_around
from firm_hdl.node.description import Description
from firm_hdl.node.hdl.ports import AcceleratorPort, accelerator_ports, outer_ports
from firm_hdl.node.records import found_messages

__all__ = [
    "NO_FILES",
    "Generated",
    "MessageRecord",
    "generated_packages",
    "message_records",
    "record_ports",
    "wrapped",
]


@dataclass(frozen=True, slots=True, kw_only=True)
class MessageRecord:
    """A message of an accelerator: two ports with records."""

    # Its direction is that of a node: `deserializer` if the accelerator takes the message.
    port: RecordPort
    tree: Tree  # The records, with the names of the language.
    package: str  # The package of the message in the language.

    @property
    def is_taken(self) -> bool:
        """Whether the accelerator takes the message, rather than offers it."""
        return self.port.direction == "deserializer"


@dataclass(frozen=True, slots=True, kw_only=True)
class Generated:
    """Files around those of the user's."""

    entity: str  # The outermost entity or module: that of the wrapper.
    # Texts by file name: those that compile before the files of the user's, and after them.
    packages: Mapping[str, str]
    wrapper: Mapping[str, str]


NO_FILES = Generated(entity="", packages={}, wrapper={})


def message_records(description: Description, language: str) -> list[MessageRecord]:
    """List the messages of an accelerator in the order of topics.

    Raises `UserError` if two types would have one package.
    """
    found = []
    is_vhdl = language == "vhdl"
    for port in message_ports(list(found_messages(description)), outer_ports(description)):
        tree = port.tree() if is_vhdl else port.tree(WORDS)
        own = tree.package.name
        package = own if is_vhdl else package_name(own)
        found.append(MessageRecord(port=port, tree=tree, package=package))
    return found


def record_ports(
    description: Description, language: str, records: Sequence[MessageRecord]
) -> tuple[AcceleratorPort, ...]:
    """List the ports of an entity with records: clock, reset, time, then two for each message."""
    return (
        *(port for port in accelerator_ports(description) if _is_other(port)),
        *(port for each in records for port in _both(each, language)),
    )


def _is_other(port: AcceleratorPort) -> bool:
    """Return whether a plain port is of no message."""
    return not port.member or port.is_optional


def _both(record: MessageRecord, language: str) -> Iterator[AcceleratorPort]:
    dot = "::" if language == "systemverilog" else "."
    place = f"{'work.' if language == 'vhdl' else ''}{record.package}{dot}"
    root = record.tree.root
    by_leaf: dict[int | None, dict[str, int]] = {}
    for port in record.port.ports.values():
        by_leaf.setdefault(port.leaf, {})[port.member] = port.width
    forward: dict[str, int] = {}
    for node in root.leaves():
        widths = by_leaf[node.leaf]
        for member in ("data", "last", "valid"):
            if member in widths:
                forward[f"{node.access}.{member}"] = widths[member]
    backward = {node.access: 1 for node in root.leaves()}
    yield AcceleratorPort(
        name=record.port.name,
        direction="in" if record.is_taken else "out",
        width=sum(forward.values()),
        member=record.port.member,
        type=f"{place}{root.type}",
        parts=forward,
    )
    yield AcceleratorPort(
        name=record.port.ready,
        direction="out" if record.is_taken else "in",
        width=len(backward),
        member=record.port.member,
        type=f"{place}{root.ready_type}",
        parts=backward,
    )


def generated_packages(records: Sequence[MessageRecord], language: str) -> dict[str, str]:
    """Write the packages of all messages, by file name, in compile order."""
    files: dict[str, str] = {}
    for each in records:
        plan = each.port.plan
        files |= (
            record_packages(plan, each.tree, values_of(each.tree, plan))
            if language == "vhdl"
            else struct_packages(plan, each.tree)
        )
    return files


def wrapped(
    description: Description,
    records: Sequence[MessageRecord],
    packages: Mapping[str, str],
    found: Sequence[AcceleratorPort],
) -> Generated:
    """Write the entity or the module with plain ports around that of the user's.

    * `found`: the ports that the entity has.
    """
    assert description.hdl is not None
    own = description.hdl.entity
    entity = f"{own}_plain"
    there = {port.name for port in found}
    plain = [
        port for port in accelerator_ports(description) if not _is_other(port) or port.name in there
    ]
    about = f"{own} has records of messages; this wrapper has plain ports. Made by firm-hdl."
    if description.hdl.language == "vhdl":
        text, suffix = f"-- {about}\n{_vhdl(entity, own, records, plain, found)}", "vhd"
    else:
        lines = _systemverilog(entity, own, records, plain, found)
        text, suffix = f"// {about}\n{''.join(lines)}", "sv"
    return Generated(entity=entity, packages=packages, wrapper={f"{entity}.{suffix}": text})


def _vhdl(
    entity: str,
    own: str,
    records: Sequence[MessageRecord],
    plain: Sequence[AcceleratorPort],
    found: Sequence[AcceleratorPort],
) -> str:
    signals = [(port.name, port.type) for port in found if port.type]
    assignments: list[str] = []
    for each in records:
        port = each.port
        names = {inner.name: outer for outer, inner in port.ports.items()}
        made = Conversions(
            port.plan, each.tree, port.direction, msg=port.name, rdy=port.ready, names=names
        )
        for outer, inner in port.ports.items():
            part = made.actual(inner)
            if part == outer:
                continue
            goes_in = (inner.member == "ready") != each.is_taken
            left, right = (part, outer) if goes_in else (outer, part)
            assignments.append(f"  {left} <= {right};\n")
        # What a conversion has as a signal is a port here.
        assignments += made.assignments
    lines = [
        Line(port.name, port.direction, port.vhdl_type, f"{port.member or port.name}.")
        for port in plain
    ]
    core = Core(entity=own, names={})
    actuals = {port.name: port.name for port in found}
    return "".join(entity_around(entity, (), lines, core, actuals, signals, assignments))


def _systemverilog(
    entity: str,
    own: str,
    records: Sequence[MessageRecord],
    plain: Sequence[AcceleratorPort],
    found: Sequence[AcceleratorPort],
) -> Iterator[str]:
    heads = [
        f"  {port.direction + 'put':6} logic {port.verilog_range}{port.name}" for port in plain
    ]
    yield f"\nmodule {entity} (\n" + ",\n".join(heads) + "\n);\n"
    yield from (f"  {port.type} {port.name};\n" for port in found if port.type)
    for each in records:
        nodes = {node.leaf: node for node in each.tree.root.leaves()}
        for outer, inner in each.port.ports.items():
            part = leaf_actual(inner, nodes[inner.leaf], each.port.name, each.port.ready)
            goes_in = (inner.member == "ready") != each.is_taken
            left, right = (part, outer) if goes_in else (outer, part)
            yield f"  assign {left} = {right};\n"
    pins = ",\n".join(f"    .{port.name}({port.name})" for port in found)
    yield f"\n  {own} core (\n{pins}\n  );\n\nendmodule\n"
