"""Netlist values as VHDL expressions: signals, slices, concatenations, constants.

A value can be written as one of four types: `std_logic` (one bit), `unsigned` (one or more bits),
`signed`, or a `boolean` condition. Operators are in :mod:`firm_hdl.vhdl.cells`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from firm_hdl.rtlil.evaluate import constant
from firm_hdl.rtlil.ir import Bits, Cell, Chunk, Slice, Spec, bits_of, spec_width
from firm_hdl.vhdl.cells import Cells
from firm_hdl.vhdl.text import Expression, atom, bit_literal, call, chain, infix, literal
from firm_hdl.vhdl.uses import int_parameter, trim

__all__ = ["Declared", "Values", "short_constants"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Declared:
    """A signal or port; if `vector`, its type is `std_logic_vector`, and reads convert it."""

    name: str
    width: int
    vector: bool = False

    @property
    def type(self) -> str:
        """The subtype indication."""
        if self.width == 1:
            return "std_logic"
        return f"{'std_logic_vector' if self.vector else 'unsigned'}({self.width - 1} downto 0)"

    @property
    def zero(self) -> str:
        """The value 0."""
        return "'0'" if self.width == 1 else "(others => '0')"

    def part(self, low: int, width: int) -> str:
        """Name `width` bits from bit `low` up; for a vector, only as an assignment's target."""
        if width == self.width:
            return self.name
        if width == 1:
            return f"{self.name}({low})"
        return f"{self.name}({low + width - 1} downto {low})"

    def accept(self, value: Expression, width: int) -> str:
        """Write a value with the type that can be assigned to `width` of its bits."""
        if not self.vector or width == 1 or value.operator == "literal":
            return value.text
        # In VHDL, a type conversion does not determine the type of its operand.
        if value.operator == "&":
            return f"std_logic_vector(unsigned'({value.text}))"
        return f"std_logic_vector({value.text})"


