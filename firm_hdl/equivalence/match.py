"""Match the registers of the VHDL with those of the RTLIL.

The back end reports the names that it has given. They are only a guess. A wrong name can make a
proof fail, but not succeed: if a proof assumes that two registers are equal, it also proves that
they start equal and stay equal.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

from firm_hdl.vhdl.module import EntityNames

__all__ = ["Match", "match_names", "word_name"]

_Path: TypeAlias = tuple[str, ...]
_MODULE = re.compile(r"module \\(\S+)$")
_CELL = re.compile(r"cell \\(\S+) \\(\S+)$")
_MEMORY = re.compile(r"memory width \d+ size (\d+) \\(\S+)$")


@dataclass(frozen=True, slots=True, kw_only=True)
class Match:
    """The matching signals and memories; paths are without the outermost module."""

    # Paths of signals and of words of memories in VHDL by paths in the flattened RTLIL.
    signals: Mapping[_Path, _Path]
    memories: Mapping[_Path, int]  # Number of words by path of the memory in VHDL.


@dataclass(slots=True)
class _Module:
    """The modules of the instances in a module, and the sizes of its memories, by name."""

    cells: dict[str, str]
    memories: dict[str, int]


def word_name(memory: str, place: int) -> str:
    """Name a word of a memory."""
    return f"{memory}[{place}]"


def match_names(rtlil: str, top: str, entities: Mapping[str, EntityNames]) -> Match:
    """Match the signals and memories of both sides.

    * `rtlil`: RTLIL text; only its modules, instances and sizes of memories are read.
    * `top`: the outermost module.
    * `entities`: names in VHDL by module.
    """
    modules = _modules(rtlil)
    signals: dict[_Path, _Path] = {}
    memories: dict[_Path, int] = {}
    stack: list[tuple[str, _Path, _Path]] = [(top, (), ())]
    while stack:
        module, rtlil_path, vhdl_path = stack.pop()
        names = entities.get(module)
        if names is None:
            continue
        found = modules.get(module) or _Module({}, {})
        for wire, signal in names.signals.items():
            signals[(*rtlil_path, wire)] = (*vhdl_path, signal.lower())
        for memory, signal in names.memories.items():
            words = found.memories.get(memory, 0)
            memories[(*vhdl_path, signal.lower())] = words
            for place in range(words):
                word = (*vhdl_path, word_name(signal.lower(), place))
                signals[(*rtlil_path, word_name(memory, place))] = word
        for cell, kind in found.cells.items():
            label = names.instances.get(cell)
            if label is not None:
                stack.append((kind, (*rtlil_path, cell), (*vhdl_path, label.lower())))
    return Match(signals=signals, memories=memories)


def _modules(rtlil: str) -> dict[str, _Module]:
    found: dict[str, _Module] = {}
    inside = _Module({}, {})
    for line in rtlil.split("\n"):
        line = line.strip()
        if match := _MODULE.match(line):
            inside = found[match[1]] = _Module({}, {})
        elif match := _CELL.match(line):
            inside.cells[match[2]] = match[1]
        elif match := _MEMORY.match(line):
            inside.memories[match[2]] = int(match[1])
    return found
