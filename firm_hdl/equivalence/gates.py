"""Convert GHDL's gates to cells of Yosys.

The function of a gate is that of the VHDL that GHDL itself writes for the gate. Gates that only
rename bits (signals, concatenations, slices, extensions) become no cells. An unknown value ('X') of
GHDL may be any value, and a proof must hold for all values.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from firm_hdl.equivalence.circuit import Bit, Bits, Cell, ProofError
from firm_hdl.equivalence.dump import Instance

__all__ = ["Gate", "divided", "gate_cells", "mux_cell", "operator_cell", "renamed"]

_Fresh = Callable[[int], tuple[int, ...]]
"""Makes new nets that nothing drives."""

_BINARY = {
    "$and": "$and",
    "$or": "$or",
    "$xor": "$xor",
    "$xnor": "$xnor",
    "$add": "$add",
    "$sub": "$sub",
    "$umul": "$mul",
    "$smul": "$mul",
    "$udiv": "$div",
    "$sdiv": "$div",
    "$umod": "$mod",
    "$srem": "$mod",
    "$smod": "$modfloor",
    "$eq": "$eq",
    "$ne": "$ne",
    "$ult": "$lt",
    "$ule": "$le",
    "$ugt": "$gt",
    "$uge": "$ge",
    "$slt": "$lt",
    "$sle": "$le",
    "$sgt": "$gt",
    "$sge": "$ge",
    "$lsl": "$shl",
    "$lsr": "$shr",
    "$asr": "$sshr",
}
_SIGNED = frozenset("$smul $sdiv $srem $smod $slt $sle $sgt $sge $asr".split())
_INVERTED = {"$nand": "$and", "$nor": "$or"}
_UNARY = {
    "$not": "$not",
    "$neg": "$neg",
    "$red_and": "$reduce_and",
    "$red_or": "$reduce_or",
    "$red_xor": "$reduce_xor",
}
_EXTREMES = {
    "$umin": ("$lt", False),
    "$smin": ("$lt", True),
    "$umax": ("$gt", False),
    "$smax": ("$gt", True),
}
_SAME = frozenset("$signal $isignal $output $ioutput $port $nop".split())
_CONCATENATIONS = frozenset("$concat2 $concat3 $concat4 $concatn".split())


class Gate:
    """A gate and its connections.

    * `width`: width of the output.
    * `fresh`: makes nets that may have any value.
    """

    def __init__(
        self, instance: Instance, inputs: Mapping[str, Bits], width: int, fresh: _Fresh
    ) -> None:
        self.kind = instance.kind
        self.name = instance.name
        self.parameters = instance.parameters
        self.inputs = inputs
        self.width = width
        self.fresh = fresh

    def parameter(self) -> int:
        """Return the only parameter."""
        if len(self.parameters) != 1:
            count = len(self.parameters)
            raise ProofError(f"GHDL's {self.kind} {self.name} has {count} parameters")
        return self.parameters[0]

    def check(self, holds: bool) -> None:
        """Raise an error unless the gate has the expected form."""
        if not holds:
            raise ProofError(f"GHDL's {self.kind} {self.name} has an unknown form")


def renamed(gate: Gate) -> Bits | None:
    """Return the bits of a gate's output if the gate only renames bits; otherwise `None`."""
    kind, width = gate.kind, gate.width
    values = list(gate.inputs.values())
    if kind in _SAME:
        gate.check(len(values[0]) == width)
        return values[0]
    if kind in _CONCATENATIONS:
        result = tuple(bit for value in reversed(values) for bit in value)
        gate.check(len(result) == width)
        return result
    if kind == "$extract":
        low = gate.parameter()
        gate.check(low + width <= len(values[0]))
        return values[0][low : low + width]
    if kind in ("$utrunc", "$strunc"):
        gate.check(width <= len(values[0]))
        return values[0][:width]
    if kind in ("$uextend", "$sextend"):
        gate.check(0 < len(values[0]) <= width)
        top = values[0][-1] if kind == "$sextend" else "0"
        return values[0] + (top,) * (width - len(values[0]))
    return _constant(gate) if kind.startswith("$const_") else None


