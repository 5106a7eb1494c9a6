# amaranth: UnusedElaboratable=no
"""A small design without redundant logic, and ways to break a circuit, chosen by rule."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

from amaranth.back import rtlil
from amaranth.hdl import Elaboratable, Module, Signal

from firm_hdl.vhdl.convert import Vhdl

__all__ = ["Small", "broken_rtlil", "broken_vhdl", "small_rtlil"]


class _Inner(Elaboratable):
    def __init__(self) -> None:
        self.i, self.o = Signal(4, name="i"), Signal(4, name="o", init=3)

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.d.sync += self.o.eq(self.i ^ (self.o << 1))
        return m


class Small(Elaboratable):
    """Arithmetic, a switch, registers with and without a condition, and a submodule."""

    def __init__(self) -> None:
        self.a, self.b, self.go = Signal(4, name="a"), Signal(4, name="b"), Signal(name="go")
        self.out, self.flag = Signal(8, name="out", init=5), Signal(name="flag")
        self.ports = [self.a, self.b, self.go, self.out, self.flag]

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.inner = inner = _Inner()
        state, mark, late = Signal(2, name="state"), Signal(name="mark"), Signal(name="late")
        m.d.comb += [
            inner.i.eq(self.a & inner.o),
            self.flag.eq((mark ^ late) | (self.a < self.b)),
        ]
        m.d.sync += late.eq(self.go)
        with m.If(self.go):
            m.d.sync += mark.eq(self.a == self.b)
        with m.Switch(state):
            with m.Case(0):
                m.d.sync += [self.out.eq(self.out + self.a), state.eq(1)]
            with m.Case(1):
                m.d.sync += [self.out.eq(self.out - self.b), state.eq(2)]
            with m.Default():
                m.d.sync += [self.out.eq(self.out ^ inner.o), state.eq(0)]
        return m


def small_rtlil() -> str:
    """Return the design as RTLIL."""
    design = Small()
    text: str = rtlil.convert(design, name="little", ports=design.ports, emit_src=False)
    return text


_OTHER_CELL = {
    "and": "or",
    "or": "and",
    "xor": "or",
    "eq": "ne",
    "ne": "eq",
    "lt": "le",
    "gt": "ge",
    "le": "lt",
    "ge": "gt",
    "add": "sub",
    "sub": "add",
    "shl": "shr",
    "reduce_or": "reduce_and",
    "reduce_and": "reduce_or",
}


def broken_rtlil(text: str) -> Iterator[tuple[str, str]]:
    """Change one thing in RTLIL.

    Yields
    ------
    what, text
        Other operators, clock edges, constants of registers, switches with swapped arms, and
        registers that become wires.
    """
    for match in re.finditer(r"cell \$(\w+) ", text):
        other = _OTHER_CELL.get(match[1])
        if other is not None:
            yield f"{match[0]}is {other}", _put(text, match, 1, other)
    for match in re.finditer(r"CLK_POLARITY 1", text):
        yield "clock edge", _put(text, match, 0, "CLK_POLARITY 0")
    for match in re.finditer(r"init \d+'[01]*([01])\n", text):
        yield f"{match[0].strip()} is another", _put(text, match, 1, "10"[int(match[1])])
    for match in re.finditer(r"assign \$\S+ \S+ \d+'[01]*([01])\n", text):
        yield f"{match[0].strip()} is another", _put(text, match, 1, "10"[int(match[1])])
    for match in re.finditer(r"case (\d+'[01]+)(\n[^\n]*\n +)case (\d+'[01]+)\n", text):
        arms = f"case {match[3]}{match[2]}case {match[1]}\n"
        yield f"arms {match[1]} and {match[3]} are swapped", _put(text, match, 0, arms)
    cell = r"cell \$dff \S+\n[^c]*connect \\D ([^\n]+)\n[^\n]*\n *connect \\Q ([^\n]+)\n *end\n"
    for match in re.finditer(cell, text):
        wire = f"connect {match[2]} {match[1]}\n"
        yield f"register {match[2]} is a wire", _put(text, match, 0, wire)


_OTHER_WORD = {
    "and": "or",
    "or": "and",
    "xor": "or",
    "+": "-",
    "-": "+",
    "<": "<=",
    "'0'": "'1'",
    "'1'": "'0'",
    "rising_edge": "falling_edge",
}


def broken_vhdl(vhdl: Vhdl, entity: str) -> Iterator[tuple[str, Vhdl]]:
    """Change one thing in the architecture of an entity.

    Yields
    ------
    what, vhdl
        Other operators, constants, clock edges and initial values, and arms that are swapped.
    """
    file = f"{entity}.vhd"
    text = vhdl.files[file]
    start = text.index("\narchitecture ")
    head, body = text[:start], text[start:]
    for what, changed in _broken_bodies(body):
        yield what, replace(vhdl, files={**vhdl.files, file: head + changed})


def _broken_bodies(body: str) -> Iterator[tuple[str, str]]:
    words = r"(?<= )(and|or|xor|\+|-|<)(?= )|(?<![:<]= )('0'|'1')|(rising_edge)"
    for match in re.finditer(words, body):
        yield f"{match[0]} is {_OTHER_WORD[match[0]]}", _put(body, match, 0, _OTHER_WORD[match[0]])
    for match in re.finditer(r":= (?:'|\"[01]*)([01])['\"]", body):
        yield f"{match[0]} is another", _put(body, match, 1, "10"[int(match[1])])
    for match in re.finditer(r"<= (?:'|\"[01]*)([01])['\"];", body):
        yield f"{match[0]} is another", _put(body, match, 1, "10"[int(match[1])])
    arm = re.compile(r'when ("[01]+") =>')
    arms = list(arm.finditer(body))
    for one, two in pairwise(arms):
        if len(one[1]) == len(two[1]):
            swapped = body[: one.start(1)] + two[1] + body[one.end(1) : two.start(1)]
            yield f"arms {one[1]} and {two[1]} are swapped", swapped + one[1] + body[two.end(1) :]


def _put(text: str, match: re.Match[str], group: int, new: str) -> str:
    return text[: match.start(group)] + new + text[match.end(group) :]
