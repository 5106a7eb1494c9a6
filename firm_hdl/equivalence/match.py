"""Which register of the VHDL is which of Amaranth's.

The back end tells what it has called everything. That is taken as a guess: a wrong one makes a
proof fail, never succeed, because a proof that assumes two registers equal also proves that they
start equal and stay so.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Protocol

__all__ = ["Names", "vhdl_paths"]

_MODULE = re.compile(r"module \\(\S+)$")
_CELL = re.compile(r"cell \\(\S+) \\(\S+)$")


class Names(Protocol):
    """What one module's things are called in VHDL; see `firm_hdl.vhdl.convert.EntityNames`."""

    @property
    def signals(self) -> Mapping[str, str]:
        """Signals by wire."""

    @property
    def instances(self) -> Mapping[str, str]:
        """Labels by cell."""


def vhdl_paths(
    rtlil: str, top: str, entities: Mapping[str, Names]
) -> Mapping[tuple[str, ...], tuple[str, ...]]:
    """Give paths of signals in VHDL by paths in the flattened RTLIL; both without the top.

    Parameters
    ----------
    rtlil : str
        Its modules and instances are all that is looked at.
    top : str
        The outermost module.
    entities : mapping of str to Names
        By module.
    """
    cells = _instances(rtlil)
    paths: dict[tuple[str, ...], tuple[str, ...]] = {}
    stack: list[tuple[str, tuple[str, ...], tuple[str, ...]]] = [(top, (), ())]
    while stack:
        module, here, there = stack.pop()
        names = entities.get(module)
        if names is None:
            continue
        for wire, signal in names.signals.items():
            paths[(*here, wire)] = (*there, signal.lower())
        for cell, kind in cells.get(module, {}).items():
            label = names.instances.get(cell)
            if label is not None:
                stack.append((kind, (*here, cell), (*there, label.lower())))
    return paths


def _instances(rtlil: str) -> dict[str, dict[str, str]]:
    """Find the modules that each module has instances of, by the instance's name."""
    found: dict[str, dict[str, str]] = {}
    inside: dict[str, str] = {}
    for line in rtlil.split("\n"):
        line = line.strip()
        if match := _MODULE.match(line):
            inside = found[match[1]] = {}
        elif match := _CELL.match(line):
            inside[match[2]] = match[1]
    return found
