# amaranth: UnusedElaboratable=no
"""Attributes of signals, components of foreign instances, and comments of choices."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from amaranth.hdl import Const, Instance, Module, Signal, Value, unsigned
from amaranth.lib import data, enum
from amaranth.lib.memory import Memory

from firm_hdl.names.attributes import REMARK
from firm_hdl.verilog import convert as convert_to_verilog
from firm_hdl.vhdl.convert import convert
from tests.vhdl.ghdl import analyse


class Kind(enum.Enum, shape=unsigned(2)):
    IDLE = 0
    BUSY = 1
    DONE = 2


def text_of(m: Module, *ports: Signal) -> str:
    return convert(m, name="t", ports=list(ports)).files["t.vhd"]


def test_a_signal_keeps_its_attributes_whatever_drives_it() -> None:
    m = Module()
    a, b, o = (Signal(2, name=name) for name in "abo")
    driven = Signal(2, name="driven", attrs={"keep": 1})
    stored = Signal(2, name="stored", attrs={"keep": 2, "note": 'a "b"'})
    unread = Signal(Kind, name="unread", attrs={"keep": 3})
    m.d.comb += [driven.eq(a + b), unread.eq(a[::-1])]
    m.d.sync += stored.eq(a * b)
    m.d.comb += o.eq(driven[::-1] ^ stored[::-1])
    lines = [line.strip() for line in text_of(m, a, b, o).splitlines()]
    assert {line for line in lines if line.startswith("attribute")} == {
        "attribute keep : integer;",
        "attribute note : string;",
        "attribute keep of driven : signal is 1;",
        "attribute keep of stored : signal is 2;",
        'attribute note of stored : signal is "a ""b""";',
        "attribute keep of unread : signal is 3;",
    }


@pytest.mark.usefixtures("ghdl")
def test_each_kind_of_value_of_an_attribute_has_its_type(tmp_path: Path) -> None:
    """A constant with a width is a text of bits."""
    m = Module()
    a, o = Signal(name="a"), Signal(name="o")
    attributes = {"word": "x", "number": 70_000, "bits": Const(5, 4), "wide": Const(1 << 39, 40)}
    register = Signal(name="r", attrs=attributes)
    m.d.sync += register.eq(a)
    m.d.comb += o.eq(register)
    vhdl = convert(m, name="t", ports=[a, o])
    found = re.findall(r"attribute (\w+) (?:: (\w+)|of r : signal is (.*));", vhdl.files["t.vhd"])
    kinds = {name: kind for name, kind, _ in found if kind}
    values = {name: value for name, _, value in found if value}
    assert kinds == dict.fromkeys(attributes, "string") | {"number": "integer"}
    wide = "1" + "0" * 39
    assert values == {"word": '"x"', "number": "70000", "bits": '"0101"', "wide": f'"{wide}"'}
    analyse(vhdl, tmp_path)


def test_one_attribute_has_one_type() -> None:
    m = Module()
    a, o = Signal(name="a"), Signal(2, name="o")
    for index, value in enumerate((1, "yes")):
        register = Signal(name=f"r{index}", attrs={"keep": value})
        m.d.sync += register.eq(a)
        m.d.comb += o[index].eq(register)
    with pytest.raises(ValueError, match=r"^attribute 'keep' has values of different types$"):
        text_of(m, a, o)


def two_units(first: dict[str, Any], second: dict[str, Any]) -> tuple[Module, Signal]:
    m, a = Module(), Signal(8, name="a")
    for name, more in (("u", first), ("v", second)):
        m.submodules[name] = Instance("unit", i_a=a, **more)
    return m, a


@pytest.mark.usefixtures("ghdl")
def test_a_component_is_declared_once(tmp_path: Path) -> None:
    m, a = two_units({"p_N": 1, "p_T": "x"}, {"p_N": 2, "p_T": "y"})
    vhdl = convert(m, name="t", ports=[a])
    assert vhdl.files["t.vhd"].count("component unit is") == 1
    assert [f"N => {n}" in vhdl.files["t.vhd"] for n in (1, 2)] == [True, True]
    analyse(vhdl, tmp_path)


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ({"p_N": 1}, {}),
        ({"p_N": 1}, {"p_N": 1.0}),
        ({"p_N": 1}, {"p_M": 1}),
        ({"p_N": Const(1, 2)}, {"p_N": Const(1, 3)}),
        ({"i_b": Const(1, 2)}, {"i_b": Const(1, 3)}),
        ({"i_b": Const(1, 2)}, {"o_b": Signal(2)}),
    ],
)
def test_instances_of_one_component_must_not_differ(
    first: dict[str, Any], second: dict[str, Any]
) -> None:
    m, a = two_units(first, second)
    with pytest.raises(ValueError, match=r"^instances of 'unit' in 't' differ in their ports"):
        text_of(m, a)


@pytest.mark.usefixtures("ghdl")
def test_foreign_names_and_generics_stay_exact(tmp_path: Path) -> None:
    m, a = Module(), Signal(4, name="a")
    m.submodules.u = Instance(
        "Unit\\2",
        p_signal=Const(5, 4),
        p_N=-3,
        p_R=0.5,
        p_T='a "b"',
        i_In=a,
        i__x=a[:1],
        i_none=Const(0, 0),
    )
    vhdl = convert(m, name="t", ports=[a])
    words = " ".join(vhdl.files["t.vhd"].split())
    assert (
        "component \\Unit\\\\2\\ is generic ( \\signal\\ : std_logic_vector(3 downto 0); "
        "N : integer; R : real; T : string ); port ( \\In\\ : in std_logic_vector(3 downto 0); "
        "\\_x\\ : in std_logic ); end component;"
    ) in words
    assert (
        'generic map ( \\signal\\ => "0101", N => -3, R => 0.5, T => "a ""b""" ) '
        "port map ( \\In\\ => a, \\_x\\ => a(0) );"
    ) in words
    analyse(vhdl, tmp_path)


