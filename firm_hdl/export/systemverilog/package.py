"""The SystemVerilog package of a message type: its structs, tie-off constants, and ROS constants.

The text depends only on the type, the wire format and the width of the bus. So the folders of all
messages that contain the type have the same file.
"""

from __future__ import annotations

from collections.abc import Iterator

from firm_hdl.export.constants import Declaration, NamedConstant, declarations, named_constants
from firm_hdl.export.records import head_of, message_records
from firm_hdl.export.systemverilog.structs import guarded, package_name, stream_structs
from firm_hdl.export.systemverilog.types import (
    TYPES_NAME,
    WORDS,
    bus_name,
    bus_package,
    types_package,
)
from firm_hdl.export.tree import Package, Tree, taken_names
from firm_hdl.plan import Plan

__all__ = ["constants_of", "message_package", "shared_packages"]


def constants_of(package: Package, plan: Plan) -> list[NamedConstant]:
    """Name the constants that a message itself declares."""
    return named_constants(package.message, _taken(package, plan), nested=False)


def _taken(package: Package, plan: Plan) -> frozenset[str]:
    """Return the names that no constant may hide: those that the package declares or uses."""
    return frozenset(
        {*taken_names(package, plan), *WORDS, bus_name(plan.bus_bytes), package_name(package.name)}
    )


def shared_packages(plan: Plan, tree: Tree) -> dict[str, str]:
    """Write the packages that other messages' folders have, too, by file name.

    * `tree`: the structs of the message.

    Returns: texts in compile order.
    """
    packages = {
        TYPES_NAME: types_package(),
        bus_name(plan.bus_bytes): bus_package(plan.bus_bytes),
        **{package_name(each.name): message_package(each, plan) for each in tree.packages},
    }
    return {f"{name}.sv": text for name, text in packages.items()}


def message_package(package: Package, plan: Plan) -> str:
    """Write the package."""
    name = package_name(package.name)
    head = head_of(package, plan, what="Structs", advice="", mark="//")
    return "".join(head) + "\n" + guarded(name, _package(package, plan, name))


def _package(package: Package, plan: Plan, name: str) -> Iterator[str]:
    yield f"package {name};\n\n"
    yield f"  import {TYPES_NAME}::*;\n  import {bus_name(plan.bus_bytes)}::*;\n"
    message, *forms = message_records(package)
    yield from stream_structs(message)
    yield "\n  // Sequences and arrays: all elements use the same streams, one after the other.\n"
    for record in forms:
        yield from stream_structs(record)
    yield from declarations(constants_of(package, plan), _taken(package, plan), "//", _constant)
    yield f"\nendpackage : {name}\n"


def _constant(each: Declaration, _width: int) -> str:
    remark = f"  // {each.remark}"
    match each.form:
        case "bool":
            return f"  localparam logic {each.name} = 1'b{each.value};\n"
        case "signed" | "unsigned" | "bits":
            sign, letter = (" signed", "s") if each.form == "signed" else ("", "")
            value = f"{each.bits}'{letter}h{each.digits};{remark if each.remark else ''}"
            return f"  localparam logic{sign} [{each.bits - 1}:0] {each.name} = {value}\n"
        case "real":
            # SystemVerilog needs digits after the point or an exponent; Python's `repr` has them.
            return f"  localparam real {each.name} = {each.value!r};{remark}\n"
    return f"  localparam {each.name} =\n    {_string(each.value)};\n"


def _string(data: bytes) -> str:
    """Write the bytes of a string as an expression, with at most 64 bytes per line."""
    pieces = [_literal(data[at : at + 64]) for at in range(0, max(len(data), 1), 64)]
    return pieces[0] if len(pieces) == 1 else "{" + ",\n     ".join(pieces) + "}"


def _literal(data: bytes) -> str:
    # Escape characters, because some tools find comments, directives and macros in literals.
    text = "".join(
        chr(byte) if 32 <= byte < 127 and chr(byte) not in '"\\/-*`' else f"\\{byte:03o}"
        for byte in data
    )
    return f'"{text}"'
