"""Names of signals and ports in Verilog, and whole vectors."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
from amaranth.hdl import Cat, Module, Signal

from firm_hdl import Deserializer, Serializer, load_message
from firm_hdl.export.top import DIRECTIONS, Top
from firm_hdl.rtlil import rtlil_of
from firm_hdl.verilog import convert
from firm_hdl.vhdl.convert import convert as convert_to_vhdl
from tests.depth import by_depth


@pytest.mark.usefixtures("verilator")
def test_a_vector_is_no_loop_through_its_parts(tmp_path: Path) -> None:
    """Tools that look at whole vectors would see loops, and simulate them slowly."""
    text = convert(Top(Deserializer(load_message("std_msgs/msg/String"))), name="t")
    (tmp_path / "t.v").write_text(text)
    done = subprocess.run(
        ["verilator", "--lint-only", "t.v"], cwd=tmp_path, capture_output=True, text=True
    )
    assert "UNOPTFLAT" not in done.stderr


def test_ports_that_are_parts_have_the_name_of_the_whole() -> None:
    inner, outer = Module(), Module()
    a, b, both = Signal(8, name="a"), Signal(4, name="b"), Signal(12, name="both")
    seen, taken = Signal(12, name="seen"), Signal(name="both_0")
    outer.d.sync += a.eq(a + 1)
    outer.d.comb += both.eq(Cat(a, b))
    inner.d.sync += seen.eq(both)
    inner.d.comb += taken.eq(both[0])
    outer.submodules.inner = inner
    text = convert(outer, ports=[b, seen, taken])
    assert re.search(r"input wire \[3:0\] +both_8,", text)
    assert re.search(r"input wire \[7:0\] +both_0,", text)


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize(
    "name",
    by_depth(
        ["std_msgs/msg/MultiArrayDimension"],
        ["sensor_msgs/msg/JointState", "geometry_msgs/msg/Twist"],
    ),
)
@pytest.mark.sampled(2)
def test_signals_have_the_names_of_the_vhdl(direction: str, name: str) -> None:
    converter = Deserializer if direction == "deserializer" else Serializer
    top = Top(converter(load_message(name)))
    text = convert(top, name="t")
    # Amaranth calls a signal so if it finds no name, as in `a, b = Signal(), Signal()`.
    assert "$signal" not in rtlil_of(top, name="t") and "\\" not in text
    declared = r"^  (?:wire|reg|signal) (?:\[\d+:0\] )?(\w+)"
    found = {*re.findall(declared, text, re.MULTILINE)}
    vhdl = "".join(convert_to_vhdl(top, name="t").files.values())
    others = {*re.findall(declared, vhdl, re.MULTILINE)}
    # VHDL has signals of another type for ports. And it cannot write the same operators in
    # expressions, so that results without a name, which have a number, differ.
    assert {each for each in found ^ others if not re.search(r"_(\d+|i|next)$", each)} == set()