class Values:
    """Writes the values of one module.

    `choice` names a value of a signal with an enumeration, and is empty for any other value.

    * `declared`: signals and ports by wire.
    * `folded`: wires that are written as the expression that drives them.
    * `width`: bits of each wire.
    """

    def __init__(
        self, declared: Mapping[str, Declared], folded: Mapping[str, Cell], width: Mapping[str, int]
    ) -> None:
        self._declared = declared
        self._folded = folded
        self._width = width
        self.choice: Callable[[Spec, str], str] = lambda spec, bits: ""
        self.cells = Cells(self)

    def width(self, wire: str) -> int:
        """Count the bits of a wire that are read."""
        return self._width[wire]

    def folded(self, spec: Spec) -> Cell | None:
        """Return the operator that computes the whole value, if its result has no signal."""
        if len(spec) == 1 and isinstance(spec[0], Slice):
            return self._folded.get(spec[0].wire)
        return None

    def is_name(self, spec: Spec) -> bool:
        """Return whether a value is a signal, or one slice of one."""
        return len(spec) == 1 and isinstance(spec[0], Slice) and self.folded(spec) is None

    def name(self, chunk: Chunk) -> str:
        """Name the bits of a signal."""
        assert isinstance(chunk, Slice) and chunk.wire not in self._folded
        return self._declared[chunk.wire].part(chunk.low, chunk.width)

    def is_vector(self, chunk: Chunk) -> bool:
        """Return whether a signal is a `std_logic_vector`, not `unsigned`."""
        return isinstance(chunk, Slice) and self._declared[chunk.wire].vector

    def logic(self, spec: Spec) -> Expression:
        """Write one bit as `std_logic`."""
        (chunk,) = spec
        if isinstance(chunk, Bits):
            return atom(bit_literal(chunk.text))
        cell = self._folded.get(chunk.wire)
        return self.cells.logic(cell) if cell is not None else atom(self.name(chunk))

    def boolean(self, spec: Spec) -> Expression:
        """Write one bit as a condition."""
        (chunk,) = spec
        if isinstance(chunk, Bits):
            return atom("true" if chunk.text == "1" else "false")
        cell = self._folded.get(chunk.wire)
        if cell is not None:
            return self.cells.boolean(cell)
        return infix("=", atom(self.name(chunk)), atom("'1'"))

    def unsigned(self, spec: Spec, width: int | None = None, *, target: bool = False) -> Expression:
        """Write a value as `unsigned`, zero-extended or cut to `width` bits.

        * `target`: whether the context gives the type, as in an assignment to a signal. If so, a
          concatenation needs no type qualification.
        """
        natural = spec_width(spec)
        if width is None:
            width = max(natural, 1)
        if width < natural:
            return self.unsigned(trim(spec, width), target=target)
        bits = bits_of(spec)
        if bits is not None:
            return _constant(bits.rjust(width, "0"), target=target)
        used, rest = spec, 0
        if isinstance(spec[-1], Bits) and "1" not in spec[-1].text and len(spec) > 1:
            used, rest = spec[:-1], spec[-1].width
        if natural == 1 or width > natural or rest:
            inner = self.logic(used) if spec_width(used) == 1 else self.unsigned(used)
            return call("resize", inner, width)
        return self._joined(spec, target)

    def signed(self, spec: Spec) -> Expression:
        """Write a value as `signed`."""
        return call("signed", self.unsigned(spec))

    def extended(self, spec: Spec, width: int, *, signed: bool) -> Expression:
        """Write a value as `unsigned` of `width` bits, extended according to its signedness."""
        natural = spec_width(spec)
        if not signed or natural == 0 or width <= natural:
            return self.unsigned(spec, width)
        bits = bits_of(spec)
        if bits is not None:
            return _constant(bits.rjust(width, bits[0]), target=False)
        if natural == 1:
            return call("repeat_bit", self.logic(spec), width)
        return call("sign_extend", self.unsigned(spec), width)

    def number(self, spec: Spec) -> Expression:
        """Write a value as a natural number, for an index or a distance."""
        value = self.constant(spec)
        if value is not None:
            return atom(str(value))
        if spec_width(spec) == 1:
            return call("to_integer", self.logic(spec))
        return call("to_integer", self.unsigned(spec))

    def edge(self, cell: Cell) -> str:
        """Write the clock edge of a cell as a condition."""
        function = "rising_edge" if int_parameter(cell, "CLK_POLARITY") else "falling_edge"
        return f"{function}({self.logic(cell.ports['CLK']).text})"

    def constant(self, spec: Spec, *, signed: bool = False) -> int | None:
        """Return the number of a constant value, else `None`."""
        return constant(spec, signed=signed)

    def _joined(self, spec: Spec, target: bool) -> Expression:
        parts: list[Expression] = []
        spec = tuple(short_constants(spec))
        index = len(spec) - 1
        while index >= 0:
            used, text = self._sign_run(spec, index)
            if not used:
                used, text = self._repeated(spec, index)
            if not used:
                used, text = 1, self._chunk(spec[index])
            parts.append(text)
            index -= used
        if len(parts) == 1:
            return parts[0]
        # Constants in front are joined from the right, as in `x"1" & (x"2" & signal)`: GHDL would
        # join them to a long one.
        first = next(k for k, chunk in enumerate(reversed(spec)) if isinstance(chunk, Slice))
        first = max(0, first - 1)
        joined = chain("&", *parts[first:])
        for part in reversed(parts[:first]):
            joined = infix("&", part, joined)
        return joined if target else atom(f"unsigned'({joined.text})")

    def _chunk(self, chunk: Chunk) -> Expression:
        if isinstance(chunk, Bits):
            return atom(bit_literal(chunk.text) if chunk.width == 1 else literal(chunk.text))
        cell = self._folded.get(chunk.wire)
        if cell is not None:
            return self.cells.logic(cell) if chunk.width == 1 else self.cells.unsigned(cell)
        name = atom(self.name(chunk))
        return call("unsigned", name) if self.is_vector(chunk) and chunk.width > 1 else name

    def _sign_run(self, spec: Spec, index: int) -> tuple[int, Expression]:
        """Recognize a sign extension: copies of the top bit, then the value with that top bit."""
        used = _run_length(spec, index)
        below = index - used
        top = spec[index]
        if below < 0 or not isinstance(top, Slice) or top.wire in self._folded:
            return 0, atom("")
        chunk = spec[below]
        if (
            not isinstance(chunk, Slice)
            or chunk.wire != top.wire
            or chunk.low + chunk.width - 1 != top.low
            or top.width != 1
        ):
            return 0, atom("")
        return used + 1, call("sign_extend", self._chunk(chunk), chunk.width + used)

    def _repeated(self, spec: Spec, index: int) -> tuple[int, Expression]:
        used = _run_length(spec, index)
        if used < 2 or spec[index].width != 1:
            return 0, atom("")
        return used, call("repeat_bit", self._chunk(spec[index]), used)


def short_constants(spec: Spec) -> Iterator[Chunk]:
    """Yield the chunks of a value, with constants other than 0 in pieces of at most 32 bits.

    GHDL 2.0 writes longer ones as strings in the Verilog of ``ghdl --synth``.
    """
    for chunk in spec:
        if isinstance(chunk, Bits) and "1" in chunk.text:
            text = chunk.text
            yield from (Bits(text[max(0, end - 32) : end]) for end in range(len(text), 0, -32))
        else:
            yield chunk


def _run_length(spec: Spec, index: int) -> int:
    """Count equal chunks from `index` down."""
    end = index
    while end >= 0 and spec[end] == spec[index]:
        end -= 1
    return index - end


def _constant(bits: str, *, target: bool) -> Expression:
    """Write a constant, qualified by its type unless the `target` determines the type."""
    if target:
        return Expression(literal(bits), "literal")
    if len(bits) > 8 and "1" not in bits:
        return call("to_unsigned", 0, len(bits))
    return atom(f"unsigned'({literal(bits)})")
