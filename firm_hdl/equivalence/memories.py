"""Memories of the RTLIL as registers: one register per word, and multiplexers for the ports.

RTLIL leaves three things open. Here they are as in Amaranth's simulator: a read beyond the last
word gives 0; if two ports write one word at the same time, the port with the higher number wins;
the register of a synchronous read port starts at 0.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from firm_hdl.equivalence.circuit import Bit, Bits, Cell, Flop, ProofError
from firm_hdl.equivalence.gates import mux_cell, operator_cell

__all__ = ["MemoryCircuit", "memory_of"]

_Fresh = Callable[[int], tuple[int, ...]]
_Read = Callable[[Sequence[Bit]], Bits]
_Nets = Mapping[str, Bits]
_Port = tuple[Mapping[str, str], _Nets]
"""Parameters and connections of a port."""

_KINDS = frozenset("$meminit_v2 $memwr_v2 $memrd_v2".split())


def memory_of(cell: Mapping[str, Any]) -> str | None:
    """Return the memory of a cell that is a port or the contents of a memory, else `None`."""
    if cell["type"] not in _KINDS:
        return None
    return str(cell["parameters"]["MEMID"]).removeprefix("\\")


@dataclass(slots=True)
class MemoryCircuit:
    """The registers and gates of one memory.

    * `name`: name in the flattened design, for messages.
    * `width`, `depth`: bits per word, and number of words.
    * `fresh`: makes new nets.
    """

    name: str
    width: int
    depth: int
    fresh: _Fresh
    # The words; constants if the memory has no write port.
    words: list[Bits] = field(default_factory=list)
    # The data of each read port that has a register.
    reads: list[Bits] = field(default_factory=list)
    # As in `Circuit`.
    cells: list[Cell] = field(default_factory=list)
    flops: dict[int, Flop] = field(default_factory=dict)

    def add(self, cells: Sequence[Mapping[str, Any]], bits: _Read) -> None:
        """Add the contents and all ports.

        * `cells`: the cells of the memory, as Yosys writes them in JSON.
        * `bits`: returns the bits of a port, with a new net for each undefined bit.
        """
        init = self._contents([cell for cell in cells if cell["type"] == "$meminit_v2"])
        writes = sorted(self._ports(cells, "$memwr_v2", bits), key=_number)
        self._check(
            [_number(port) for port in writes] == list(range(len(writes))),
            "write ports without consecutive numbers",
        )
        self.words = [
            self.fresh(self.width)
            if writes
            else bits(init[place * self.width : (place + 1) * self.width])
            for place in range(self.depth)
        ]
        if writes:
            self._write(writes, init)
        for parameters, ports in self._ports(cells, "$memrd_v2", bits):
            self._read(parameters, ports, [write for _, write in writes])

    def _check(self, holds: bool, what: str) -> None:
        if not holds:
            raise ProofError(f"memory {self.name} has {what}, which a proof does not support")

    def _ports(self, cells: Sequence[Mapping[str, Any]], kind: str, bits: _Read) -> list[_Port]:
        """Return the ports of one kind."""
        found = [cell for cell in cells if cell["type"] == kind]
        for cell in found:
            self._check(int(cell["parameters"]["WIDTH"], 2) == self.width, "ports of two widths")
        return [
            (cell["parameters"], {name: bits(net) for name, net in cell["connections"].items()})
            for cell in found
        ]

    def _contents(self, cells: Sequence[Mapping[str, Any]]) -> str:
        """Return the initial contents, the lowest bit of the first word first."""
        if not cells:
            return "x" * (self.width * self.depth)
        ports = cells[0]["connections"]
        data = "".join(str(bit) for bit in ports["DATA"])
        whole = len(cells) == 1 and len(data) == self.width * self.depth
        self._check(whole and set(ports["EN"]) <= {"1"}, "contents in parts")
        self._check(set(ports["ADDR"]) <= {"0"}, "contents in parts")
        self._check(set(data) <= set("01x"), "contents that are not constant")
        return data

    def _write(self, writes: Sequence[_Port], init: str) -> None:
        """Make a register of each word; the last port that writes a bit determines the bit."""
        clocks = {(ports["CLK"], parameters["CLK_POLARITY"]) for parameters, ports in writes}
        self._check(len(clocks) == 1, "write ports with several clocks")
        ((clock,), polarity) = clocks.pop()
        for parameters, _ in writes:
            self._check(int(parameters["CLK_ENABLE"], 2) == 1, "a write port without a clock")
        for place, word in enumerate(self.words):
            data = word
            for _, ports in writes:
                here = self._is_at(ports["ADDR"], place)
                data = self._lanes(data, ports["DATA"], ports["EN"], here)
            for lane, bit in enumerate(word):
                assert isinstance(bit, int)
                self.flops[bit] = Flop(
                    data=data[lane],
                    clock=clock,
                    rising=bool(int(polarity, 2)),
                    init=init[place * self.width + lane],
                )

    def _lanes(self, old: Bits, new: Bits, enables: Bits, here: Bit) -> Bits:
        """Replace the enabled lanes of a word if `here`: the port writes to the word's address."""
        result: list[Bit] = []
        low = 0
        for high in range(1, self.width + 1):
            if high < self.width and enables[high] == enables[low]:
                continue
            select = self._operator("$and", (here,), (enables[low],))
            lane = self.fresh(high - low)
            self.cells.append(mux_cell(lane, select, old[low:high], new[low:high]))
            result += lane
            low = high
        return tuple(result)

    def _read(self, parameters: Mapping[str, str], ports: _Nets, writes: Sequence[_Nets]) -> None:
        output = tuple(bit for bit in ports["DATA"] if isinstance(bit, int))
        self._check(len(output) == self.width, "a read port without data")
        self._check((ports["ARST"], ports["SRST"]) == (("0",), ("0",)), "a read port with a reset")
        self._check("1" not in parameters["COLLISION_X_MASK"], "a read port with collisions")
        value = self._selected(ports["ADDR"])
        mask = parameters["TRANSPARENCY_MASK"][::-1]
        for write, transparent in zip(writes, mask, strict=False):
            if transparent == "1":
                same = self._equal(ports["ADDR"], write["ADDR"])
                value = self._lanes(value, write["DATA"], write["EN"], same)
        if not int(parameters["CLK_ENABLE"], 2):
            self._check("1" not in mask, "a transparent read port without a clock")
            self.cells.append(mux_cell(output, "1", value, value))
            return
        data = self.fresh(self.width)
        self.cells.append(mux_cell(data, ports["EN"][0], output, value))
        self.reads.append(output)
        for place, bit in enumerate(output):
            self.flops[bit] = Flop(
                data=data[place],
                clock=ports["CLK"][0],
                rising=bool(int(parameters["CLK_POLARITY"], 2)),
                init=parameters["INIT_VALUE"].replace("x", "0")[::-1][place],
            )

    def _selected(self, address: Bits) -> Bits:
        """Return the word at an address; 0 beyond the last word."""
        zero: Bits = ("0",) * self.width
        layer = list(self.words) or [zero]
        for bit in address:
            layer += [zero] * (len(layer) % 2)
            pairs = zip(layer[::2], layer[1::2], strict=True)
            layer = [self._mux(bit, low, high) for low, high in pairs]
        self._check(len(layer) == 1, "more words than its addresses reach")
        return layer[0]

    def _mux(self, select: Bit, low: Bits, high: Bits) -> Bits:
        output = self.fresh(self.width)
        self.cells.append(mux_cell(output, select, low, high))
        return output

    def _is_at(self, address: Bits, place: int) -> Bit:
        if place >> len(address):
            return "0"
        return self._equal(address, tuple("01"[place >> n & 1] for n in range(len(address))))

    def _equal(self, left: Bits, right: Bits) -> Bit:
        width = max(len(left), len(right))
        if not width:
            return "1"
        left += ("0",) * (width - len(left))
        right += ("0",) * (width - len(right))
        return self._operator("$eq", left, right)

    def _operator(self, kind: str, left: Bits, right: Bits) -> Bit:
        (output,) = self.fresh(1)
        self.cells.append(operator_cell(kind, (output,), A=left, B=right))
        return output


def _number(port: _Port) -> int:
    return int(port[0]["PORTID"], 2)
