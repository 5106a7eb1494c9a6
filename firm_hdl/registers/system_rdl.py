"""SystemRDL 2.0 of a table of registers, for PeakRDL and other generators."""

from __future__ import annotations

from firm_hdl.registers.table import Field, RegisterMap

__all__ = ["system_rdl"]

_ACCESS = {
    "constant": "sw = r; hw = na;",
    "status": "sw = r; hw = w;",
    "setting": "sw = rw; hw = r;",
    # A field of one cycle: software reads 0.
    "pulse": "sw = w; hw = r; singlepulse;",
    "unused": "sw = w; hw = na;",
    "event": "sw = rw; hw = rw; woclr; hwset;",
}


def system_rdl(table: RegisterMap, header: str = "") -> str:
    """Write a table.

    * `header`: lines of the comment at the head.
    """
    lines = [f"// {line}".rstrip() for line in header.splitlines()]
    lines += [
        f"addrmap {table.name} {{",
        f"  desc = {_text(table.meaning)};",
        "  default regwidth = 32;",
        "  default accesswidth = 32;",
    ]
    for register in table.registers:
        lines += ["", "  reg {", f"    desc = {_text(register.meaning)};"]
        for field in register.fields:
            lines += [
                f"    field {{ {_ACCESS[field.kind]} desc = {_text(field.meaning)}; }} "
                f"{field.name}{_bits(field)};"
            ]
        lines.append(f"  }} {register.name} @ {register.address:#x};")
    return "\n".join([*lines, "};", ""])


def _bits(field: Field) -> str:
    # What hardware shows has no reset value that software could rely on.
    reset = "" if field.kind == "status" else f" = {field.reset:#x}"
    return f"[{field.low + field.bits - 1}:{field.low}]{reset}"


def _text(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'
