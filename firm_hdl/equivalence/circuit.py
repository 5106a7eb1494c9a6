"""One side of a proof: a flat netlist of bits, with its registers kept separately.

Both sides are converted to this form: the VHDL through GHDL, the RTLIL through Yosys. The cells are
those of Yosys, and Yosys defines their function. No code of the VHDL back end reads either side.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

__all__ = ["Bit", "Bits", "Cell", "Circuit", "Flop", "ProofError"]

Bit: TypeAlias = int | str
"""A net, by number, or a constant: ``"0"`` or ``"1"``."""
Bits: TypeAlias = tuple[Bit, ...]
"""Bits, the least significant one first."""


class ProofError(Exception):
    """A proof is not possible; the text says why. The circuits may be equal or not."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Cell:
    """A combinational cell of Yosys."""

    kind: str
    parameters: Mapping[str, int | str]
    inputs: Mapping[str, Bits]
    outputs: Mapping[str, Bits]


@dataclass(frozen=True, slots=True, kw_only=True)
class Flop:
    """One bit of a register."""

    # Next state, and clock.
    data: Bit
    clock: Bit
    # Whether the register changes at the rising edge of the clock; otherwise at the falling edge.
    rising: bool
    init: str  # Initial value: `0`, `1`, or `x` for any value.
    reset: Bit | None = None  # Asynchronous reset; `None` if there is none.
    reset_level: bool = True  # Level at which the reset is active.
    reset_value: str = "0"  # Value after a reset: `0` or `1`.


@dataclass(frozen=True, slots=True, kw_only=True)
class Circuit:
    """A flat netlist; its registers are kept apart from the combinational cells."""

    # Ports by name.
    inputs: Mapping[str, Bits]
    outputs: Mapping[str, Bits]
    # Signals by path: the names of the enclosing instances, and the signal's own name. On the RTLIL
    # side, registers only.
    signals: Mapping[tuple[str, ...], Bits]
    cells: list[Cell]
    flops: Mapping[int, Flop]  # Registers by the net that they drive.
    driven: frozenset[int] = field(init=False)  # All nets that have a driver.

    def __post_init__(self) -> None:
        seen: set[int] = set()
        sources: list[Iterable[Bit]] = [*self.inputs.values(), self.flops]
        sources += [bits for cell in self.cells for bits in cell.outputs.values()]
        for bits in sources:
            for bit in bits:
                if not isinstance(bit, int) or bit in seen:
                    raise ProofError(f"net {bit} has two drivers")
                seen.add(bit)
        object.__setattr__(self, "driven", frozenset(seen))
