"""A flat netlist as a module of Verilog, for Verilator, which has two values."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from itertools import count

from firm_hdl.equivalence.circuit import Bits, Cell, Circuit, Flop, ProofError

__all__ = ["verilog_of"]

_NUMBERED = re.compile(r"n\d+")

_BINARY = {
    "$and": "&",
    "$or": "|",
    "$xor": "^",
    "$xnor": "~^",
    "$add": "+",
    "$sub": "-",
    "$mul": "*",
    "$div": "/",
    "$mod": "%",
    "$eq": "==",
    "$ne": "!=",
    "$lt": "<",
    "$le": "<=",
    "$gt": ">",
    "$ge": ">=",
    "$shl": "<<",
    "$shr": ">>",
    "$sshr": ">>>",
}
_UNARY = {
    "$not": "~",
    "$neg": "-",
    "$reduce_and": "&",
    "$reduce_or": "|",
    "$reduce_xor": "^",
    "$logic_not": "!",
}


def verilog_of(circuit: Circuit, *, name: str, names: Mapping[str, str]) -> str:
    """Write a circuit as Verilog.

    * `name`: name of the module.
    * `names`: names of ports by those of the circuit.

    Raises `ProofError` if the circuit has a cell that is not known.
    """
    return "".join(f"{line}\n" for line in _Writer(circuit).lines(name, names))


class _Writer:
    def __init__(self, circuit: Circuit) -> None:
        self._circuit = circuit
        # The vector, and the place in it, of each net that something drives.
        self._places: dict[int, tuple[str, int, int]] = {}

    def _drive(self, name: str, bits: Bits) -> str:
        for place, bit in enumerate(bits):
            assert isinstance(bit, int)
            self._places[bit] = name, place, len(bits)
        return f"[{len(bits) - 1}:0] {name}"

    def _value(self, bits: Bits) -> str:
        """Return bits as parts of vectors, and constants. What nothing drives is 0."""
        parts: list[str] = []
        place = len(bits)
        while place:
            top = place - 1
            first = bits[top]
            if isinstance(first, str) or first not in self._places:
                text = ""
                while place and (isinstance(b := bits[place - 1], str) or b not in self._places):
                    text += b if isinstance(b, str) else "0"
                    place -= 1
                parts.append(f"{len(text)}'b{text}")
                continue
            name, high, width = self._places[first]
            low = high
            place -= 1
            while place and low and bits[place - 1] in self._places:
                bit = bits[place - 1]
                if not isinstance(bit, int) or self._places[bit][:2] != (name, low - 1):
                    break
                low, place = low - 1, place - 1
            is_whole = low == 0 and high == width - 1
            parts.append(name if is_whole else f"{name}[{high}:{low}]")
        return parts[0] if len(parts) == 1 else f"{{{', '.join(parts)}}}"

    def lines(self, name: str, names: Mapping[str, str]) -> Iterator[str]:
        circuit = self._circuit
        ports = [(names.get(p, p), bits) for p, bits in circuit.inputs.items()]
        outputs = [(names.get(p, p), bits) for p, bits in circuit.outputs.items()]
        heads = [f"  input wire {self._drive(port, bits)}" for port, bits in ports]
        heads += [f"  output wire [{len(bits) - 1}:0] {port}" for port, bits in outputs]
        taken = {port for port, _ in [*ports, *outputs]}
        fresh = (f"n{number}" for number in count() if f"n{number}" not in taken)
        yield f"module {name} ("
        yield ",\n".join(heads)
        yield ");"
        registers = [(next(fresh), group) for group in self._registers()]
        for register, group in registers:
            yield f"  reg {self._drive(register, tuple(group))};"
        cells = [(next(fresh), cell) for cell in circuit.cells]
        for wire, cell in cells:
            yield f"  wire {self._drive(wire, cell.outputs['Y'])};"
        for wire, cell in cells:
            yield f"  assign {wire} = {self._expression(cell)};"
        for register, group in registers:
            yield from self._register(register, group)
        for port, bits in outputs:
            yield f"  assign {port} = {self._value(bits)};"
        # Names for a waveform.
        named = {"_".join(path): bits for path, bits in circuit.signals.items()}
        for signal, bits in named.items():
            if bits and signal not in taken and not _NUMBERED.fullmatch(signal):
                yield f"  wire [{len(bits) - 1}:0] \\{signal}  = {self._value(bits)};"
        yield "endmodule"

    def _expression(self, cell: Cell) -> str:
        values = {port: self._value(bits) for port, bits in cell.inputs.items()}
        for port in ("A", "B"):
            if cell.parameters.get(f"{port}_SIGNED") and not cell.kind.startswith("$reduce"):
                values[port] = f"$signed({values[port]})"
        if cell.kind == "$mux":
            return f"{values['S']} ? {values['B']} : {values['A']}"
        if cell.kind in _UNARY:
            return f"{_UNARY[cell.kind]}{values['A']}"
        if cell.kind == "$modfloor":
            # The result has the sign of the divisor.
            a, b = values["A"], values["B"]
            zero = f"{len(cell.inputs['B'])}'sd0"
            differs = f"({a} % {b} != {zero}) && (({a} < {zero}) != ({b} < {zero}))"
            return f"{differs} ? {a} % {b} + {b} : {a} % {b}"
        if cell.kind not in _BINARY:
            raise ProofError(f"the netlist has {cell.kind}")
        return f"{values['A']} {_BINARY[cell.kind]} {values['B']}"

    def _registers(self) -> Iterator[dict[int, Flop]]:
        """Yield the bits of registers that change together, with consecutive numbers."""
        group: dict[int, Flop] = {}
        for bit, flop in sorted(self._circuit.flops.items()):
            if group:
                last, before = next(reversed(group.items()))
                if bit != last + 1 or _control(flop) != _control(before):
                    yield group
                    group = {}
            group[bit] = flop
        if group:
            yield group

    def _register(self, name: str, group: Mapping[int, Flop]) -> Iterator[str]:
        flops = list(group.values())
        width = len(flops)
        first = flops[0]
        data = self._value(tuple(flop.data for flop in flops))
        init = "".join("1" if flop.init == "1" else "0" for flop in reversed(flops))
        edge = f"{'posedge' if first.rising else 'negedge'} {self._value((first.clock,))}"
        yield f"  initial {name} = {width}'b{init};"
        if first.reset is None:
            yield f"  always @({edge}) {name} <= {data};"
            return
        reset = self._value((first.reset,))
        level = "" if first.reset_level else "!"
        value = "".join(flop.reset_value for flop in reversed(flops))
        side = "posedge" if first.reset_level else "negedge"
        yield f"  always @({edge} or {side} {reset})"
        yield f"    if ({level}{reset}) {name} <= {width}'b{value}; else {name} <= {data};"


def _control(flop: Flop) -> tuple[object, ...]:
    return flop.clock, flop.rising, flop.reset, flop.reset_level
