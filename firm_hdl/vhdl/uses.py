"""The readers of a wire, and whether they may read an expression instead."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from firm_hdl.rtlil.ir import (
    Assign,
    Bits,
    Cell,
    Chunk,
    Slice,
    Spec,
    Statement,
    Switch,
    cut,
    spec_width,
)

__all__ = [
    "INLINE",
    "Use",
    "enable_runs",
    "int_parameter",
    "output",
    "statement_uses",
    "trim",
    "uses_of",
]

_MODULAR = frozenset("$add $sub $mul $neg $and $or $xor $not $mux $shl".split())
"""Kinds of cells whose low result bits depend on the low operand bits only."""

INLINE = _MODULAR | frozenset(
    "$reduce_bool $reduce_or $reduce_and $reduce_xor $divfloor $modfloor $shr $sshr $shift "
    "$eq $ne $lt $le $gt $ge".split()
)
"""Kinds of cells that VHDL writes as an expression."""


def trim(spec: Spec, width: int) -> Spec:
    """Keep the `width` low bits."""
    return cut(spec, 0, width)


def int_parameter(cell: Cell, name: str) -> int:
    """Read a parameter that is a number."""
    value = cell.parameters.get(name, 0)
    if isinstance(value, Bits):
        return int(value.text or "0", 2)
    if not isinstance(value, int):
        raise ValueError(f"RTLIL line {cell.line}: parameter {name} of {cell.kind} is no number")
    return value


_OUTPUT = {"$dff": "Q", "$adff": "Q", "$memrd_v2": "DATA"}


def output(cell: Cell) -> str:
    """Name the wire that an operator, flip-flop or memory port drives."""
    chunk = cell.ports[_OUTPUT.get(cell.kind, "Y")][0]
    assert isinstance(chunk, Slice)
    return chunk.wire


def enable_runs(spec: Spec) -> list[tuple[Chunk, int, int]]:
    """Split a write enable, one bit per data bit, into (bit, lowest data bit, number of bits)."""
    runs: list[tuple[Chunk, int, int]] = []
    position = 0
    for chunk in spec:
        for i in range(chunk.width):
            bit: Chunk = (
                Bits(chunk.text[-1 - i])
                if isinstance(chunk, Bits)
                else Slice(chunk.wire, chunk.low + i, 1)
            )
            if runs and runs[-1][0] == bit:
                runs[-1] = (bit, runs[-1][1], runs[-1][2] + 1)
            else:
                runs.append((bit, position, 1))
            position += 1
    return runs


class Use(NamedTuple):
    """One use of a specification; `inline` if an expression may replace the specification."""

    spec: Spec
    inline: bool


def uses_of(cell: Cell, width: Mapping[str, int]) -> Iterator[Use]:
    """Yield what a cell reads; `width` has the bits of each wire that are read."""
    kind, ports = cell.kind, cell.ports
    if kind in INLINE:
        bits = width[output(cell)]
        for port, spec in ports.items():
            # All bits of a select and of a shift distance are read, even if the result is cut.
            cut_port = kind in _MODULAR and port != "S" and (kind != "$shl" or port != "B")
            if port != "Y":
                yield Use(trim(spec, bits) if cut_port else spec, True)
    elif kind in ("$dff", "$adff"):
        yield Use(ports["D"], True)
        yield Use(ports["CLK"], False)
        yield Use(ports.get("ARST", ()), False)
    elif kind == "$memwr_v2":
        runs = enable_runs(ports["EN"])
        yield Use(ports["ADDR"], False)
        yield Use(ports["DATA"], False)
        yield Use(ports["CLK"], False)
        yield from (Use((bit,), len(runs) == 1) for bit, _, _ in runs)
    elif kind == "$memrd_v2":
        yield Use(ports["ADDR"], False)
        yield Use(ports["EN"], True)
        yield Use(ports["CLK"], False)
    elif kind in ("$check", "$print"):
        yield from (Use(spec, port in ("A", "EN")) for port, spec in ports.items())
    elif kind == "$tribuf":
        yield from (Use(ports[port], True) for port in ("A", "EN"))
    elif kind != "$meminit_v2":
        yield from (Use(spec, False) for port, spec in ports.items())


def statement_uses(body: tuple[Statement, ...]) -> Iterator[Use]:
    for statement in body:
        if isinstance(statement, Assign):
            yield Use(statement.value, True)
            continue
        yield from _selector_uses(statement)
        for case in statement.cases:
            yield from statement_uses(case.body)


def _selector_uses(switch: Switch) -> Iterator[Use]:
    """Yield the uses of a selector; a bit may be an expression if it is tested only once."""
    width = position = spec_width(switch.selector)
    patterns = [pattern for case in switch.cases for pattern in case.patterns]
    for chunk in reversed(switch.selector):
        low = position - chunk.width
        # The first digit of a pattern is that of the highest bit.
        readers = sum(
            bool(pattern[width - position : width - low].strip("-")) for pattern in patterns
        )
        both_values = len(switch.selector) == 1 and readers == 2 and position == 1
        yield Use((chunk,), chunk.width == 1 and (readers <= 1 or both_values))
        position = low
