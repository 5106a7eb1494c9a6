"""The VHDL package of a message type: its records, tie-off constants, and ROS constants.

The text depends only on the type, the wire format and the width of the bus. So the folders of all
messages that contain the type have the same file, and a design compiles it once.
"""

from __future__ import annotations

from collections.abc import Iterator

from firm_hdl.export.constants import NamedConstant, named_constants
from firm_hdl.export.primitives import TYPES_NAME, bus_name
from firm_hdl.export.tree import Node, Package, taken_names
from firm_hdl.export.vhdl.constants import comment, declarations, origin, quoted
from firm_hdl.export.vhdl.records import Element, stream_record
from firm_hdl.export.vhdl.values import ValueType
from firm_hdl.plan import Plan
from firm_hdl.vhdl.text import wrap

__all__ = ["constants_of", "message_package"]


def constants_of(package: Package, plan: Plan) -> list[NamedConstant]:
    """Name the constants that a message itself declares."""
    return named_constants(package.message, taken_names(package, plan), nested=False)


def message_package(package: Package, plan: Plan, values: ValueType | None) -> str:
    """Write the package, and its body if the message has a record of values."""
    text = [*_head(package, plan), *_streams(package, plan)]
    if values is not None:
        text += values.declarations()
    text += declarations(constants_of(package, plan), taken_names(package, plan))
    text.append(f"\nend package {package.name};\n")
    if values is not None:
        text += [f"\npackage body {package.name} is\n", *values.bodies()]
        text.append(f"\nend package body {package.name};\n")
    lines = (part for line in "".join(text).splitlines() for part in wrap(line))
    return "".join(f"{line}\n" for line in lines)


def _head(package: Package, plan: Plan) -> Iterator[str]:
    base, message = package.base, package.message
    yield from comment(
        f"Records of {message.name}: {base}_t has data and valid of every field, {base}_ready_t "
        f"has ready, in the opposite direction. {base.upper()}_ALL_READY takes every transfer; "
        f"{base.upper()}_IDLE offers none.",
        "",
    )
    yield from comment(
        f"Made by firm-hdl. All converters with wire {plan.wire} and a bus of "
        f"{plan.bus_bytes} bytes share this file: compile it once.",
        "",
    )
    if message.comment:
        yield "--\n"
        yield from quoted(message.comment, "")
    # These clauses are for tools that find the compile order of files. The names are written in
    # full below, because types of the same name in two packages would hide each other.
    needs = "".join(f"use work.{name};\n" for name in package.needs)
    yield f"""
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.{TYPES_NAME}.all;
use work.{bus_name(plan.bus_bytes)}.all;
{needs}
package {package.name} is
"""


def _streams(package: Package, plan: Plan) -> Iterator[str]:
    base = package.base
    yield from stream_record(
        base, [_element(child, package.name, plan) for child in package.node.children]
    )
    item = Element(
        name="item",
        type=f"{base}_t",
        ready_type=f"{base}_ready_t",
        idle=f"{base.upper()}_IDLE",
        all_ready=f"{base.upper()}_ALL_READY",
    )
    length = Element(
        name="length",
        type="uint32_stream_t",
        ready_type="std_logic",
        idle="UINT32_STREAM_IDLE",
        all_ready="'1'",
        remark="  -- number of elements",
    )
    yield "\n  -- Sequences and arrays: all elements use the same streams, one after the other.\n"
    yield from stream_record(f"{base}_sequence", [length, item])
    yield from stream_record(f"{base}_array", [item])


def _element(node: Node, package: str, plan: Plan) -> Element:
    base = node.type.removesuffix("_t").upper()
    ready = node.leaf is not None
    return Element(
        name=node.name,
        type=node.seen_from(package, node.type),
        ready_type=node.seen_from(package, node.ready_type),
        idle=node.seen_from(package, f"{base}_IDLE"),
        all_ready="'1'" if ready else node.seen_from(package, f"{base}_ALL_READY"),
        comment=tuple(quoted(node.source.comment, "    ")) if node.source is not None else (),
        remark=origin(node.source, node.name) if node.source is not None else "",
    )
