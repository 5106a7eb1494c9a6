"""RTLIL as data: modules of wires, cells, processes, memories and connections.

The names are those of Yosys. A value is a signal specification: chunks of wires and constants, the
least significant chunk first.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import wraps
from typing import Any, TypeAlias, TypeVar

__all__ = [
    "Assign",
    "Bits",
    "Case",
    "Cell",
    "Chunk",
    "Design",
    "Memory",
    "Module",
    "Process",
    "Slice",
    "Spec",
    "Statement",
    "Switch",
    "Value",
    "Wire",
    "bits_of",
    "cut",
    "join",
    "once_per_module",
    "spec_width",
]


@dataclass(frozen=True, slots=True)
class Bits:
    """A constant; `text` has one of ``0 1 x z -`` per bit, the most significant bit first."""

    text: str

    @property
    def width(self) -> int:
        """Number of bits."""
        return len(self.text)


@dataclass(frozen=True, slots=True)
class Slice:
    """`width` bits of a wire from bit `low` up; `bare` if the text has the wire's name alone."""

    wire: str
    low: int
    width: int
    bare: bool = field(default=False, compare=False)


Chunk: TypeAlias = Bits | Slice
# Least significant chunk first, which is the reverse of the order in the text.
Spec: TypeAlias = tuple[Chunk, ...]
Value: TypeAlias = int | float | str | Bits


def spec_width(spec: Spec) -> int:
    """Count the bits of a signal specification."""
    return spec[0].width if len(spec) == 1 else sum(chunk.width for chunk in spec)


def bits_of(spec: Spec) -> str | None:
    """Return the bits of a constant, the most significant first, or `None` for any other value."""
    text = ""
    for chunk in spec:
        if not isinstance(chunk, Bits):
            return None
        text = chunk.text + text
    return text


def cut(spec: Spec, low: int, width: int) -> Spec:
    """Take `width` bits of a value from bit `low` up."""
    if low == 0 and len(spec) == 1 and 0 < spec[0].width <= width:
        return spec
    result: list[Chunk] = []
    position = 0
    for chunk in spec:
        start, stop = max(low, position), min(low + width, position + chunk.width)
        if start < stop:
            if stop - start == chunk.width:
                result.append(chunk)
            elif isinstance(chunk, Slice):
                result.append(Slice(chunk.wire, chunk.low + start - position, stop - start))
            else:
                end = chunk.width - (start - position)
                result.append(Bits(chunk.text[end - (stop - start) : end]))
        position += chunk.width
    return tuple(result)


def join(*specs: Spec) -> Spec:
    """Concatenate values, the least significant first; neighbouring chunks become one."""
    result: list[Chunk] = []
    for chunk in (chunk for spec in specs for chunk in spec if chunk.width):
        last = result[-1] if result else None
        if isinstance(last, Bits) and isinstance(chunk, Bits):
            result[-1] = Bits(chunk.text + last.text)
        elif (
            isinstance(last, Slice)
            and isinstance(chunk, Slice)
            and last.wire == chunk.wire
            and last.low + last.width == chunk.low
        ):
            result[-1] = Slice(last.wire, last.low, last.width + chunk.width)
        else:
            result.append(chunk)
    return tuple(result)


@dataclass(frozen=True, slots=True, kw_only=True)
class Wire:
    """A wire; `direction` is ``input``, ``output``, ``inout``, or `None` if it is not a port."""

    name: str
    width: int
    signed: bool
    direction: str | None
    attributes: Mapping[str, Value]


@dataclass(frozen=True, slots=True, kw_only=True)
class Memory:
    """A memory of `size` words of `width` bits; its ports and contents are cells."""

    name: str
    width: int
    size: int
    attributes: Mapping[str, Value]


@dataclass(frozen=True, slots=True, kw_only=True)
class Cell:
    """A primitive (`kind` starts with ``$``) or an instance of a module."""

    kind: str
    name: str
    parameters: Mapping[str, Value]
    ports: Mapping[str, Spec]
    attributes: Mapping[str, Value]
    line: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Assign:
    """An assignment in a process; it overrides earlier ones."""

    target: Spec
    value: Spec


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """One arm of a switch; the default arm has no patterns."""

    patterns: tuple[str, ...]
    body: tuple[Statement, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Switch:
    """A choice: the first case with a pattern that matches `selector` is taken."""

    selector: Spec
    cases: tuple[Case, ...]


Statement: TypeAlias = Assign | Switch


@dataclass(frozen=True, slots=True, kw_only=True)
class Process:
    """Combinational assignments; the first assignment to a target is its default."""

    name: str
    body: tuple[Statement, ...]
    line: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Module:
    """One module. Names have no leading backslash; generated names keep their ``$``.

    `memo` has what several writers need and is computed once, see :func:`once_per_module`.
    """

    name: str
    attributes: Mapping[str, Value]
    wires: Mapping[str, Wire]
    memories: Mapping[str, Memory]
    items: tuple[Cell | Process, ...]
    connections: tuple[tuple[Spec, Spec], ...]
    memo: dict[object, Any] = field(init=False, default_factory=dict, compare=False, repr=False)


_Found = TypeVar("_Found")


def once_per_module(function: Callable[[Module], _Found]) -> Callable[[Module], _Found]:
    """Compute a function of a module once, as long as the module lives."""

    @wraps(function)
    def kept(module: Module) -> _Found:
        if function not in module.memo:
            module.memo[function] = function(module)
        found: _Found = module.memo[function]
        return found

    return kept


@dataclass(frozen=True, slots=True, kw_only=True)
class Design:
    """All modules in the order of the text; the top one has the attribute ``top``."""

    modules: Mapping[str, Module]

    @property
    def top(self) -> Module:
        """The outermost module."""
        for module in self.modules.values():
            if module.attributes.get("top") == 1:
                return module
        return next(iter(self.modules.values()))
