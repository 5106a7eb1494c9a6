"""Names that look like an element of another signal.

Amaranth names the elements of arrays: beside a signal ``data`` of 64 bits, there is ``data[1]`` of
eight. Yosys, at least up to version 0.70, calls bit 1 of ``data`` by the same name when ABC
returns a circuit (synth_ecp5, synth_ice40 and others). Then it stops with a failed assertion
(YosysHQ/yosys#4349), or connects both without a message: the circuit is wrong.
"""

from __future__ import annotations

import re

from firm_hdl.names.identifiers import first_free

__all__ = ["without_indices"]

_IDENTIFIER = re.compile(r"\\(\S+)")
_INDEXED = re.compile(r"\\(\S*\[\S*)")


def without_indices(design: str) -> str:
    """Rename ``data[1]`` to ``data_1``, in all modules.

    * `design`: RTLIL, as Amaranth prints it. An index in brackets after a space is not part of a
      name.
    """
    used = {name.lower() for name in _IDENTIFIER.findall(design)}
    names: dict[str, str] = {}
    for name in _INDEXED.findall(design):
        if name not in names:
            names[name] = first_free(name.replace("[", "_").replace("]", ""), used)
            used.add(names[name].lower())
    return _INDEXED.sub(lambda found: f"\\{names[found[1]]}", design)