def _constant(gate: Gate) -> Bits:
    width, words = gate.width, gate.parameters
    unknown = 0
    if gate.kind == "$const_X":
        return gate.fresh(width)
    if gate.kind == "$const_UB32":
        value = gate.parameter()
    elif gate.kind == "$const_SB32":
        value = gate.parameter()
        # GHDL prints negative numbers as unsigned ones.
        value -= value >> 31 << 32
    elif gate.kind == "$const_UL32":
        gate.check(len(words) == 2)
        value, unknown = words
    elif gate.kind == "$const_bit":
        gate.check(len(words) == (width + 31) // 32)
        value = sum(word << 32 * place for place, word in enumerate(words))
    elif gate.kind == "$const_log":
        gate.check(len(words) == 2 * ((width + 31) // 32))
        value = sum(word << 32 * place for place, word in enumerate(words[::2]))
        unknown = sum(word << 32 * place for place, word in enumerate(words[1::2]))
    else:
        raise ProofError(f"GHDL's netlist has {gate.kind}, which a proof does not support")
    # 2 is 'Z' and 3 is 'X'; either may be any value.
    return tuple(
        gate.fresh(1)[0] if unknown >> place & 1 else "01"[value >> place & 1]
        for place in range(width)
    )


def gate_cells(gate: Gate, output: tuple[int, ...]) -> list[Cell]:
    """Return the cells that drive a gate's output."""
    kind = gate.kind
    values = list(gate.inputs.values())
    if kind in _BINARY:
        return _binary(gate, values, output)
    if kind in _INVERTED:
        between = gate.fresh(gate.width)
        gate.check(len(values[0]) == len(values[1]) == gate.width)
        return [
            operator_cell(_INVERTED[kind], between, A=values[0], B=values[1]),
            operator_cell("$not", output, A=between),
        ]
    if kind in _UNARY:
        if kind in ("$not", "$neg"):
            gate.check(len(values[0]) == gate.width)
        return [operator_cell(_UNARY[kind], output, A=values[0])]
    if kind in _EXTREMES:
        compare, is_signed = _EXTREMES[kind]
        gate.check(len(values[0]) == len(values[1]) == gate.width)
        first = gate.fresh(1)
        return [
            operator_cell(compare, first, signed=is_signed, A=values[0], B=values[1]),
            mux_cell(output, first[0], values[1], values[0]),
        ]
    if kind == "$abs":
        between = gate.fresh(gate.width)
        gate.check(len(values[0]) == gate.width)
        return [
            operator_cell("$neg", between, A=values[0]),
            mux_cell(output, values[0][-1], values[0], between),
        ]
    if kind == "$mux2":
        gate.check([len(value) for value in values] == [1, gate.width, gate.width])
        select, low, high = values
        return [mux_cell(output, select[0], low, high)]
    if kind == "$mux4":
        return _mux4(gate, values, output)
    if kind == "$pmux":
        return _pmux(gate, values, output)
    raise ProofError(f"GHDL's netlist has {kind}, which a proof does not support")


def _binary(gate: Gate, values: list[Bits], output: tuple[int, ...]) -> list[Cell]:
    kind = _BINARY[gate.kind]
    left, right = values
    if kind not in ("$shl", "$shr", "$sshr"):
        gate.check(len(left) == len(right))
    if kind in ("$eq", "$ne", "$lt", "$le", "$gt", "$ge"):
        gate.check(gate.width == 1)
    else:
        gate.check(len(left) == gate.width)
    signed = gate.kind in _SIGNED
    if kind in ("$shl", "$shr", "$sshr"):
        # Only the value that is shifted can be signed, not the amount.
        return [operator_cell(kind, output, signed=signed, second_signed=False, A=left, B=right)]
    if kind not in ("$div", "$mod", "$modfloor"):
        return [operator_cell(kind, output, signed=signed, A=left, B=right)]
    return divided(kind, signed, left, right, output, gate.fresh)


def divided(
    kind: str, signed: bool, left: Bits, right: Bits, output: tuple[int, ...], fresh: _Fresh
) -> list[Cell]:
    """Return the cells of a division whose result may be any value if the divisor is 0."""
    result, by_zero = fresh(len(output)), fresh(1)
    return [
        operator_cell(kind, result, signed=signed, A=left, B=right),
        operator_cell("$logic_not", by_zero, A=right),
        mux_cell(output, by_zero[0], result, fresh(len(output))),
    ]


def _mux4(gate: Gate, values: list[Bits], output: tuple[int, ...]) -> list[Cell]:
    gate.check([len(value) for value in values] == [2, *[gate.width] * 4])
    select, *choices = values
    low, high = gate.fresh(gate.width), gate.fresh(gate.width)
    return [
        mux_cell(low, select[0], choices[0], choices[1]),
        mux_cell(high, select[0], choices[2], choices[3]),
        mux_cell(output, select[1], low, high),
    ]


def _pmux(gate: Gate, values: list[Bits], output: tuple[int, ...]) -> list[Cell]:
    """Return a chain of multiplexers; at most one bit of the selector is 1."""
    select, default, *choices = values
    gate.check(len(select) == len(choices))
    gate.check(all(len(value) == gate.width for value in values[1:]))
    cells = []
    value = default
    for place, (bit, choice) in enumerate(zip(select, choices, strict=True)):
        last = place == len(choices) - 1
        target = output if last else gate.fresh(gate.width)
        cells.append(mux_cell(target, bit, value, choice))
        value = target
    return cells


def mux_cell(output: tuple[int, ...], select: Bit, low: Bits, high: Bits) -> Cell:
    """Return a multiplexer; the output is `high` if `select` is 1."""
    return Cell(
        kind="$mux",
        parameters={"WIDTH": len(output)},
        inputs={"A": low, "B": high, "S": (select,)},
        outputs={"Y": output},
    )


def operator_cell(
    kind: str,
    output: tuple[int, ...],
    *,
    signed: bool = False,
    second_signed: bool | None = None,
    **inputs: Bits,
) -> Cell:
    """Return an operator with the operands A and, if it has two, B.

    * `kind`: type of the cell in Yosys.
    * `signed`: the operands are signed.
    * `second_signed`: B is signed; `None`: B is as `signed` says.
    """
    parameters: dict[str, int | str] = {"Y_WIDTH": len(output)}
    for port, bits in inputs.items():
        parameters[f"{port}_WIDTH"] = len(bits)
        parameters[f"{port}_SIGNED"] = int(signed)
    if second_signed is not None:
        parameters["B_SIGNED"] = int(second_signed)
    return Cell(kind=kind, parameters=parameters, inputs=inputs, outputs={"Y": output})
