# amaranth: UnusedElaboratable=no
"""The packet parts that can be written as designs of their own, by their names."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from amaranth.lib import wiring

from firm_hdl.errors import UserError
from firm_hdl.gateware.packets import (
    PacketArbiter,
    PacketCrossing,
    PacketFifo,
    PacketGate,
    PacketRouter,
    PacketWidth,
)
from firm_hdl.model import Message
from firm_hdl.names.identifiers import plain
from firm_hdl.vhdl.names import legal

__all__ = ["Part", "make_part"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """A packet part with its parameters.

    Attributes
    ----------
    kind : str
        ``"gate"``, ``"fifo"``, ``"width"``, ``"crossing"``, ``"arbiter"`` or ``"router"``.
    name : str
        Name of its folder and of its top level.
    parameters : dict
        As given; with ``type`` and ``dialect``, if it is a gate.
    component : Component
    """

    kind: str
    name: str
    parameters: dict[str, Any]
    component: wiring.Component


_MAKERS: dict[str, Callable[..., wiring.Component]] = {
    "gate": PacketGate,
    "fifo": PacketFifo,
    "width": PacketWidth,
    "crossing": PacketCrossing,
    "arbiter": PacketArbiter,
    "router": PacketRouter,
}

# The parameters that are in the name of a part.
_NAMED = {
    "gate": ("bus_bytes",),
    "fifo": ("bus_bytes",),
    "width": ("in_bytes", "out_bytes"),
    "crossing": ("bus_bytes",),
    "arbiter": ("bus_bytes", "inputs"),
    "router": ("bus_bytes", "topics"),
}


def make_part(
    kind: str, *, message: Message | None = None, name: str | None = None, **parameters: Any
) -> Part:
    """Make a packet part.

    Parameters
    ----------
    kind : str
        As for :class:`Part`.
    message : Message or None
        What a gate forwards; `None` for other parts.
    name : str or None
        Default: the kind, the message type, and the widths of buses, such as ``packet_fifo_8``.
    parameters
        Those of the component, such as `bus_bytes`; see :mod:`firm_hdl.gateware.packets`.

    Raises
    ------
    UserError
        If the part cannot have these parameters or this name.
    """
    if name is not None and legal(name) != name:
        raise UserError(f"The VHDL of every part uses the name '{name}' itself")
    given = dict(parameters)
    try:
        if message is None:
            component = _MAKERS[kind](**parameters)
        else:
            component = _MAKERS[kind](message, **parameters)
            given |= {"type": message.name, "dialect": message.dialect}
    except ValueError as error:
        raise UserError(str(error)) from None
    type_name = [plain(message.name, "f").lower()] if message is not None else []
    widths = [str(parameters[each]) for each in _NAMED[kind]]
    default = "_".join(["packet", kind, *type_name, *widths])
    return Part(kind=kind, name=name or default, parameters=given, component=component)
