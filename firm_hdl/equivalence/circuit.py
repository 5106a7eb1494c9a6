"""One side of a proof: a flat netlist of bits, with its registers set apart.

Both sides become this: the VHDL through GHDL, the RTLIL through Yosys. The cells are those of
Yosys, which works out what they do. Neither side is read by code that the VHDL back end has a part
in.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

__all__ = ["Bit", "Bits", "Cell", "Circuit", "Flop", "ProofError"]

Bit: TypeAlias = int | str
"""A net, by number, or a constant: ``"0"`` or ``"1"``."""
Bits: TypeAlias = tuple[Bit, ...]
"""Least significant first."""


class ProofError(Exception):
    """Something that a proof cannot be made of; the text says what. Nothing is known then."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Cell:
    """A combinational cell of Yosys."""

    kind: str
    parameters: Mapping[str, int | str]
    inputs: Mapping[str, Bits]
    outputs: Mapping[str, Bits]


@dataclass(frozen=True, slots=True, kw_only=True)
class Flop:
    """What happens to one bit of a register.

    Attributes
    ----------
    data, clock : Bit
        Its next state, and what that is taken at an edge of.
    rising : bool
        Whether at the rising edge.
    init : str
        ``0``, ``1``, or ``x`` if anything may be there at the start.
    reset : Bit or None
        What sets it to `reset_value` at any time, if it is `reset_level`.
    """

    data: Bit
    clock: Bit
    rising: bool
    init: str
    reset: Bit | None = None
    reset_level: bool = True
    reset_value: str = "0"


@dataclass(frozen=True, slots=True, kw_only=True)
class Circuit:
    """A flat netlist without its registers.

    Attributes
    ----------
    inputs, outputs : mapping of str to Bits
        Ports by name.
    signals : mapping of tuple to Bits
        Signals by path: the instances that lead to one, and its own name. On the side of the RTLIL,
        registers only.
    cells : list of Cell
    flops : mapping of int to Flop
        By the net that a register drives.
    """

    inputs: Mapping[str, Bits]
    outputs: Mapping[str, Bits]
    signals: Mapping[tuple[str, ...], Bits]
    cells: list[Cell]
    flops: Mapping[int, Flop]
    driven: frozenset[int] = field(init=False)

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
