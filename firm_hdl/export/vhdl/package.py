"""The VHDL packages that folders of several messages share: of a message, of a bus, of primitives.

The text of a message's package depends only on the type, the wire format and the width of the bus.
So the folders of all messages that contain the type have the same file, and a design compiles it
once. The number of items in a transfer depends only on the primitive and on the width of the bus.
So all messages on a bus of one width share the types of strings, arrays and sequences.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from firm_hdl.export.constants import NamedConstant, named_constants
from firm_hdl.export.primitives import PRIMITIVE_BITS, PRIMITIVE_BYTES, TYPES_NAME, bus_name
from firm_hdl.export.records import Member, Record, head_of, message_records, shared_records
from firm_hdl.export.templates import text_of
from firm_hdl.export.tree import Package, taken_names
from firm_hdl.export.vhdl.constants import declarations, quoted
from firm_hdl.plan import Plan
from firm_hdl.vhdl.text import wrap

if TYPE_CHECKING:
    # Records of values are declared with the types here.
    from firm_hdl.export.vhdl.values import ValueType

__all__ = [
    "bus_package",
    "constants_of",
    "data_type",
    "message_package",
    "record_elements",
    "stream_record",
    "types_package",
]


def record_elements(elements: Sequence[tuple[str, str, str, Iterable[str]]]) -> Iterator[str]:
    """Yield elements of a record, given by name, type, comment after it, and lines above."""
    width = max(len(name) for name, *_ in elements)
    # Long types of other packages do not widen the column.
    short = [len(kind) for _, kind, *_ in elements if not kind.startswith("work.")]
    kinds = max(short, default=0) + 1
    for name, kind, remark, above in elements:
        yield from above
        comment = f"  -- {remark}" if remark else ""
        yield f"    {name:{width}} : {kind + ';':{kinds}}{comment}".rstrip() + "\n"


def stream_record(record: Record) -> Iterator[str]:
    """Yield the types and constants of a record."""
    base, members = record.stem, record.members
    width = max(len(each.name) for each in members)
    yield f"\n  type {base}_t is record\n"
    yield from record_elements(
        [
            (each.name, _of(each, f"{each.stem}_t"), each.remark, quoted(each.comment, "    "))
            for each in members
        ]
    )
    yield f"  end record;\n\n  type {base}_ready_t is record\n"
    for each in members:
        kind = "std_logic" if each.is_leaf else _of(each, f"{each.stem}_ready_t")
        yield f"    {each.name:{width}} : {kind};\n"
    yield "  end record;\n"
    idle = {each.name: _of(each, f"{each.stem.upper()}_IDLE") for each in members}
    ready = {
        each.name: "'1'" if each.is_leaf else _of(each, f"{each.stem.upper()}_ALL_READY")
        for each in members
    }
    for what, kind, values in (("IDLE", "t", idle), ("ALL_READY", "ready_t", ready)):
        listed = ",\n".join(f"    {name:{width}} => {value}" for name, value in values.items())
        yield f"\n  constant {base.upper()}_{what} : {base}_{kind} := (\n{listed});\n"


def _of(member: Member, name: str) -> str:
    """Return a name of the package that declares a member's type."""
    return f"work.{member.package}.{name}" if member.package else name


def data_type(primitive: str) -> str:
    """Return the VHDL type of a primitive's value.

    >>> data_type("int16"), data_type("bool"), data_type("float32")
    ('signed(15 downto 0)', 'std_logic', 'std_logic_vector(31 downto 0)')
    """
    if primitive == "bool":
        return "std_logic"
    kinds = {"int": "signed", "uint": "unsigned", "float": "std_logic_vector"}
    return f"{kinds[primitive.rstrip('0123456789')]}({PRIMITIVE_BITS[primitive] - 1} downto 0)"


def types_package() -> str:
    """Return the package and its body, a file beside this module."""
    return text_of(f"vhdl/{TYPES_NAME}.vhd")


def bus_package(bus_bytes: int) -> str:
    """Write the package."""
    return "".join(_package(bus_bytes))


def _package(bus_bytes: int) -> Iterator[str]:
    name = bus_name(bus_bytes)
    yield f"""\
-- Streams of strings, arrays and sequences on a bus of {bus_bytes} bytes, for all message types.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.{TYPES_NAME}.all;

package {name} is
"""
    for primitive, size in PRIMITIVE_BYTES.items():
        yield from _items(primitive, max(1, bus_bytes // size))
    for record in shared_records():
        yield from stream_record(record)
    yield f"\nend package {name};\n"


def _items(primitive: str, lanes: int) -> Iterator[str]:
    zeros = "(others => '0')" if primitive == "bool" else "(others => (others => '0'))"
    yield (
        f"\n  type {primitive}_items_stream_t is record\n"
        f"    data  : {primitive}_items_t(0 to {lanes - 1});  -- zeros after the last item\n"
        "    last  : std_logic;  -- last transfer of the array or sequence\n"
        "    valid : std_logic;\n"
        "  end record;\n"
        f"\n  constant {primitive.upper()}_ITEMS_STREAM_IDLE : {primitive}_items_stream_t := (\n"
        f"    data => {zeros}, last => '0', valid => '0');\n"
    )


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
