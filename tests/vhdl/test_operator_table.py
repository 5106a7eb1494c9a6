"""Every operator with every width, sign and value of small operands, in GHDL against Python.

An operand is the low bits of an input, or a constant. The expected values are computed from the
definition of each operator: integers, and the bits that are left of them.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import pytest

from firm_hdl.vhdl.convert import convert
from tests.vhdl.ghdl import Steps, difference, simulate

BITS = 3
"""Bits of the inputs `a` and `b`."""
WIDTHS = (1, 2, BITS)

ARITHMETIC: dict[str, Callable[[int, int], int]] = {
    "$add": operator.add,
    "$sub": operator.sub,
    "$mul": operator.mul,
    "$and": operator.and_,
    "$or": operator.or_,
    "$xor": operator.xor,
    "$divfloor": operator.floordiv,
    "$modfloor": operator.mod,
}
COMPARISONS: dict[str, Callable[[int, int], int]] = {
    "$eq": operator.eq,
    "$ne": operator.ne,
    "$lt": operator.lt,
    "$le": operator.le,
    "$gt": operator.gt,
    "$ge": operator.ge,
}
# For shifts, the number of bits before the shift matters, and the distance has no sign.
SHIFTS: dict[str, Callable[[int, int], int]] = {
    "$shl": operator.lshift,
    "$shr": operator.rshift,
    "$sshr": operator.rshift,
}
UNARY: dict[str, Callable[[int, int], int]] = {
    "$not": lambda a, _: ~a,
    "$neg": lambda a, _: -a,
    "$reduce_or": lambda a, width: a % (1 << width) != 0,
    "$reduce_bool": lambda a, width: a % (1 << width) != 0,
    "$reduce_and": lambda a, width: a % (1 << width) == (1 << width) - 1,
    "$reduce_xor": lambda a, width: (a % (1 << width)).bit_count() % 2,
}


@dataclass(frozen=True, slots=True)
class Operand:
    """The low bits of an input, or a constant: `value`."""

    name: str
    width: int
    value: int | None = None

    @property
    def text(self) -> str:
        """The operand in RTLIL."""
        if self.value is not None:
            return f"{self.width}'{self.value:0{self.width}b}"
        return rf"\{self.name} [{self.width - 1}:0]"

    def number(self, step: dict[str, int], signed: bool) -> int:
        """Return the value in a step."""
        bits = self.value if self.value is not None else step[self.name] % (1 << self.width)
        return bits - (signed and bits >> self.width - 1) * (1 << self.width)


@dataclass(frozen=True, slots=True)
class Row:
    """An operator with its operands, its sign, and the bits of its result."""

    kind: str
    signed: bool
    operands: tuple[Operand, ...]
    width: int

    def cell(self, number: int) -> str:
        """Return the operator in RTLIL, and what drives the output of its number."""
        lines = [f"  wire width {self.width} output {number + 2} \\o{number}"]
        lines += [f"  wire width {self.width} $w{number}", f"  cell {self.kind} $c{number}"]
        for port, operand in zip("AB", self.operands, strict=False):
            signed = self.signed and not (self.kind in SHIFTS and port == "B")
            lines.append(f"    parameter \\{port}_SIGNED {signed:d}")
            lines.append(f"    parameter \\{port}_WIDTH {operand.width}")
            lines.append(f"    connect \\{port} {operand.text}")
        lines += [f"    parameter \\Y_WIDTH {self.width}", f"    connect \\Y $w{number}", "  end"]
        return "\n".join([*lines, f"  connect \\o{number} $w{number}\n"])

    def value(self, step: dict[str, int]) -> int | None:
        """Return the bits of the result in a step; `None` if there is none, as of a quotient."""
        a, *others = (
            each.number(step, self.signed and not (self.kind in SHIFTS and place))
            for place, each in enumerate(self.operands)
        )
        if self.kind in UNARY:
            result = UNARY[self.kind](a, self.operands[0].width)
        elif self.kind in ("$divfloor", "$modfloor") and others == [0]:
            return None
        else:
            table = {**ARITHMETIC, **COMPARISONS, **SHIFTS}
            result = table[self.kind](a, others[0])
        return int(result) % (1 << self.width)


def rows_of_inputs() -> Iterator[Row]:
    """Yield all operators of two inputs or one, of all widths."""
    for signed, wide_a in product((False, True), WIDTHS):
        a = Operand("a", wide_a)
        for kind, width in product(UNARY, (1, 2, 5)):
            if width == 1 or not kind.startswith("$reduce"):
                yield Row(kind, signed, (a,), width)
        for wide_b in WIDTHS:
            pair = a, Operand("b", wide_b)
            for kind, width in product(ARITHMETIC, (1, 2, BITS + 2)):
                yield Row(kind, signed, pair, width)
            yield from (Row(kind, signed, pair, 1) for kind in COMPARISONS)
            for width in (1, 2, BITS + 2):
                yield Row("$shl", signed, pair, width)
                yield Row("$sshr" if signed else "$shr", signed, pair, width)


def rows_of_constants() -> Iterator[Row]:
    """Yield operators of an input and a constant, on either side."""
    for signed, value, first in product((False, True), (0, 1, 3, 4, 5, 7), (False, True)):
        pair = Operand("a", BITS), Operand("", BITS, value)
        pair = pair[::-1] if first else pair
        if not first or value:
            yield from (Row(kind, signed, pair, BITS + 1) for kind in ARITHMETIC)
        yield from (Row(kind, signed, pair, 1) for kind in COMPARISONS)
        for kind in ("$shl", "$sshr" if signed else "$shr"):
            yield Row(kind, signed, pair, BITS + 1)


WIDE = 34
EDGES = [*(1 << bits for bits in (31, 32, 33)), *((1 << WIDE) - (1 << bits) for bits in (31, 32))]
NEAR = sorted({(edge + more) % (1 << WIDE) for edge in (0, *EDGES) for more in (-1, 0, 1)})
"""Numbers around those that VHDL's integers have at most, and around those of 32 bits."""


