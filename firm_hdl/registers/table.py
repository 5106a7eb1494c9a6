"""A table of registers: what software sees at which address."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, TypeAlias

__all__ = ["WORD_BYTES", "Field", "Kind", "Register", "RegisterMap"]

WORD_BYTES = 4
"""Bytes of a register. AXI4-Lite has words of 32 or 64 bits; 32 fit every processor."""

Kind: TypeAlias = Literal["constant", "status", "setting", "pulse", "event", "unused"]
"""How software and hardware use a field.

``constant``: software reads its reset value. ``status``: software reads what the hardware shows.
``setting``: software reads and writes. ``pulse``: a written 1 is high for one cycle, and software
reads 0. ``event``: the hardware sets it; software reads it, and clears it with a written 1.
``unused``: software writes what it likes, which has no effect, and reads 0.
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Field:
    """Bits of a register."""

    name: str
    # Lowest bit, and number of bits.
    low: int
    bits: int
    kind: Kind
    meaning: str
    reset: int = 0  # Value of a constant, and after a reset of a setting.

    @property
    def is_written(self) -> bool:
        """Whether software writes it."""
        return self.kind not in ("constant", "status")


@dataclass(frozen=True, slots=True, kw_only=True)
class Register:
    """A word of 32 bits."""

    name: str
    address: int  # In bytes from the begin of the map.
    fields: tuple[Field, ...]  # Bits without a field read as 0.
    meaning: str

    @property
    def is_written(self) -> bool:
        """Whether software writes a part of it. Else writing is an error."""
        return any(field.is_written for field in self.fields)


@dataclass(frozen=True, slots=True, kw_only=True)
class RegisterMap:
    """All registers of a block, in the order of their addresses.

    Raises `ValueError` if words or fields overlap, lie outside, or have one name.
    """

    name: str  # A word, as C and SystemRDL allow it.
    registers: tuple[Register, ...]
    meaning: str

    def __post_init__(self) -> None:
        end = 0
        for register in self.registers:
            if register.address < end or register.address % WORD_BYTES:
                raise ValueError(f"Register {register.name!r} has no word of its own")
            end, bit = register.address + WORD_BYTES, 0
            for field in sorted(register.fields, key=lambda field: field.low):
                fits = 0 <= field.reset < 1 << field.bits if field.bits > 0 else False
                if field.low < bit or field.low + field.bits > 8 * WORD_BYTES or not fits:
                    raise ValueError(f"Field {register.name}.{field.name} has no bits of its own")
                bit = field.low + field.bits
        names = [name for name, _, _ in self.fields()]
        if len({name.lower() for name in names}) < len(names):
            raise ValueError(f"Two fields of {self.name} have one name")

    @property
    def address_bits(self) -> int:
        """Bits of an address of the map, at least those of a page of 4 KiB.

        Tools that assign addresses give a slave whole pages, and so does an MMU.
        """
        last = self.registers[-1].address if self.registers else 0
        return max(12, last.bit_length())

    def fields(self) -> Iterator[tuple[str, Register, Field]]:
        """Yield all fields; the name is that of the register, an underscore, and that of the field.

        The only field of a register that has its name has this name alone.
        """
        for register in self.registers:
            for field in register.fields:
                alone = len(register.fields) == 1 and field.name == register.name
                yield register.name if alone else f"{register.name}_{field.name}", register, field
