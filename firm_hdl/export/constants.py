"""Constants of a message type: their names and values in VHDL and SystemVerilog."""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import groupby
from math import isfinite
from typing import Any, Literal, TypeAlias

from firm_hdl.export.remarks import quoted, unit_of
from firm_hdl.export.tree import snake
from firm_hdl.model import Constant, Message, Primitive, closure
from firm_hdl.names.identifiers import first_free, scope_names
from firm_hdl.vhdl.names import PREDEFINED, USED

__all__ = ["Declaration", "NamedConstant", "declarations", "named_constants"]


@dataclass(frozen=True, slots=True, kw_only=True)
class NamedConstant:
    """A constant with its name in the output."""

    owner: Message  # The type that declares the constant: the message, or a type inside it.
    constant: Constant
    name: str  # Name in VHDL and SystemVerilog.

    def entry(self, package: str) -> dict[str, str]:
        """Return the manifest's entry on the constant, which `package` declares."""
        return {
            "type": self.owner.name,
            "constant": self.constant.name,
            "package": package,
            "name": self.name,
        }


Form: TypeAlias = Literal["bool", "signed", "unsigned", "real", "bits", "string"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Declaration:
    """A constant as every language declares it."""

    name: str
    # An integer is a vector of its own width and sign, so that it can be compared with a field.
    # "bits" is a vector with the bits of a float. A string is its bytes on the wire.
    form: Form
    value: Any
    bits: int = 0  # Width of the vector; 0 for other forms.
    # Type, value and unit, for a comment; empty if the declaration shows all of them.
    remark: str = ""

    @property
    def digits(self) -> str:
        """Hexadecimal digits of a vector, in two's complement."""
        return f"{self.value % (1 << self.bits):0{self.bits // 4}x}"


def named_constants(
    message: Message, taken: Iterable[str], *, nested: bool = True
) -> list[NamedConstant]:
    """Name the constants of a message; with `nested`, also those of all types in the message.

    The message's own constants keep their names, unless these would hide names that VHDL code needs
    (`ERROR` is a severity, and `NS` a unit). Names of other constants start with their type's name.

    * `taken`: names that no constant may get, in lower case.
    """
    found: dict[str, tuple[Message, Constant]] = {}
    hiding = {*USED, *PREDEFINED, *taken}
    for owner in closure([message], parts_first=False) if nested else [message]:
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


def declarations(
    named: Iterable[NamedConstant],
    taken: Iterable[str],
    mark: str,
    write: Callable[[Declaration, int], str],
) -> Iterator[str]:
    """Yield the declarations of constants in a language, in the order of `named`.

    Each type's constants have a title, and each constant the comment of its definition.

    * `taken`: as for :func:`named_constants`.
    * `mark`: the comment mark of the language.
    * `write`: writes a declaration; the second argument is the length of the longest name of the
      type.
    """
    named = list(named)
    used = {*taken, *(entry.name.lower() for entry in named)}
    for owner, group in groupby(named, key=lambda entry: entry.owner.name):
        entries = list(group)
        width = max(len(entry.name) for entry in entries)
        yield f"\n  {mark} Constants of {owner}.\n"
        for entry in entries:
            yield from quoted(entry.constant.comment, mark=mark)
            for declaration in _declared(entry, used):
                yield write(declaration, width)


def _declared(entry: NamedConstant, used: set[str]) -> Iterator[Declaration]:
    """Yield the declarations of a constant; a float has two: a real number, and its bits."""
    name, kind, value = entry.name, entry.constant.type, entry.constant.value
    if not isinstance(kind, Primitive):
        yield Declaration(name=name, form="string", value=_string_bytes(value))
        return
    assert isinstance(value, bool | int | float)
    bits, unit = 8 * kind.bytes, unit_of(entry.constant.unit)
    if kind.kind == "bool":
        yield Declaration(name=name, form="bool", value=int(value))
    elif kind.kind == "int":
        form: Form = "signed" if kind.signed else "unsigned"
        remark = f"{kind} {int(value)}{unit}"
        yield Declaration(name=name, form=form, value=int(value), bits=bits, remark=remark)
    else:
        number = float(value)
        if isfinite(number):
            yield Declaration(name=name, form="real", value=number, remark=f"{kind}{unit}")
        # The bits of a long double are not defined.
        if kind.has_wire_format:
            bits_name = first_free(f"{name}_BITS", used)
            used.add(bits_name.lower())
            image = _float_bits(number, kind.bytes)
            yield Declaration(name=bits_name, form="bits", value=image, bits=bits)


def _float_bits(value: float, size: int) -> int:
    """Return the bits of a float of 4 or 8 bytes."""
    if size == 8:
        return int(struct.unpack("<Q", struct.pack("<d", value))[0])
    try:
        packed = struct.pack("<f", value)
    except OverflowError:
        packed = struct.pack("<f", float("inf") if value > 0 else float("-inf"))
    return int(struct.unpack("<I", packed)[0])


def _string_bytes(value: object) -> bytes:
    """Return the bytes of a string constant, in UTF-8."""
    return value if isinstance(value, bytes) else str(value).encode("utf-8", "surrogatepass")
