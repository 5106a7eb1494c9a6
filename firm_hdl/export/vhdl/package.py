"""The VHDL package of a message type: its records, tie-off constants, and ROS constants.

The text depends only on the type, the wire format and the width of the bus. So the folders of all
messages that contain the type have the same file, and a design compiles it once.
"""

from __future__ import annotations

from collections.abc import Iterator

from firm_hdl.export.constants import NamedConstant, named_constants
from firm_hdl.export.primitives import TYPES_NAME, bus_name
from firm_hdl.export.records import head_of, message_records
from firm_hdl.export.tree import Package, taken_names
from firm_hdl.export.vhdl.constants import declarations
from firm_hdl.export.vhdl.records import stream_record
from firm_hdl.export.vhdl.values import ValueType
from firm_hdl.plan import Plan
from firm_hdl.vhdl.text import wrap

__all__ = ["constants_of", "message_package"]


def constants_of(package: Package, plan: Plan) -> list[NamedConstant]:
    """Name the constants that a message itself declares."""
    return named_constants(package.message, taken_names(package, plan), nested=False)


def message_package(package: Package, plan: Plan, values: ValueType | None) -> str:
    """Write the package, and its body if the message has a record of values."""
    text = [*_head(package, plan), *_streams(package)]
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
    yield from head_of(package, plan, what="Records", advice=": compile it once", mark="--")
    # These use clauses are only for tools that find the compile order of files. Names below are
    # written in full, because use clauses hide types that have the same name in two packages.
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


def _streams(package: Package) -> Iterator[str]:
    message, *forms = message_records(package)
    yield from stream_record(message)
    yield "\n  -- Sequences and arrays: all elements use the same streams, one after the other.\n"
    for record in forms:
        yield from stream_record(record)
