"""Constants of a message type: their names in VHDL and SystemVerilog, and their bits."""

from __future__ import annotations

import struct
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from firm_hdl.export.tree import snake
from firm_hdl.model import Constant, Message
from firm_hdl.names.identifiers import scope_names
from firm_hdl.vhdl.names import PREDEFINED, USED

__all__ = ["NamedConstant", "float_bits", "named_constants", "string_bytes"]


@dataclass(frozen=True, slots=True, kw_only=True)
class NamedConstant:
    """A constant with its name in the output.

    Attributes
    ----------
    owner : Message
        The type that declares the constant: the message, or a type inside it.
    constant : Constant
    name : str
        Name in VHDL and SystemVerilog.
    """

    owner: Message
    constant: Constant
    name: str


def named_constants(
    message: Message, taken: Iterable[str], *, nested: bool = True
) -> list[NamedConstant]:

    """Name the constants of a message; with `nested`, those of all types in it, too.

    The message's own constants keep their names, unless these would hide names that VHDL code needs
    (`ERROR` is a severity, and `NS` a unit). Names of other constants start with their type's name.

    Parameters
    ----------
    taken : iterable of str
        Names that no constant may get, in lower case.
    """
    found: dict[str, tuple[Message, Constant]] = {}
    hiding = {*USED, *PREDEFINED, *taken}
    for owner in _types(message) if nested else [message]:
        prefix = "" if owner is message else f"{snake(owner.base_name).upper()}_"
        for constant in owner.constants:
            name = f"{prefix}{constant.name}"
            if name.lower() in hiding:
                name = f"{name}_CONSTANT"
            # Two packages may have types of the same name.
            while name in found:
                name = f"{name}_{owner.package}"
            found[name] = (owner, constant)
    given: Mapping[str, str] = scope_names(found, hiding)
    return [
        NamedConstant(owner=owner, constant=constant, name=given[name])
        for name, (owner, constant) in found.items()
    ]


def _types(message: Message) -> list[Message]:
    """List a message and the types in it, each once, in the order of the fields."""
    found: dict[str, Message] = {}

    def visit(kind: Message) -> None:
        if kind.name not in found:
            found[kind.name] = kind
            for item in kind.fields:
                inner = item.element_type
                if isinstance(inner, Message):
                    visit(inner)

    visit(message)
    return list(found.values())


def float_bits(value: float, size: int) -> int:
    """Return the bits of a float of 4 or 8 bytes."""
    if size == 8:
        return int(struct.unpack("<Q", struct.pack("<d", value))[0])
    try:
        packed = struct.pack("<f", value)
    except OverflowError:
        packed = struct.pack("<f", float("inf") if value > 0 else float("-inf"))
    return int(struct.unpack("<I", packed)[0])


def string_bytes(value: object) -> bytes:
    """Return the bytes of a string constant, in UTF-8."""
    return value if isinstance(value, bytes) else str(value).encode("utf-8", "surrogatepass")
