"""Match the registers of the VHDL with those of the RTLIL.

The back end reports the names that it has given. They are only a guess: a wrong one makes a proof
fail, never succeed, because a proof that assumes two registers to be equal also proves that they
start equal and stay equal.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Protocol

__all__ = ["Names", "vhdl_paths"]

_MODULE = re.compile(r"module \\(\S+)$")
_CELL = re.compile(r"cell \\(\S+) \\(\S+)$")


class Names(Protocol):
    """The names of one module in VHDL; see `firm_hdl.vhdl.convert.EntityNames`."""

    @property
    def signals(self) -> Mapping[str, str]:
        """Names of signals, by wire of the RTLIL."""

    @property
    def instances(self) -> Mapping[str, str]:
        """Labels of instances, by cell of the RTLIL."""


def vhdl_paths(
    rtlil: str, top: str, entities: Mapping[str, Names]
) -> Mapping[tuple[str, ...], tuple[str, ...]]:
    """Return paths of signals in VHDL by paths in the flattened RTLIL; both without the top.

    Parameters
    ----------
    rtlil : str
        RTLIL text; only its modules and instances are read.
    top : str
        The outermost module.
    entities : mapping of str to Names
        Names in VHDL by module.
    """
    cells = _instances(rtlil)
    paths: dict[tuple[str, ...], tuple[str, ...]] = {}
    stack: list[tuple[str, tuple[str, ...], tuple[str, ...]]] = [(top, (), ())]
    while stack:
        module, rtlil_path, vhdl_path = stack.pop()
        names = entities.get(module)
        if names is None:
            continue
        for wire, signal in names.signals.items():
            paths[(*rtlil_path, wire)] = (*vhdl_path, signal.lower())
        for cell, kind in cells.get(module, {}).items():
            label = names.instances.get(cell)
            if label is not None:
                stack.append((kind, (*rtlil_path, cell), (*vhdl_path, label.lower())))
    return paths


def _instances(rtlil: str) -> dict[str, dict[str, str]]:
    """Return, for each module, the modules of its instances by the instance's name."""
    found: dict[str, dict[str, str]] = {}
    inside: dict[str, str] = {}
    for line in rtlil.split("\n"):
        line = line.strip()
        if match := _MODULE.match(line):
            inside = found[match[1]] = {}
        elif match := _CELL.match(line):
            inside[match[2]] = match[1]
    return found
