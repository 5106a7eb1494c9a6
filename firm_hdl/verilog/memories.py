"""Memories: properties that RTLIL leaves open, and initial values in Verilog."""

from __future__ import annotations

import re

__all__ = ["settled_memories", "short_initials"]

MOST_LINES = 64
"""Words of a memory up to which each has a line of its own."""

_INIT_OF_READ = re.compile(r"(?<=^    parameter \\INIT_VALUE )(\d+)'x+$", re.MULTILINE)
_WRITE = re.compile(r"^  cell \$memwr_v2 .*?^  end$", re.MULTILINE | re.DOTALL)
_MEMORY = re.compile(r'parameter \\MEMID "(.*)"$', re.MULTILINE)
_NUMBER = re.compile(r"parameter \\PORTID (\d+)$", re.MULTILINE)
_CLOCK = re.compile(r"connect \\CLK .*$|parameter \\CLK_POLARITY .*$", re.MULTILINE)
_PRIORITY = re.compile(r"(?<=parameter \\PRIORITY_MASK )0$", re.MULTILINE)

_INITIALS = re.compile(
    r"^  initial begin\n    (\w+)\[0\] = (\d+'h0+);\n((?:    \1\[\d+\] = \2;\n)*)  end\n",
    re.MULTILINE,
)


def settled_memories(design: str) -> str:
    """Determine the initial values of read ports, and the order of write ports.

    The register of a read port starts at 0. If ports of one clock write the same word at the same
    time, the port with the highest number writes last. Without this order, Yosys would write
    processes that a simulator may run in any order.

    Parameters
    ----------
    design : str
        RTLIL, as Amaranth prints it.
    """
    design = _INIT_OF_READ.sub(lambda width: f"{width[1]}'{'0' * int(width[1])}", design)
    parts = re.split(r"(?=^module )", design, flags=re.MULTILINE)
    return "".join(_ordered(part) for part in parts)


def _ordered(module: str) -> str:
    """Give the write ports of one module their order."""
    clocks: dict[tuple[str, int], list[str]] = {}
    for cell in _WRITE.findall(module):
        clocks[_port(cell)] = _CLOCK.findall(cell)

    def ordered(cell: re.Match[str]) -> str:
        memory, number = _port(cell[0])
        same = [clocks[memory, other] == clocks[memory, number] for other in range(number)]
        mask = "".join(str(int(each)) for each in reversed(same))
        return _PRIORITY.sub(f"{number}'{mask}" if number else "0", cell[0])

    return _WRITE.sub(ordered, module)


def _port(cell: str) -> tuple[str, int]:
    memory, number = _MEMORY.search(cell), _NUMBER.search(cell)
    assert memory and number
    return memory[1], int(number[1])


def short_initials(text: str) -> str:
    """Replace the lines that set all words of a large memory to 0 by a loop.

    Parameters
    ----------
    text : str
        Verilog, as Yosys prints it: a line for each word.
    """
    ending = "start"
    while f"_{ending} " in text:
        ending += "_"

    def loop(found: re.Match[str]) -> str:
        name, zero, count = found[1], found[2], found[3].count("\n") + 1
        if count <= MOST_LINES:
            return found[0]
        at = f"{name}_at"
        return (
            f"  initial begin : {name}_{ending}\n    integer {at};\n"
            f"    for ({at} = 0; {at} < {count}; {at} = {at} + 1) {name}[{at}] = {zero};\n  end\n"
        )

    return _INITIALS.sub(loop, text)