def rows_of_wide_constants() -> Iterator[Row]:
    """Yield operators of a wide input and a constant that is no integer of VHDL, or just one."""
    for signed, value, first in product((False, True), NEAR, (False, True)):
        pair = Operand("a", WIDE), Operand("", WIDE, value)
        pair = pair[::-1] if first else pair
        for kind in ("$add", "$sub", "$xor", *(["$divfloor", "$modfloor"] if value else [])):
            yield Row(kind, signed, pair, WIDE)
        yield from (Row(kind, signed, pair, 1) for kind in COMPARISONS)


@dataclass(frozen=True, slots=True)
class Table:
    """Operators of inputs of some bits, and the values of the inputs."""

    rows: list[Row]
    bits: int
    values: list[tuple[int, int]]

    @property
    def steps(self) -> Steps:
        """The inputs of each step."""
        return [{"a": a, "b": b} for a, b in self.values]


ALL = [*product(range(1 << BITS), repeat=2)]
TABLES = {
    "inputs": Table([*rows_of_inputs()], BITS, ALL),
    "constants": Table([*rows_of_constants()], BITS, ALL),
    "wide constants": Table([*rows_of_wide_constants()], WIDE, [(value, 0) for value in NEAR]),
}


def design_of(table: Table) -> str:
    """Return a design with all operators, as RTLIL."""
    head = "attribute \\top 1\nmodule \\top\n"
    head += "".join(f"  wire width {table.bits} input {n} \\{c}\n" for n, c in enumerate("ab"))
    return head + "".join(row.cell(n) for n, row in enumerate(table.rows)) + "end\n"


def compared(table: Table, folder: Path, change: tuple[str, str] = ("", "")) -> str | None:
    """Simulate the VHDL of operators, on request changed; return the first difference."""
    rows = table.rows
    vhdl = convert(design_of(table))
    vhdl.files["top.vhd"] = vhdl.files["top.vhd"].replace(*change)
    widths = {f"o{n}": row.width for n, row in enumerate(rows)}
    seen = simulate(vhdl, table.steps, dict.fromkeys("ab", table.bits), widths, folder)
    wanted = [
        {
            name: now[name] if value is None else value
            for name, value in zip(widths, (row.value(step) for row in rows), strict=True)
        }
        for step, now in zip(table.steps, seen, strict=True)
    ]
    found = difference(wanted, seen)
    return found and f"{found}: {rows[int(found.split(': o', 1)[1].split()[0])]}"


@pytest.mark.usefixtures("ghdl")
@pytest.mark.parametrize("table", TABLES)
def test_each_operator_gives_what_python_gives(table: str, tmp_path: Path) -> None:
    assert compared(TABLES[table], tmp_path) is None


@pytest.mark.usefixtures("ghdl")
@pytest.mark.parametrize("change", [(" > ", " >= "), ("sign_extend", "resize")])
@pytest.mark.sampled(2)
def test_a_changed_operator_is_noticed(change: tuple[str, str], tmp_path: Path) -> None:
    assert compared(TABLES["inputs"], tmp_path, change) is not None
