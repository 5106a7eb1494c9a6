"""Amaranth's memories as arrays: contents, write ports, read ports.

As in Amaranth's simulator, a read beyond the last word gives 0, and a write there has no effect. A
read register starts at 0. A port that is transparent for a write port reads the data being written.

Synthesis tools infer RAM from the form of the text. The memory is an array of vectors, even if a
word has one bit. Writes are in a clocked process. Reads are of whole words; asynchronous reads are
outside of the process.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from firm_hdl.rtlil.ir import Bits, Cell, Memory, Slice, Spec, bits_of, cut, spec_width
from firm_hdl.vhdl.expr import Declared, Values
from firm_hdl.vhdl.text import Expression, atom, chain, infix, literal
from firm_hdl.vhdl.uses import enable_runs, int_parameter

__all__ = ["MemoryText", "memory_id"]


def memory_id(cell: Cell) -> str:
    """Name the memory that a port belongs to."""
    return str(cell.parameters["MEMID"]).removeprefix("\\")


class MemoryText:
    """Writes one memory.

    * `name`: identifier of the signal; the name of its type is derived from it.
    * `ports`: cells of the memory's ports and contents.
    * `targets`: signals that read ports drive.
    """

    def __init__(
        self,
        memory: Memory,
        name: str,
        ports: Sequence[Cell],
        values: Values,
        targets: Mapping[str, Declared],
    ) -> None:
        self.memory = memory
        self.name = name
        self.values = values
        self.targets = targets
        self.writes = [cell for cell in ports if cell.kind == "$memwr_v2"]
        self.reads = [cell for cell in ports if cell.kind == "$memrd_v2"]
        self.contents = [cell for cell in ports if cell.kind == "$meminit_v2"]

    @property
    def type_name(self) -> str:
        """The array type."""
        return f"{self.name}_array"

    def declarations(self) -> Iterator[str]:
        """Yield lines for the declarative part."""
        width = self.memory.width
        element = f"unsigned({width - 1} downto 0)"
        yield f"type {self.type_name} is array (0 to {self.memory.size - 1}) of {element};"
        words = self.words()
        zero = "(others => '0')"
        used = [(i, word) for i, word in enumerate(words) if "1" in word]
        if not used:
            yield f"signal {self.name} : {self.type_name} := (others => {zero});"
            return
        yield f"signal {self.name} : {self.type_name} := ("
        for i, word in used:
            last = i == self.memory.size - 1 == len(used) - 1
            yield f"  {i} => {literal(word)}{'' if last else ','}"
        if len(used) < self.memory.size:
            yield f"  others => {zero}"
        yield ");"

    def words(self) -> list[str]:
        width, words = self.memory.width, []
        for cell in self.contents:
            bits = bits_of(cell.ports["DATA"]) or ""
            if "1" not in bits:
                # A memory of a megabyte is not cut into words.
                continue
            words = [bits[end - width : end] for end in range(len(bits), 0, -width)]
        return words

    def processes(self) -> Iterator[str]:
        """Yield lines for the architecture body."""
        # One process for all write ports: of two that write a word at once, the later statement
        # counts, and so the port with the higher number.
        if self.writes:
            clocks = dict.fromkeys(
                self.values.logic(cell.ports["CLK"]).text for cell in self.writes
            )
            yield f"process ({', '.join(clocks)})"
            yield "begin"
            edges: dict[str, list[Cell]] = {}
            for cell in self.writes:
                edges.setdefault(self.values.edge(cell), []).append(cell)
            for condition, cells in edges.items():
                yield f"  if {condition} then"
                yield from (f"    {line}" for cell in cells for line in self._write(cell))
                yield "  end if;"
            yield "end process;"
        for cell in self.reads:
            yield ""
            if int_parameter(cell, "CLK_ENABLE"):
                yield from self._clocked_read(cell)
            else:
                yield self._direct_read(cell)

    def guard(self, address: Spec) -> Expression | None:
        """Write the test that an address is in range, unless all addresses are."""
        if self.memory.size >= 1 << spec_width(address):
            return None
        constant = self.values.constant(address)
        if constant is not None:
            return None if constant < self.memory.size else atom("false")
        return infix("<", self.values.unsigned(address), atom(str(self.memory.size)))

    def _word(self, address: Spec) -> str:
        constant = self.values.constant(address)
        # The guard of a constant address out of range is false, but VHDL checks the index anyway.
        number = "0" if (constant or 0) >= self.memory.size else self.values.number(address).text
        return f"{self.name}({number})"

    def _read_word(self, address: Spec) -> Expression:
        """Write the value of a word; like every value of one bit, a one-bit word is `std_logic`."""
        return atom(self._word(address) + ("(0)" if self.memory.width == 1 else ""))

    def _write(self, cell: Cell) -> Iterator[str]:
        address, data = cell.ports["ADDR"], cell.ports["DATA"]
        guard = self.guard(address)
        for bit, low, width in enable_runs(cell.ports["EN"]):
            if isinstance(bit, Bits) and bit.text != "1":
                continue
            tests = [] if isinstance(bit, Bits) else [self.values.boolean((bit,))]
            tests += [guard] if guard else []
            part = cut(data, low, width)
            value = (
                self.values.logic(part) if width == 1 else self.values.unsigned(part, target=True)
            )
            line = f"{self._word(address)} <= (0 => {value.text});"
            if self.memory.width > 1:
                target = Declared(name=self._word(address), width=self.memory.width)
                line = f"{target.part(low, width)} <= {value.text};"
            if tests:
                yield f"if {chain('and', *tests).text} then"
                yield f"  {line}"
                yield "end if;"
            else:
                yield line

    def _direct_read(self, cell: Cell) -> str:
        target, address = self.target(cell), cell.ports["ADDR"]
        guard = self.guard(address)
        word = target.accept(self._read_word(address), target.width)
        if guard is None:
            return f"{target.name} <= {word};"
        return f"{target.name} <= {word} when {guard.text} else {target.zero};"

    def _clocked_read(self, cell: Cell) -> Iterator[str]:
        enable = cell.ports["EN"]
        yield f"process ({self.values.logic(cell.ports['CLK']).text})"
        yield "begin"
        yield f"  if {self.values.edge(cell)} then"
        constant = self.values.constant(enable)
        if constant is None:
            yield f"    if {self.values.boolean(enable).text} then"
            yield from (f"      {line}" for line in self._read_statements(cell))
            yield "    end if;"
        elif constant:
            yield from (f"    {line}" for line in self._read_statements(cell))
        yield "  end if;"
        yield "end process;"

    def _read_statements(self, cell: Cell) -> Iterator[str]:
        target, address = self.target(cell), cell.ports["ADDR"]
        guard = self.guard(address)
        line = f"{target.name} <= {target.accept(self._read_word(address), target.width)};"
        if guard is None:
            yield line
        else:
            yield f"if {guard.text} then"
            yield f"  {line}"
            yield "else"
            yield f"  {target.name} <= {target.zero};"
            yield "end if;"
        mask = int_parameter(cell, "TRANSPARENCY_MASK")
        for write in self.writes:
            if mask >> int_parameter(write, "PORTID") & 1:
                yield from self._bypass(cell, write)

    def _bypass(self, cell: Cell, write: Cell) -> Iterator[str]:
        target, values = self.target(cell), self.values
        read_at, write_at = cell.ports["ADDR"], write.ports["ADDR"]
        same: list[Expression] = []
        if values.constant(read_at) is not None and values.constant(write_at) is not None:
            if values.constant(read_at) != values.constant(write_at):
                return
        elif spec_width(read_at) == 1:
            same = [infix("=", values.logic(read_at), values.logic(write_at))]
        else:
            same = [infix("=", values.unsigned(read_at), values.unsigned(write_at))]
        for bit, low, width in enable_runs(write.ports["EN"]):
            if isinstance(bit, Bits) and bit.text != "1":
                continue
            tests = same + ([] if isinstance(bit, Bits) else [values.boolean((bit,))])
            part = cut(write.ports["DATA"], low, width)
            value = values.logic(part) if width == 1 else values.unsigned(part, target=True)
            line = f"{target.part(low, width)} <= {target.accept(value, width)};"
            if tests:
                yield f"if {chain('and', *tests).text} then  -- transparent"
                yield f"  {line}"
                yield "end if;"
            else:
                yield line

    def target(self, cell: Cell) -> Declared:
        (chunk,) = cell.ports["DATA"]
        assert isinstance(chunk, Slice)
        return self.targets[chunk.wire]
