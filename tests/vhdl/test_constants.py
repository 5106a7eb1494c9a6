# amaranth: UnusedElaboratable=no
"""Operators with constants that are too wide for an integer of VHDL."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest
from amaranth.hdl import Cat, Const, Elaboratable, Module, Signal, Value, signed
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.node.gateware.clock import NodeClock
from firm_hdl.vhdl.convert import Vhdl, convert
from tests.vhdl.ghdl import analyse, difference, expected, run, simulate, synthesize, vectors

K = 0x1_EE6B_2800
"""33 bits, one more than GHDL 2.0 can extend in synthesis."""


class Wide(Elaboratable):
    """An output for each operator with `K`."""

    def __init__(self) -> None:
        a, b, c = Signal(60, name="a"), Signal(signed(60), name="b"), Signal(40, name="c")
        results: dict[str, Value] = {
            "sum": a + K,
            "sum_signed": b + K,
            "minus": a - K,
            "minus_signed": b + -K,
            "rest": (K - a)[:60],
            "product": a * K,
            "product_signed": b * -K,
            "quotient": a // K,
            "quotient_signed": b // -K,
            "remainder": a % K,
            "remainder_signed": b % K,
            "divided": K // c,
            "modulus": K % c,
            "more": a > K,
            "same": (c & ~0xFF) == (K & ~0xFF),
            "less": b < K,
            "least": b <= -K,
        }
        self.inputs = {"a": a, "b": b, "c": c}
        self.outputs = {name: Signal(len(value), name=name) for name, value in results.items()}
        self._results = results

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.d.comb += [self.outputs[name].eq(value) for name, value in self._results.items()]
        return m


@pytest.fixture(scope="module")
def vhdl() -> Vhdl:
    wide = Wide()
    return convert(wide, name="wide", ports=[*wide.inputs.values(), *wide.outputs.values()])


def narrowed(text: str) -> str:
    """Write constants of 60 bits with the leading zeros left to the operators of numeric_std."""
    return text.replace('x"0000001EE6B2800"', '34x"1EE6B2800"')


@pytest.mark.usefixtures("ghdl")
def test_values_are_those_of_amaranth(vhdl: Vhdl, tmp_path: Path) -> None:
    wide = Wide()
    widths, results = (
        {name: len(signal) for name, signal in signals.items()}
        for signals in (wide.inputs, wide.outputs)
    )
    steps = vectors(widths, [], steps=100, seed=1)
    # Around the constant, too.
    steps += [{"a": K + each, "b": K + each, "c": K + each} for each in (-1, 0, 1)]
    want = expected(wide, wide.inputs, wide.outputs, steps)
    assert difference(want, simulate(vhdl, steps, widths, results, tmp_path)) is None
    # Leading zeros mean nothing; another constant is noticed.
    for change, same in (
        (narrowed, True),
        (lambda text: text.replace("1EE6B28", "1EE6B29"), False),
    ):
        changed = change(vhdl.files["wide.vhd"])
        assert changed != vhdl.files["wide.vhd"]
        other = replace(vhdl, files={**vhdl.files, "wide.vhd": changed})
        got = simulate(other, steps, widths, results, tmp_path)
        assert (difference(want, got) is None) == same


@pytest.mark.usefixtures("ghdl")
def test_ghdl_synthesizes_them(vhdl: Vhdl, tmp_path: Path) -> None:
    assert "entity" in synthesize(vhdl, tmp_path)
    if re.match(r"GHDL 2\.0", run(tmp_path, "--version")):
        text = narrowed(vhdl.files["wide.vhd"])
        with pytest.raises(AssertionError, match=r"netlists-utils\.adb:163"):
            synthesize(replace(vhdl, files={**vhdl.files, "wide.vhd": text}), tmp_path)


class Joined(wiring.Component):
    """Long constants in concatenations, in front of a signal and behind it, and at a port."""

    def __init__(self) -> None:
        super().__init__({"a": In(32), "front": Out(128), "behind": Out(128), "ports": Out(160)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.same = same = Same()
        constant = Const(0xFEDC_BA98_7654_3210_0123_4567, 96)
        m.d.comb += [
            self.front.eq(Cat(self.a, constant)),
            self.behind.eq(Cat(constant, self.a)),
            same.a.eq(Cat(constant, self.a, self.a)),
            self.ports.eq(same.o),
        ]
        return m


class Same(wiring.Component):
    """A component with a wide input."""

    def __init__(self) -> None:
        super().__init__({"a": In(160), "o": Out(160)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.d.comb += self.o.eq(self.a)
        return m


@pytest.mark.usefixtures("ghdl")
@pytest.mark.parametrize("design", [Joined(), NodeClock(100e6)], ids=["joined", "clock of a node"])
def test_ghdl_writes_no_constant_as_a_string(tmp_path: Path, design: wiring.Component) -> None:
    vhdl = convert(design, name="top")
    analyse(vhdl, tmp_path)
    verilog = run(tmp_path, "--synth", "--std=08", "--out=verilog", vhdl.top)
    assert "endmodule" in verilog and '"' not in verilog


@pytest.mark.usefixtures("ghdl")
def test_pieces_of_long_constants_are_those_of_amaranth(tmp_path: Path) -> None:
    joined = Joined()
    outputs = {name: getattr(joined, name) for name in ("front", "behind", "ports")}
    steps = vectors({"a": 32}, [], steps=10, seed=1)
    want = expected(joined, {"a": joined.a}, outputs, steps)
    widths = {name: len(value) for name, value in outputs.items()}
    vhdl = convert(joined, name="top")
    assert difference(want, simulate(vhdl, steps, {"a": 32}, widths, tmp_path)) is None
