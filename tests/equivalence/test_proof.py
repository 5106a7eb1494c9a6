# amaranth: UnusedElaboratable=no
"""Proofs: equal circuits are proved equal, broken ones are not.

``FIRM_HDL_BROKEN=1`` tries every broken circuit, not one in five.
"""

from __future__ import annotations

import os
import re
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest
from amaranth.hdl import Array, Cat, Elaboratable, Module, Mux, Signal, Value, signed

from firm_hdl import load_message
from firm_hdl.equivalence import ProofError, Tools, prove
from firm_hdl.equivalence.command import converter_vhdl
from firm_hdl.export.build import build
from firm_hdl.export.top import DIRECTIONS, Direction
from firm_hdl.vhdl.convert import Vhdl, convert
from tests.depth import by_depth
from tests.equivalence.designs import Small, broken_rtlil, broken_vhdl, small_rtlil
from tests.vhdl import random_designs

EVERY = 1 if os.environ.get("FIRM_HDL_BROKEN") else 5


@cache
def _small() -> tuple[str, Vhdl]:
    text = small_rtlil()
    return text, convert(text, name="little")


def _twins() -> list[tuple[str, str, Vhdl]]:
    text, vhdl = _small()
    twins = [(f"RTLIL: {what}", broken, vhdl) for what, broken in broken_rtlil(text)]
    for entity in ("little", "little_inner"):
        twins += [(f"VHDL: {what}", text, broken) for what, broken in broken_vhdl(vhdl, entity)]
    return twins


def test_a_design_is_proved_equal(tools: Tools) -> None:
    design = Small()
    proof = prove(design, name="little", ports=design.ports, tools=tools)
    assert proof.result == "equal", proof
    assert (proof.registers, proof.unmatched, proof.counterexample) == (16, (), {})


@pytest.mark.sampled(8)
@pytest.mark.parametrize(("what", "rtlil", "vhdl"), _twins()[::EVERY])
def test_one_changed_thing_is_found(what: str, rtlil: str, vhdl: Vhdl, tools: Tools) -> None:
    try:
        proof = prove(rtlil, vhdl, tools=tools)
    except ProofError as error:
        # A register that holds its value becomes a loop when it becomes a wire.
        assert "is a wire" in what and "combinational loop" in str(error)
    else:
        assert proof.result == "unequal", what
        assert proof.differences


def test_broken_circuits_are_of_every_kind() -> None:
    kinds = {re.sub(r"[^A-Za-z ]", "", what)[:14] for what, _, _ in _twins()}
    assert len(_twins()) > 50
    assert len(kinds) >= 18


def test_a_counterexample_has_names(tools: Tools) -> None:
    text, vhdl = _small()
    broken = replace(
        vhdl,
        files={**vhdl.files, "little.vhd": vhdl.files["little.vhd"].replace(" + ", " - ")},
    )
    proof = prove(text, broken, tools=tools)
    assert proof.differences[0].startswith("next state of out is ")
    assert "input a" in proof.counterexample
    assert "unequal" in str(proof)


def test_a_register_that_vhdl_makes_a_wire_is_found(tools: Tools) -> None:
    text, vhdl = _small()
    # `late`, a registered copy of `go`, becomes a wire.
    body = vhdl.files["little.vhd"]
    assert "      late <= '0';\n" in re.sub(" +late", "      late", body)
    without = re.sub(r"\n *late <= [^\n]*;", "", body)
    broken = without.replace("\nend architecture", "\n  late <= go;\nend architecture")
    proof = prove(text, replace(vhdl, files={**vhdl.files, "little.vhd": broken}), tools=tools)
    assert proof.result == "unequal"
    assert proof.differences == ("late is not a register in the VHDL",)


def test_a_port_that_is_missing_is_found(tools: Tools) -> None:
    text, vhdl = _small()
    start = "module \\little\n"
    assert text.count(start) == 1
    more = text.replace(start, f"{start}  wire width 1 input 99 \\more\n")
    proof = prove(more, vhdl, tools=tools)
    assert proof.differences == ("only one side has the input more",)


