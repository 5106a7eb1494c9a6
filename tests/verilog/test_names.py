"""Nets and ports of the Verilog: whole vectors with meaningful names."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
from amaranth.back import rtlil
from amaranth.hdl import Cat, Module, Signal

from firm_hdl import Deserializer, Serializer, load_message
from firm_hdl.export.top import DIRECTIONS, Top
from firm_hdl.verilog import convert
from firm_hdl.verilog.ports import named_ports
from firm_hdl.verilog.vectors import whole_vectors
from firm_hdl.verilog.yosys import _named_choices
from tests.depth import by_depth


def test_parts_are_put_together_in_the_order_of_their_bits() -> None:
    m = Module()
    a, b = Signal(4, name="a"), Signal(3, name="b")
    both = Signal(8, name="both", init=0b1000)
    turned = Signal(7, name="turned")
    # Bit 3 has no driver, and keeps its initial value 1.
    m.d.comb += [both[4:].eq(a), both[:3].eq(b), turned.eq(Cat(a, b))]
    before = rtlil.convert(m, ports=[a, b, both, turned], emit_src=False)
    after = whole_vectors(before)
    assert "process" in before and "process" not in after
    for value, name in ((r"\a [3:0] 1'1 \b [2:0]", "both"), (r"\b [2:0] \a [3:0]", "turned")):
        assert f"connect \\A {{ {value} }}\n    connect \\Y \\{name}\n" in after


@pytest.mark.usefixtures("verilator")
@pytest.mark.parametrize("keeps", [True, False])
@pytest.mark.sampled(2)
def test_a_vector_is_no_loop_through_its_parts(tmp_path: Path, keeps: bool, monkeypatch) -> None:
    if not keeps:
        monkeypatch.setattr("firm_hdl.verilog.yosys.whole_vectors", lambda design: design)
    text = convert(Top(Deserializer(load_message("std_msgs/msg/String"))), name="t")
    (tmp_path / "t.v").write_text(text)
    done = subprocess.run(
        ["verilator", "--lint-only", "t.v"], cwd=tmp_path, capture_output=True, text=True
    )
    assert ("UNOPTFLAT" in done.stderr) == (not keeps)


def test_overlapping_and_conditional_parts_stay_processes() -> None:
    m = Module()
    a, b, o, p = Signal(4, name="a"), Signal(name="b"), Signal(8, name="o"), Signal(8, name="p")
    m.d.comb += [o[:4].eq(a), o[2:6].eq(a), p[:4].eq(a)]
    with m.If(b):
        m.d.comb += p[4:].eq(a)
    design = rtlil.convert(m, ports=[a, b, o, p], emit_src=False)
    assert whole_vectors(design) == design


def test_ports_that_are_parts_have_the_name_of_the_whole() -> None:
    inner, outer = Module(), Module()
    a, b, both = Signal(8, name="a"), Signal(4, name="b"), Signal(12, name="both")
    seen, taken = Signal(12, name="seen"), Signal(name="both_0")
    outer.d.sync += a.eq(a + 1)
    outer.d.comb += both.eq(Cat(a, b))
    inner.d.sync += seen.eq(both)
    inner.d.comb += taken.eq(both[0])
    outer.submodules.inner = inner
    design = rtlil.convert(outer, ports=[b, seen, taken], emit_src=False)
    named = named_ports(design)
    assert "port$" in design and "port$" not in named
    assert "connect \\both { \\both_8 [3:0] \\both_0_2 [7:0] }\n" in named
    assert "    connect \\both_8 \\b [3:0]\n" in named


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize(
    "name",
    by_depth(
        ["std_msgs/msg/MultiArrayLayout"], ["sensor_msgs/msg/JointState", "geometry_msgs/msg/Twist"]
    ),
)
@pytest.mark.sampled(2)
def test_every_signal_of_a_converter_has_a_name(direction: str, name: str) -> None:
    converter = Deserializer if direction == "deserializer" else Serializer
    text = convert(Top(converter(load_message(name))), name="t")
    # Results of operators have numbers. `$signal` is a signal for which Amaranth found no name.
    assert set(re.findall(r"\\(\$?\w*\$[A-Za-z]\w*|port\$\S*)", text)) == set()
    assert r"\$1 " in text


@pytest.mark.parametrize(
    ("other", "prefix"),
    [
        ("chosen", "choice"),
        ("choice", "choice"),
        ("choice_4", "choice_"),
        ("my_choice_", "choice_"),
    ],
)
def test_choices_have_names_that_no_signal_begins_with(other: str, prefix: str) -> None:
    text = f"wire {other};\nwire \\$procmux$4_Y ;\nfunction \\$procmux$4 ;\n"
    assert _named_choices(text) == (f"wire {other};\nwire {prefix}_4_Y ;\nfunction {prefix}_4 ;\n")


def test_ports_that_are_parts_have_names_that_differ_in_more_than_their_case() -> None:
    design = "".join(
        f"  wire width 4 \\port${n}$0\nconnect \\{name} {{ \\port${n}$0 [3:0] 4'0000 }}\n"
        for n, name in enumerate("sSt")
    )
    named = re.findall(r"connect \\(\w) \{ \\(\w+) ", named_ports(design))
    assert named == [("s", "s_4"), ("S", "S_4_2"), ("t", "t_4")]
