"""Memories: properties that RTLIL leaves open, and initial values in Verilog."""

from __future__ import annotations

import re

__all__ = ["settled_memories", "with_initials"]

MOST_LINES = 64
"""Words of a memory up to which each has a line of its own."""

_INIT_OF_READ = re.compile(r"(?<=^    parameter \\INIT_VALUE )(\d+)'x+$", re.MULTILINE)
_WRITE = re.compile(r"^  cell \$memwr_v2 .*?^  end$", re.MULTILINE | re.DOTALL)
_MEMORY = re.compile(r'parameter \\MEMID "(.*)"$', re.MULTILINE)
_NUMBER = re.compile(r"parameter \\PORTID (\d+)$", re.MULTILINE)
_CLOCK = re.compile(r"connect \\CLK .*$|parameter \\CLK_POLARITY .*$", re.MULTILINE)
_PRIORITY = re.compile(r"(?<=parameter \\PRIORITY_MASK )0$", re.MULTILINE)

_ZEROS = re.compile(
    r"^  cell \$meminit_v2 [^\n]*\n(?:    [^\n]*\n)*?    parameter \\WORDS (\d+)\n"
    r"(?:    [^\n]*\n)*?    connect \\DATA \d+'0+\n(?:    [^\n]*\n)*  end\n",
    re.MULTILINE,
)
# The declaration of a memory without initial values.
_DECLARED = re.compile(
    r"^  reg \[(\d+):0\] (\w+|\\\S+ ) \[(\d+):0\];\n(?!  initial begin\n)", re.MULTILINE
)


def settled_memories(design: str) -> str:
    """Determine the initial values of read ports, and the order of write ports.

    Large memories whose words are all 0 lose their initial values, which :func:`with_initials`
    writes: Yosys would hold and print every word.

    The register of a read port starts at 0. If ports of one clock write the same word at the same
    time, the port with the highest number writes last. Without this order, Yosys would write
    processes that a simulator may run in any order.

    Parameters
    ----------
    design : str
        RTLIL, as Amaranth prints it.
    """
    design = _ZEROS.sub(lambda cell: "" if int(cell[1]) > MOST_LINES else cell[0], design)
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


def with_initials(text: str) -> str:
    """Set all words of the memories without initial values to 0, in a loop.

    Parameters
    ----------
    text : str
        Verilog, as Yosys prints it.
    """
    ending = "start"
    while f"_{ending} " in text:
        ending += "_"

    def initial(found: re.Match[str]) -> str:
        width, name, count = int(found[1]) + 1, found[2], int(found[3]) + 1
        plain = re.sub(r"\W", "__", name.strip("\\ "))
        zero, at = f"{width}'h{'0' * -(-width // 4)}" if width != 32 else "32'd0", f"{plain}_at"
        return (
            f"{found[0]}  initial begin : {plain}_{ending}\n    integer {at};\n"
            f"    for ({at} = 0; {at} < {count}; {at} = {at} + 1) {name}[{at}] = {zero};\n  end\n"
        )

    return _DECLARED.sub(initial, text)
