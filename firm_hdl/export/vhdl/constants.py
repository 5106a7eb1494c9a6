"""Constants of a message type in VHDL, and text from definitions as VHDL comments."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from firm_hdl.export import constants, remarks
from firm_hdl.export.constants import Declaration, NamedConstant
from firm_hdl.export.remarks import remark

__all__ = ["comment", "declarations", "quoted"]


def comment(text: str, indent: str = "  ") -> Iterator[str]:
    """Yield text as comment lines of at most 100 columns, in ASCII."""
    return remark(text, indent, "--")


def quoted(text: str, indent: str = "  ") -> Iterator[str]:
    """Yield a comment of a definition; see :func:`firm_hdl.export.remarks.quoted`."""
    return remarks.quoted(text, indent, "--")


def declarations(named: Iterable[NamedConstant], taken: Iterable[str]) -> Iterator[str]:
    """Yield the declarations, in the order of `named`."""
    return constants.declarations(named, taken, "--", _declaration)


def _declaration(each: Declaration, width: int) -> str:
    name, remark = each.name.ljust(width), f"  -- {each.remark}"
    match each.form:
        case "bool":
            return f"  constant {name} : std_logic := '{each.value}';\n"
        case "signed" | "unsigned":
            kind = f"{each.form}({each.bits - 1} downto 0)"
            return f'  constant {name} : {kind} := x"{each.digits}";{remark}\n'
        case "real":
            return f"  constant {name} : real := {_real(each.value)};{remark}\n"
        case "bits":
            kind = f"std_logic_vector({each.bits - 1} downto 0)"
            return f'  constant {each.name} : {kind} := x"{each.digits}";\n'
    return f"  constant {each.name} : string :=\n    {_string(each.value)};\n"


def _real(value: float) -> str:
    """Write a real literal; VHDL requires a decimal point."""
    mantissa, _, exponent = repr(value).partition("e")
    point = mantissa if "." in mantissa else f"{mantissa}.0"
    return f"{point}e{int(exponent)}" if exponent else point


def _string(data: bytes) -> str:
    """Write the bytes of a string as an expression, with at most 80 characters per line."""
    parts = []
    # No literal contains `--`, because some tools find a comment even in a string.
    for piece in re.findall(rb"(?:[ -,.-~]|-(?!-)){1,80}|-|[^ -~]", data):
        if len(piece) == 1 and not 32 <= piece[0] < 127:
            parts.append(f"character'val({piece[0]})")
        else:
            parts.append('"' + piece.decode("ascii").replace('"', '""') + '"')
    # A single `character` is not a string, so concatenate it with an empty string.
    if not parts or (len(parts) == 1 and parts[0].startswith("character")):
        parts.insert(0, '""')
    return " &\n    ".join(parts)
