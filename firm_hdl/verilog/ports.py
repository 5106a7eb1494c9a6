"""Names for ports of submodules that have no name in Amaranth.

If the bits of a signal have several sources, such as a register and logic, Amaranth makes a port
for each part of the signal, with a number as its name. Here such a port gets the name of the
signal, with the index of the part's lowest bit, as in the VHDL.
"""

from __future__ import annotations

import re

from firm_hdl.names.identifiers import first_free

__all__ = ["named_ports"]

_CONNECTED = re.compile(r"^connect \\([A-Za-z_]\w*) \{ (.*) \}$", re.MULTILINE)
_CHUNK = re.compile(r"(\S+) \[(\d+)(?::(\d+))?\]|\d+'([01]+)")
_NUMBERED = re.compile(r"\\(port\$\d+\$\d+)(?=[\s\]])")
_IDENTIFIER = re.compile(r"\\(\S+)")


def named_ports(design: str) -> str:
    """Name ports after the signals of which they are parts.

    Parameters
    ----------
    design : str
        RTLIL, as Amaranth prints it.
    """
    used = {name.lower() for name in _IDENTIFIER.findall(design)}
    names: dict[str, str] = {}
    for signal, value in _CONNECTED.findall(design):
        place = 0
        for wire, high, low, bits in reversed(_CHUNK.findall(value)):
            port = wire.removeprefix("\\")
            if port.startswith("port$") and port not in names:
                names[port] = first_free(f"{signal}_{place}", used)
                used.add(names[port].lower())
            place += len(bits) or int(high) - int(low or high) + 1
    return _NUMBERED.sub(lambda found: f"\\{names.get(found[1], found[1])}", design)
