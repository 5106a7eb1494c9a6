"""The SystemVerilog package of a message type: its structs, tie-off constants, and ROS constants.

The text depends only on the type, the wire format and the width of the bus. So the folders of all
messages that contain the type have the same file.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import isfinite

from firm_hdl.export.constants import NamedConstant, float_bits, named_constants, string_bytes
from firm_hdl.export.remarks import origin, quoted, remark, unit_of
from firm_hdl.export.systemverilog.structs import Member, guarded, stream_structs
from firm_hdl.export.systemverilog.types import TYPES_NAME, WORDS, bus_name
from firm_hdl.export.tree import Node, Package, taken_names
from firm_hdl.model import Primitive
from firm_hdl.names.identifiers import first_free
from firm_hdl.plan import Plan

__all__ = ["constants_of", "message_package", "package_name"]

_LENGTH = Member(name="length", type="uint32_stream_t", remark="  // number of elements")


def package_name(package: str) -> str:
    """Return the name of a message type's package, given the name of its VHDL package.

    The two differ, because simulators of both languages may keep them in one library.

    >>> package_name("std_msgs_msg_header_cdr_8_pkg")
    'std_msgs_msg_header_cdr_8_sv_pkg'
    """
    return f"{package.removesuffix('_pkg')}_sv_pkg"


def constants_of(package: Package, plan: Plan) -> list[NamedConstant]:
    """Name the constants that a message itself declares."""
    return named_constants(package.message, _taken(package, plan), nested=False)


def _taken(package: Package, plan: Plan) -> frozenset[str]:
    """Return the names that no constant may hide: those that the package declares or uses."""
    return frozenset(
        {*taken_names(package, plan), *WORDS, bus_name(plan.bus_bytes), package_name(package.name)}
    )


def message_package(package: Package, plan: Plan) -> str:
    """Write the package."""
    name = package_name(package.name)
    return "".join(_head(package, plan)) + guarded(name, _package(package, plan, name))


def _head(package: Package, plan: Plan) -> Iterator[str]:
    base, message = package.base, package.message
    yield from remark(
        f"Structs of {message.name}: {base}_t has data and valid of every field, {base}_ready_t "
        f"has ready, in the opposite direction. {base.upper()}_ALL_READY takes every transfer; "
        f"{base.upper()}_IDLE offers none.",
        "",
    )
    yield from remark(
        f"Made by firm-hdl. All converters with wire {plan.wire} and a bus of "
        f"{plan.bus_bytes} bytes share this file.",
        "",
    )
    if message.comment:
        yield "//\n"
        yield from quoted(message.comment, "")
    yield "\n"


def _package(package: Package, plan: Plan, name: str) -> Iterator[str]:
    base = package.base
    yield f"package {name};\n\n"
    yield f"  import {TYPES_NAME}::*;\n  import {bus_name(plan.bus_bytes)}::*;\n"
    members = [_member(child, package.name) for child in package.node.children]
    yield from stream_structs(base, members)
    item = Member(name="item", type=f"{base}_t", ready_type=f"{base}_ready_t")
    yield "\n  // Sequences and arrays: all elements use the same streams, one after the other.\n"
    yield from stream_structs(f"{base}_sequence", [_LENGTH, item])
    yield from stream_structs(f"{base}_array", [item])
    yield from _constants(constants_of(package, plan), _taken(package, plan))
    yield f"\nendpackage : {name}\n"


def _member(node: Node, package: str) -> Member:
    own = not node.package or node.package == package
    scope = "" if own else f"{package_name(node.package)}::"
    source = node.source
    return Member(
        name=node.name,
        type=f"{scope}{node.type}",
        ready_type="logic" if node.leaf is not None else f"{scope}{node.ready_type}",
        comment=() if source is None else tuple(quoted(source.comment, "    ")),
        remark="" if source is None else f"  // {origin(source, node.name)}",
    )


def _constants(named: list[NamedConstant], taken: Iterable[str]) -> Iterator[str]:
    used = {*taken, *(entry.name.lower() for entry in named)}
    if named:
        yield f"\n  // Constants of {named[0].owner.name}.\n"
    for entry in named:
        constant = entry.constant
        yield from quoted(constant.comment)
        if isinstance(constant.type, Primitive):
            yield from _number(entry.name, constant.type, constant.value, constant.unit, used)
        else:
            yield f"  localparam {entry.name} =\n    {_string(string_bytes(constant.value))};\n"


def _number(
    name: str, kind: Primitive, value: object, unit: str | None, used: set[str]
) -> Iterator[str]:
    assert isinstance(value, bool | int | float)
    bits, digits = 8 * kind.bytes, 2 * kind.bytes
    if kind.kind == "bool":
        yield f"  localparam logic {name} = 1'b{int(value)};\n"
    elif kind.kind == "int":
        sign, letter = (" signed", "s") if kind.signed else ("", "")
        literal = f"{bits}'{letter}h{int(value) % (1 << bits):0{digits}x}"
        what = f"{kind} {int(value)}{unit_of(unit)}"
        yield f"  localparam logic{sign} [{bits - 1}:0] {name} = {literal};  // {what}\n"
    else:
        number = float(value)
        if isfinite(number):
            yield f"  localparam real {name} = {_real(number)};  // {kind}{unit_of(unit)}\n"
        if not kind.has_wire_format:
            return  # Its bits are not defined.
        bits_name = first_free(f"{name}_BITS", used)
        used.add(bits_name.lower())
        image = float_bits(number, kind.bytes)
        yield f"  localparam logic [{bits - 1}:0] {bits_name} = {bits}'h{image:0{digits}x};\n"


def _real(value: float) -> str:
    """Write a real literal; SystemVerilog needs digits behind the point, or an exponent.

    >>> _real(1e300), _real(-2.0), _real(2.5e-07)
    ('1e+300', '-2.0', '2.5e-07')
    """
    return repr(value)


def _string(data: bytes) -> str:
    """Write the bytes of a string as an expression, with at most 64 bytes per line."""
    pieces = [_literal(data[at : at + 64]) for at in range(0, max(len(data), 1), 64)]
    return pieces[0] if len(pieces) == 1 else "{" + ",\n     ".join(pieces) + "}"


def _literal(data: bytes) -> str:
    # Escaped, because some tools see comments, directives and macros even inside a literal.
    text = "".join(
        chr(byte) if 32 <= byte < 127 and chr(byte) not in '"\\/-*`' else f"\\{byte:03o}"
        for byte in data
    )
    return f'"{text}"'
