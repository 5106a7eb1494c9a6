"""Leaves as AXI4-Stream: a module of Verilog around a design with plain ports.

The name of a port is that of an interface and that of a signal of AXI4-Stream, as tools recognise
them: ``linear_x_data`` becomes ``m_axis_linear_x_tdata``. The module has no logic.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from firm_hdl.export.ports import PlainPort
from firm_hdl.export.remarks import remark
from firm_hdl.names.identifiers import first_free

__all__ = ["AxisPort", "axis_module", "axis_ports"]


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisPort(PlainPort):
    """A port of the module, and the port of the design inside."""

    inner: str  # Empty of an input that the design has not.
    inner_width: int  # At most `width`. An input ignores the bits above, and an output has 0 there.


def axis_ports(ports: Sequence[PlainPort], members: Mapping[str, str]) -> list[AxisPort]:
    """List the ports of the module.

    * `ports`: ports of the design.
    * `members`: the ports of leaves: ``data``, ``last``, ``valid`` or ``ready``, by the name of the
      port.
    """
    taken = {port.name.lower() for port in ports if port.name not in members}
    bases: dict[str, str] = {}
    for port in ports:
        if members.get(port.name) == "valid":
            side = "m_axis" if port.direction == "out" else "s_axis"
            base = port.name.removesuffix("_valid")
            bases[base] = first_free(f"{side}_{base}", taken, _signals)
            taken |= {*_signals(bases[base].lower())}
    found = []
    for port in ports:
        name, width = port.name, port.width
        if member := members.get(name):
            name = f"{bases[name.removesuffix(f'_{member}')]}_t{member}"
            # The width of AXI4-Stream's tdata is a multiple of 8 bits.
            width = -(-width // 8) * 8 if member == "data" else width
        found.append(
            AxisPort(
                name=name,
                direction=port.direction,
                width=width,
                inner=port.name,
                inner_width=port.width,
            )
        )
    return found


def _signals(base: str) -> Iterable[str]:
    return [f"{base}_t{name}" for name in ("data", "last", "valid", "ready")]


def axis_module(name: str, inner: str, ports: Sequence[AxisPort], header: str) -> str:
    """Write the module in Verilog-2005.

    * `name`, `inner`: names of the module, and of that of the design.
    * `header`: lines of the comment at the head of the file.
    """
    lines = []
    for port in ports:
        lines.append(f"  {port.direction}put wire {port.verilog_range}{port.name}")
    joined, nets = [], []
    for port in (port for port in ports if port.inner):
        actual = port.name
        if port.width > port.inner_width:
            top = port.inner_width - 1
            if port.direction == "out":
                actual = f"value_of_{port.name}"
                nets.append(f"  wire [{top}:0] {actual};\n")
                more = port.width - port.inner_width
                nets.append(f"  assign {port.name} = {{{more}'d0, {actual}}};\n")
            else:
                actual = f"{port.name}[{top}:0]"
        joined.append(f"    .{port.inner}({actual})")
    return "".join(
        [
            *remark(header, ""),
            f"\nmodule {name} (\n",
            ",\n".join(lines),
            "\n);\n\n",
            *nets,
            f"  {inner} plain (\n",
            ",\n".join(joined),
            "\n  );\n\nendmodule\n",
        ]
    )
