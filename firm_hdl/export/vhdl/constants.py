"""Constants of a message type in VHDL, and text from definitions as VHDL comments.

An integer becomes a vector of its own width and sign, so that it can be compared with a field and
may have 64 bits. A float becomes a real and its bits. A string becomes its bytes on the wire.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from math import isfinite

from firm_hdl.export import remarks
from firm_hdl.export.constants import NamedConstant, float_bits, string_bytes
from firm_hdl.export.remarks import remark, unit_of
from firm_hdl.model import Field, Message, Primitive
from firm_hdl.names.identifiers import first_free

__all__ = ["comment", "declarations", "origin", "quoted"]


def comment(text: str, indent: str = "  ") -> Iterator[str]:
    """Yield text as comment lines of at most 100 columns, in ASCII."""
    return remark(text, indent, "--")


def quoted(text: str, indent: str = "  ") -> Iterator[str]:
    """Yield a comment of a definition; see :func:`firm_hdl.export.remarks.quoted`."""
    return remarks.quoted(text, indent, "--")


def origin(source: Field, name: str) -> str:
    """Return a comment that names the ROS field of a record member; `name` is the VHDL name."""
    return f"  -- {remarks.origin(source, name)}"


def declarations(named: Iterable[NamedConstant], taken: Iterable[str]) -> Iterator[str]:
    """Yield the declarations, in the order of `named`."""
    owner: Message | None = None
    named = list(named)
    used = {*taken, *(entry.name.lower() for entry in named)}
    widths = {
        id(entry.owner): max(len(other.name) for other in named if other.owner is entry.owner)
        for entry in named
    }
    for entry in named:
        if entry.owner is not owner:
            owner = entry.owner
            yield f"\n  -- Constants of {owner.name}.\n"
        constant = entry.constant
        unit = unit_of(constant.unit)
        yield from quoted(constant.comment)
        if isinstance(constant.type, Primitive):
            name = entry.name.ljust(widths[id(owner)])
            yield from _number(name, constant.type, constant.value, unit, used)
        else:
            yield f"  constant {entry.name} : string :=\n    {_string(constant.value)};\n"


def _number(name: str, kind: Primitive, value: object, unit: str, used: set[str]) -> Iterator[str]:
    assert isinstance(value, bool | int | float)
    bits, digits = 8 * kind.bytes, 2 * kind.bytes
    if kind.kind == "bool":
        yield f"  constant {name} : std_logic := '{int(value)}';\n"
    elif kind.kind == "int":
        vector = "signed" if kind.signed else "unsigned"
        number = int(value)
        literal = f'x"{number % (1 << bits):0{digits}x}"'
        remark = f"{kind} {number}{unit}"
        yield f"  constant {name} : {vector}({bits - 1} downto 0) := {literal};  -- {remark}\n"
    else:
        number_ = float(value)
        if isfinite(number_):
            yield f"  constant {name} : real := {_real(number_)};  -- {kind}{unit}\n"
        if not kind.has_wire_format:
            return  # Its bits are not defined.
        bits_name = first_free(f"{name.rstrip()}_BITS", used)
        used.add(bits_name.lower())
        image = float_bits(number_, kind.bytes)
        yield (
            f"  constant {bits_name} : std_logic_vector({bits - 1} downto 0) :="
            f' x"{image:0{digits}x}";\n'
        )


def _real(value: float) -> str:
    """Write a real literal; VHDL requires a decimal point."""
    mantissa, _, exponent = repr(value).partition("e")
    point = mantissa if "." in mantissa else f"{mantissa}.0"
    return f"{point}e{int(exponent)}" if exponent else point


def _string(value: object) -> str:
    """Write the bytes of a string as an expression, with at most 80 characters per line."""
    data = string_bytes(value)
    parts = []
    # No literal contains `--`, because some tools see a comment there, even in a string.
    for piece in re.findall(rb"(?:[ -,.-~]|-(?!-)){1,80}|-|[^ -~]", data):
        if len(piece) == 1 and not 32 <= piece[0] < 127:
            parts.append(f"character'val({piece[0]})")
        else:
            parts.append('"' + piece.decode("ascii").replace('"', '""') + '"')
    # A single character is no string, so an empty string is put in front.
    if not parts or (len(parts) == 1 and parts[0].startswith("character")):
        parts.insert(0, '""')
    return " &\n    ".join(parts)
