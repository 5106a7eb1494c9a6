"""Instantiation templates in Verilog-2005, like those of FPGA vendors, with all fields tied off."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

from firm_hdl.export.remarks import remark
from firm_hdl.export.top import Direction, Port, field_of, ports_of
from firm_hdl.model import Array, Message
from firm_hdl.plan import Leaf, Plan

__all__ = ["instance", "template"]

_STATUS_READY = "m_axis_status_tready"

_ABOUT: dict[Direction, str] = {
    "deserializer": (
        "Every field is tied off: its transfers are taken at once. To use a field, change its "
        "line: connect data and valid, and drive ready."
    ),
    "serializer": (
        "Every field is tied off: it is 0 in all packets, and strings and sequences are empty. To "
        "use a field, change its line: drive data and valid, and connect ready."
    ),
}


def template(direction: Direction, instance: str, *, header: str) -> str:
    """Write a file with an instance.

    * `instance`: as :func:`instance` returns it.
    * `header`: lines of the comment at the head of the file.
    """
    text = [
        *remark(header, ""),
        "//\n",
        *remark(
            "Copy what follows into a module that has aclk and aresetn. Leave out the declarations "
            "of nets that your module has as ports.",
            "",
        ),
        "//\n",
        *remark(_ABOUT[direction], ""),
        "\n",
    ]
    return "".join(text) + instance


def instance(message: Message, plan: Plan, direction: Direction, *, module: str) -> str:
    """Write an instance of a converter's module, and the nets that it needs."""
    text = []
    ports = ports_of(plan, direction)
    for port in ports:
        if port.leaf is None and port.name not in ("aclk", "aresetn", _STATUS_READY):
            text.append(f"wire {port.verilog_range}{port.name};\n")
    text.append(f"\n{module} {direction} (\n")
    text += _connections(message, plan, direction, ports)
    text.append(");\n")
    return "".join(text)


def _connections(
    message: Message, plan: Plan, direction: Direction, ports: tuple[Port, ...]
) -> Iterator[str]:
    """Yield a line for each port that belongs to no field, and a commented line for each field."""
    left = len(ports)
    for index, group in groupby(ports, key=lambda port: port.leaf):
        of_leaf = list(group)
        left -= len(of_leaf)
        end = "," if left else ""
        if index is None:
            # Tie the ready of the status to 1, because a packet waits until its status is taken.
            actuals = {port.name: port.name for port in of_leaf} | (
                {_STATUS_READY: "1'b1"} if not left else {}
            )
            nets = (f"  .{port}({actual})" for port, actual in actuals.items())
            yield ",\n".join(nets) + f"{end}\n"
            continue
        leaf = plan.leaves[index]
        transfers = _transfers(message, plan, leaf)
        tied = {port.name: _tied(leaf, port, transfers) for port in of_leaf}
        yield from remark(_what(leaf, direction, transfers))
        yield "  " + ", ".join(f".{name}({value})" for name, value in tied.items()) + f"{end}\n"


def _transfers(message: Message, plan: Plan, leaf: Leaf) -> int | None:
    """Return the number of transfers of a leaf per enclosing element; `None` if it varies."""

    if leaf.kind != "items":
        return 1
    if any(other.path == (*leaf.path[:-1], "length") for other in plan.leaves):
        return None
    source = field_of(message, leaf)
    assert source is not None and isinstance(source.type, Array)
    return -(-source.type.count // leaf.lanes)


def _what(leaf: Leaf, direction: Direction, transfers: int | None) -> str:
    """Describe a leaf."""
    if leaf.kind == "length":
        return f"{leaf}: number of elements that follow"
    if leaf.kind == "trigger":
        return f"{leaf}: always 1; marks one empty message"
    lanes = f"{leaf.lanes} x " if leaf.lanes > 1 else ""
    what = f"{leaf}: {lanes}{leaf.type}"
    if direction == "serializer" and transfers is None:
        return f"{what}; none, as the length is 0"
    if direction == "serializer" and transfers != 1:
        return f"{what}; {transfers} transfers, which packets wait for; set last with the final one"
    return what


def _tied(leaf: Leaf, port: Port, transfers: int | None) -> str:
    """Return the value that a port is tied to; empty for outputs."""
    if port.direction == "out":
        return ""
    if port.member == "data":
        return f"{port.width}'d{int(leaf.kind == 'trigger')}"
    # A leaf with several transfers needs a `last` that is not constant, so its `valid` is 0.
    return "1'b1" if port.member == "ready" or transfers == 1 else "1'b0"
