"""Amaranth's `Print`, `Assert` and `Assume` as VHDL reports and assertions.

They are for simulators, so they are between ``translate_off`` and ``translate_on``. Without a clock
they are in postponed processes, which run when all signals have settled. `Cover` becomes a comment,
because VHDL has cover statements only in PSL. A format keeps its base (such as hexadecimal), but
not its field width.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from firm_hdl.rtlil.ir import Cell, cut
from firm_hdl.vhdl.expr import Values
from firm_hdl.vhdl.uses import int_parameter

__all__ = ["FIELD", "message"]

FIELD = re.compile(r"\{\{|\}\}|\{(\d+):(?:U|[<>=^].\d*([bodhHc])[-+ ]?#?_?([us]?))\}", re.DOTALL)
_FUNCTIONS = {"b": "to_string", "o": "to_ostring", "h": "to_hstring", "H": "to_hstring"}


def message(cell: Cell, values: Values, module: str) -> Iterator[str]:
    """Yield the lines of a `$print` or `$check`."""
    flavor = str(cell.parameters.get("FLAVOR", "print"))
    test = values.logic(cell.ports["A"]).text if "A" in cell.ports else ""
    if flavor == "cover":
        yield f"-- Cover: {test}"
        return
    clock = cell.ports.get("TRG", ())
    yield "-- synthesis translate_off"
    if clock:
        function = "rising_edge" if int_parameter(cell, "TRG_POLARITY") else "falling_edge"
        name = values.logic(clock).text
        yield f"process ({name})"
        yield "begin"
        yield f"  if {function}({name}) and {values.boolean(cell.ports['EN']).inside(3)} then"
    else:
        yield "postponed process (all)"
        yield "begin"
        yield f"  if {values.boolean(cell.ports['EN']).text} then"
    text = _report(cell, values)
    if flavor == "print":
        yield f"    report {text} severity note;"
    else:
        word = "assumption" if flavor == "assume" else "assertion"
        text = text if text != '""' else f'"{word} failed in {module}"'
        yield f"    assert {values.boolean(cell.ports['A']).text} report {text} severity error;"
    yield "  end if;"
    yield "end process;"
    yield "-- synthesis translate_on"


def _report(cell: Cell, values: Values) -> str:
    template = str(cell.parameters.get("FORMAT", "")).removesuffix("\n")
    parts: list[str] = []
    plain, position, low = "", 0, 0
    for match in FIELD.finditer(template):
        plain += template[position : match.start()]
        position = match.end()
        if match[1] is None:
            plain += match[0][0]
            continue
        parts += [*_plain(plain), _field(cell, values, match, low)]
        plain, low = "", low + int(match[1])
    parts += _plain(plain + template[position:])
    return " & ".join(parts) if parts else '""'


def _field(cell: Cell, values: Values, match: re.Match[str], low: int) -> str:
    width, kind, sign = int(match[1]), match[2], match[3]
    spec = cut(cell.ports["ARGS"], low, width)
    if not width:
        return '"0"'
    if kind is None:
        return f"to_characters({values.unsigned(cut(spec, 0, 8), 8).text})"
    if kind == "c":
        # Of RTLIL, as of `to_characters`, the first character is in the highest bits.
        return f"to_characters({values.unsigned(spec).text})"
    text = values.unsigned(spec).text
    if kind == "d":
        return f"to_decimal({f'signed({text})' if sign == 's' else text})"
    return f"{_FUNCTIONS[kind]}({text})"


def _plain(text: str) -> list[str]:
    """Write characters as string literals; VHDL allows no control characters in them."""
    parts: list[str] = []
    for piece in re.split(r"([\x00-\x1f\x7f])", text):
        if len(piece) == 1 and not piece.isprintable():
            parts.append(f"character'val({ord(piece)})")
        elif piece:
            ascii_text = piece.encode("ascii", "replace").decode().replace('"', '""')
            parts.append(f'"{ascii_text}"')
    return parts
