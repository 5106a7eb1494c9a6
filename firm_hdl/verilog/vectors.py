"""Keep a net in Verilog for each vector that is a concatenation of other signals.

In the netlist of Amaranth, such a vector is connected to a concatenation, or a process without
conditions assigns its parts. Yosys would replace the other signals by parts of the vector, and
write assignments to parts of several vectors. Tools that look at whole vectors would see loops:
Verilator warns of them, and simulates them slowly.
"""

from __future__ import annotations

import re

__all__ = ["whole_vectors"]

_MODULE = re.compile(r"(?=^module )", re.MULTILINE)
_WIDTH = re.compile(r"^  wire width (\d+) .*?(\\\S+)$", re.MULTILINE)
_CONNECTED = re.compile(r"^connect (\\\S+) (\{ .*\})$", re.MULTILINE)
_PROCESS = re.compile(
    r"^  process \S+\n    assign (\\\S+) \[(\d+):0\] \d+'([01]+)\n((?:    assign .*\n)+)  end$",
    re.MULTILINE,
)
_PART = re.compile(r"^    assign (\\\S+) \[(\d+)(?::(\d+))?\] (.*)$", re.MULTILINE)

# Yosys removes a buffer unless it is marked.
_BUFFER = """\
  attribute \\keep 1
  cell $buf $vector${number}
    parameter \\WIDTH {width}
    connect \\A {value}
    connect \\Y {name}
  end"""


def whole_vectors(design: str) -> str:
    """Connect vectors to concatenations through buffers.

    Parameters
    ----------
    design : str
        RTLIL, as Amaranth prints it.
    """
    return "".join(_buffered(part) for part in _MODULE.split(design))


def _buffered(module: str) -> str:
    widths = {name: int(width) for width, name in _WIDTH.findall(module)}

    def buffer(found: re.Match[str], name: str, value: str) -> str:
        if not widths.get(name):
            return found[0]
        return _BUFFER.format(number=found.start(), width=widths[name], value=value, name=name)

    def assigned(found: re.Match[str]) -> str:
        name, high, default, parts = found.groups()
        value = _joined(parts, default) if widths.get(name) == int(high) + 1 else None
        return buffer(found, name, value) if value else found[0]

    module = _PROCESS.sub(assigned, module)
    return _CONNECTED.sub(lambda found: buffer(found, found[1], found[2]), module)


def _joined(parts: str, default: str) -> str | None:
    """Return the concatenation of parts, or `None` if they overlap."""
    found = sorted(
        (int(low or high), int(high), value) for _, high, low, value in _PART.findall(parts)
    )
    pieces, at = [], 0
    for low, high, value in [*found, (len(default), len(default), "")]:
        if low < at:
            return None
        if low > at:
            bits = default[len(default) - low : len(default) - at]
            pieces.append(f"{len(bits)}'{bits}")
        pieces.append(value)
        at = high + 1
    # The last piece is the empty end mark.
    return f"{{ {' '.join(reversed(pieces[:-1]))} }}"