@pytest.mark.usefixtures("ghdl")
def test_nothing_else_has_the_name_of_a_component(tmp_path: Path) -> None:
    """VHDL does not tell upper from lower case, so a primitive ``PLL`` has the name of ``pll``."""
    m, inner = Module(), Module()
    a, pad = Signal(4, name="a"), Signal(4, name="pad")
    register, wire, below = (Signal(4, name=name) for name in ("reg_1", "NET_1", "pll"))
    m.submodules.memory = memory = Memory(shape=4, depth=4, init=[1])
    m.submodules.pll = Instance("PLL", i_a=a, o_q=wire)
    m.submodules.u1 = Instance("Reg_1", i_a=register)
    m.submodules.u2 = Instance("net_1", i_a=wire)
    m.submodules.u3 = Instance("Memory", i_a=wire)
    m.submodules.inner = inner
    inner.submodules.u = Instance("PLL", i_a=below)
    # A basic identifier is another one than an extended one.
    m.submodules.u4 = Instance("a-b", i_a=a)
    m.submodules.u5 = Instance("PAD", i_a=a)
    read = memory.read_port(domain="comb")
    m.d.comb += [below.eq(a), pad.eq(read.data), read.addr.eq(wire)]
    m.d.sync += register.eq(wire)
    vhdl = convert(m, name="t", ports=[a, pad])
    text = vhdl.files["t.vhd"]
    for name in ("PLL", "Reg_1", "net_1", "Memory", "PAD", "\\a-b\\"):
        assert f"  component {name} is\n" in text, name
        assert f" : {name}\n" in text, name
    names = vhdl.entities["t"]
    given = {*names.ports.values(), *names.signals.values(), *names.memories.values()}
    given |= {*names.instances.values()}
    assert not {each.lower() for each in given} & {"pll", "reg_1", "net_1", "memory", "pad"}
    assert names.ports["a"] == "a"
    analyse(vhdl, tmp_path)


def test_an_output_is_converted_if_an_instance_has_another_type() -> None:
    top, inner, a = Module(), Module(), Signal(4, name="a")
    foreign, below, bit = Signal(4, name="f"), Signal(4, name="b"), Signal(name="c")
    top.submodules.u = Instance("unit", i_a=a, o_q=foreign, o_p=bit)
    inner.d.comb += below.eq(a + 1)
    deep = Signal(4, name="d")
    inner.submodules.v = Instance("unit", i_a=a, o_q=deep)
    top.submodules.inner = inner
    files = convert(top, ports=[a, foreign, below, bit, deep]).files
    text = files["top.vhd"].partition("\nbegin\n")[2]
    # Ports of submodules are unsigned, and those of components vectors; a bit has one type.
    assert "d <= unsigned(d_i);" in files["top_inner.vhd"]
    assert "d <= std_logic_vector(d_i);" in text and "b <= std_logic_vector(b_i);" in text
    assert text.count("<=") == 2 and "q => f" in text and "p => c" in text


def test_fields_and_values_of_enumerations_are_read_by_name() -> None:
    m = Module()
    order = Signal(data.StructLayout({"kind": Kind, "at": 4}), name="order")
    total, is_done = Signal(4, name="total"), Signal(name="is_done")
    m.d.sync += order.kind.eq(Kind.BUSY)
    m.d.comb += [total.eq(order.at + 1), is_done.eq(order.kind == Kind.DONE)]
    ports = [Value.cast(order), total, is_done]
    vhdl = convert(m, name="t", ports=ports).files["t.vhd"]
    assert "order_at + 1" in vhdl and "when order_kind = KIND_DONE" in vhdl
    assert 'constant KIND_DONE : unsigned(1 downto 0) := "10";' in vhdl
    assert "KIND_IDLE" not in vhdl
    verilog = convert_to_verilog(m, name="t", ports=ports)
    assert "order_kind == KIND_DONE" in verilog and "localparam [1:0] KIND_DONE" in verilog


def test_a_signal_is_not_named_after_the_port_of_a_submodule() -> None:
    m, inner = Module(), Module()
    place, key, o = Signal(4, name="place"), Signal(4, name="key"), Signal(4, name="o")
    inner.d.comb += o.eq(key + 3)
    m.submodules.inner = inner
    m.d.comb += key.eq(place)
    m.d.sync += place.eq(place + 1)
    assert "key => place" in text_of(m, o)


def test_equal_expressions_are_written_once() -> None:
    m = Module()
    a, b, o, p = (Signal(4, name=name) for name in "abop")
    m.d.comb += [o.eq((a * b) ^ a), p.eq((a * b) ^ b)]
    assert text_of(m, a, b, o, p).count("*") == 1


def test_a_remark_stands_beside_its_signal() -> None:
    m = Module()
    o = Signal(name="o", attrs={REMARK: "takes x"})
    m.d.sync += o.eq(~o)
    assert ":= '0';  -- takes x" in text_of(m, o)