class _Operators(Elaboratable):
    """Every operator, on short operands of both signs."""

    def __init__(self) -> None:
        a, b = Signal(4, name="a"), Signal(3, name="b")
        sa, sb = Signal(signed(4), name="sa"), Signal(signed(3), name="sb")
        e = Signal(name="e")
        self.inputs = [a, b, sa, sb, e]
        self.values: list[Value] = [-a, -sa, ~a, abs(sa), a.any(), a.all(), a.xor()]
        # Operands of both signs are extended alike, whichever is on the left.
        for x, y in ((a, b), (sa, sb), *by_depth((), ((a, sb), (sa, b)))):
            self.values += [x + y, x - y, x * y, x // y, x % y, x & y, x | y, x ^ y]
            self.values += [x == y, x != y, x < y, x <= y, x > y, x >= y]
        self.values += [a << b, sa << b, a >> b, sa >> b, Mux(e, a, sb), a.bit_select(b, 2)]
        self.values += [a.word_select(b[:2], 2), Array([a, b, sa])[b[:2]], a.rotate_left(3)]
        self.values += [a.matches("1--1", "00-0"), Cat(a, b).bit_select(a, 4), a.replicate(2)]
        self.outputs = [Signal(len(v), name=f"o{n}") for n, v in enumerate(self.values)]

    def elaborate(self, platform: object) -> Module:
        m = Module()
        for output, value in zip(self.outputs, self.values, strict=True):
            m.d.comb += output.eq(value)
        return m


@pytest.mark.thorough
def test_every_operator_is_proved_equal(tools: Tools) -> None:
    design = _Operators()
    proof = prove(design, ports=[*design.inputs, *design.outputs], tools=tools)
    assert proof.result == "equal", proof


class _WithoutMemory(random_designs.RandomDesign):
    def _memory(self, module: Module) -> None:
        self._combinational(module)


# GHDL 2.0's synthesis stops with an internal error at many other seeds, or is wrong: it cuts
# a number off that is compared with a shorter vector, and takes the wrong bits of a constant.
@pytest.mark.parametrize("seed", by_depth([0, 6], [0, 1, 6]))
@pytest.mark.sampled(2)
def test_random_designs_are_proved_equal(
    seed: int, tools: Tools, monkeypatch: pytest.MonkeyPatch
) -> None:
    # A solver takes too long for products and quotients of 40 bits.
    operators = random_designs._OPERATORS[:2] + random_designs._OPERATORS[5:]
    monkeypatch.setattr(random_designs, "_OPERATORS", operators)
    design = _WithoutMemory(seed, size=3)
    proof = prove(design, name="dut", ports=design.ports, tools=tools)
    assert proof.result == "equal", proof


@pytest.mark.parametrize(
    ("direction", "part"), [("deserializer", "mover"), ("serializer", "collector")]
)
@pytest.mark.thorough
def test_a_broken_converter_is_found(direction: Direction, part: str, tools: Tools) -> None:
    name, bus_bytes = by_depth(("std_msgs/msg/Bool", 1), ("std_msgs/msg/String", 8))
    rtlil, vhdl = converter_vhdl(load_message(name), direction, bus_bytes=bus_bytes)
    twins = [twin for twin in broken_vhdl(vhdl, f"{vhdl.top}_core_{part}") if " is or" in twin[0]]
    assert prove(rtlil, twins[0][1], tools=tools).result == "unequal"


BUILT = by_depth("std_msgs/msg/String", "sensor_msgs/msg/Joy")


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a type, for both directions."""
    (built,) = build([BUILT], tmp_path_factory.mktemp("built"))
    return built.folder


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.sampled(2)
def test_proved_vhdl_is_the_vhdl_that_build_writes(direction: Direction, built: Path) -> None:
    _, vhdl = converter_vhdl(load_message(BUILT), direction)
    package, *entities = vhdl.files
    folder = built / "vhdl"
    assert (folder / package).read_text(encoding="utf-8") == vhdl.files[package]
    written = (folder / f"{vhdl.top}.vhd").read_text(encoding="utf-8")
    proved = "\n".join(vhdl.files[file] for file in entities)
    assert _without_heads(written).endswith(_without_heads(proved))


def _without_heads(text: str) -> str:
    """Return VHDL without the comments before entities, which name the modules."""
    return re.sub(r"^--(?: .*)?\n", "", text, flags=re.MULTILINE)
