# amaranth: UnusedElaboratable=no
"""Which names entities, ports and signals get, and what is refused before any is given."""

from __future__ import annotations

import pytest
from amaranth.asserts import AnyConst
from amaranth.hdl import Cat, ClockDomain, Module, Mux, Signal
from amaranth.lib import data

from firm_hdl.vhdl.convert import convert

NETLIST = r"""
attribute \top 1
module \t
  wire width 4 input 0 \i
  wire width 4 output 1 \o
  cell \t.sub \u
    connect \i \i [3:0]
    connect \o \o
  end
end
module \t.sub
  wire width 4 input 0 \i
  wire width 4 output 1 \o
  connect \o \i [3:0]
end
"""


@pytest.mark.parametrize("name", ["t", "other", "firm_hdl"])
def test_all_entities_of_a_netlist_get_the_given_name(name: str) -> None:
    vhdl = convert(NETLIST, name=name)
    assert vhdl.top == name
    assert list(vhdl.files) == ["firm_hdl_pkg.vhd", f"{name}_sub.vhd", f"{name}.vhd"]
    assert {module: given.entity for module, given in vhdl.entities.items()} == {
        "t.sub": f"{name}_sub",
        "t": name,
    }


def test_no_entity_has_the_name_of_the_package() -> None:
    vhdl = convert(NETLIST, name="firm_hdl_pkg")
    assert len(vhdl.files) == 3 and vhdl.top != "firm_hdl_pkg"
    assert vhdl.files["firm_hdl_pkg.vhd"] == convert(NETLIST).files["firm_hdl_pkg.vhd"]


def test_an_empty_design_is_refused() -> None:
    with pytest.raises(ValueError, match=r"^The design is empty: it has no module"):
        convert("")


def test_cells_of_formal_tools_are_refused_in_inner_modules() -> None:
    top, inner, out = Module(), Module(), Signal(4, name="o")
    top.submodules.inner = inner
    inner.d.comb += out.eq(AnyConst(4))
    with pytest.raises(ValueError, match=r"^module 'top\.inner' has AnyConst \(\$anyconst\)"):
        convert(top, ports=[out])


def test_clocks_and_resets_are_the_first_ports_and_ports_without_bits_are_none() -> None:
    m = Module()
    a, empty, clk_enable, q = (
        Signal(n, name=s) for n, s in [(4, "a"), (0, "z"), (1, "e"), (4, "q")]
    )
    m.domains.fast = fast = ClockDomain()
    m.d.fast += q.eq(a)
    m.d.sync += clk_enable.eq(a[0])
    vhdl = convert(m, name="t", ports=[a, empty, clk_enable, q, fast.clk, fast.rst])
    ports = list(vhdl.entities["t"].ports)
    assert set(ports[:4]) == {"clk", "rst", "fast_clk", "fast_rst"}
    assert ports[4:] == ["a", "e", "q"]
    assert " z " not in vhdl.files["t.vhd"]


def test_names_of_the_design_come_before_names_made_for_operators() -> None:
    def names(register: str) -> dict[str, str]:
        m = Module()
        a, b = Signal(4, name="a"), Signal(4, name="b")
        low, high = Signal(name="low"), Signal(2, name="high")
        kept = Signal(4, name=register)
        total = a + b
        m.d.sync += kept.eq(a)
        m.d.comb += [low.eq(total[0] ^ kept[0]), high.eq(total[1:3])]
        vhdl = convert(m, name="t", ports=[a, b, low, high])
        return dict(vhdl.entities["t"].signals)

    (wire, made) = next(item for item in names("kept").items() if item[0].startswith("$"))
    assert made.startswith("add_")
    taken = names(made)
    assert taken[made] == made and taken[wire] == f"{made}_2"


def test_only_what_nothing_else_reads_is_the_next_value_of_a_register() -> None:
    m = Module()
    ports = [Signal(8, name=name) for name in ("x", "y", "z", "a", "b", "c", "d")]
    x, y, z, a, b, c, d = ports
    shared, own, other = (x * y)[:4], (x * z)[:4], (y * z)[:4]
    m.d.comb += d.eq(other + x)
    m.d.sync += [
        x.eq(Cat(other, other)),
        a.eq(Cat(shared, y)),
        b.eq(Cat(shared, z)),
        c.eq(Cat(own, z)),
    ]
    with m.If(y[0]):
        m.d.sync += c.eq(Cat(own, y))
    text = convert(m, name="t", ports=ports).files["t.vhd"]
    assert "signal c_next_0 : unsigned(3 downto 0);\n" in text
    assert "signal a_next_0 : unsigned(3 downto 0);  -- also b_next_0\n" in text
    assert "x_next" not in text


def test_a_large_part_of_one_result_is_named_after_it() -> None:
    m = Module()
    a, b, c, o, p = ports = [Signal(8, name=name) for name in "abcop"]
    product, test = (a * b)[:8], (a[:4].all() & a[5:].any()) | a[4]
    m.d.comb += [o.eq(Mux(c[0], product[1:7], product[2:])), p.eq(Mux(test, Cat(test, b), c))]
    text = convert(m, name="t", ports=ports).files["t.vhd"]
    assert "signal o_part " in text and "signal a_7_0_test : std_logic" in text


def test_a_copy_that_nothing_reads_needs_no_signal_unless_tools_are_to_keep_it() -> None:
    m, (a, o) = Module(), (Signal(4, name="a"), Signal(4, name="o"))
    plain = Signal(4, name="plain")
    probe = Signal(4, name="probe", attrs={"keep": 1})
    m.d.comb += [o.eq(a + 1), plain.eq(a), probe.eq(a)]
    text = convert(m, name="t", ports=[a, o]).files["t.vhd"]
    assert "probe <= unsigned(a);" in text and "plain" not in text


def test_ports_that_are_parts_of_a_structure_have_the_names_of_its_fields() -> None:
    top, inner = Module(), Module()
    pair = Signal(data.StructLayout({"low": 1, "high": 1}), name="pair")
    a, b, o = ports = [Signal(name=name) for name in ("a", "b", "o")]
    inner.d.comb += o.eq(pair.low ^ pair.high)
    top.submodules.inner = inner
    top.d.comb += pair.eq(Cat(a ^ b, a & b))
    assert "pair_low" in convert(top, name="t", ports=ports).files["t_inner.vhd"]


def test_a_comment_says_where_the_fields_of_a_structure_are() -> None:
    shape = data.StructLayout({"first": 3, "last": 1, "rest": data.ArrayLayout(2, 4)})
    m, i, o = Module(), Signal(shape, name="i"), Signal(shape, name="o")
    m.d.sync += o.eq(i)
    text = convert(m, name="t", ports=[i.as_value(), o.as_value()]).files["t.vhd"]
    assert text.count("-- bits: first(2:0) last(3) rest(11:4)\n") == 1
    # The other port, and the register.
    assert text.count("  -- bits as of i\n") == 2


def test_a_disjunction_of_a_few_bits_is_named_after_them() -> None:
    m = Module()
    steps = [Signal(name=f"step_{name}") for name in "abcd"]
    outputs = [Signal(4, name=f"to_{name}") for name in "abcd"]
    either = Cat(steps[:2]).any()
    for signal, step in zip(outputs, steps, strict=True):
        m.d.comb += signal.eq(Mux(either, Cat(steps), step))
    text = convert(m, name="t", ports=[*steps, *outputs]).files["t.vhd"]
    assert "step_a_or_b <= step_a or step_b;" in text


def test_signals_inside_have_other_names_than_ports_whatever_their_case() -> None:
    m = Module()
    ports = {name: Signal(4, name=name) for name in ("Data", "sum", "Top")}
    inside = {name: Signal(4, name=name) for name in ("data", "SUM", "TOP", "Sum")}
    for port, signal in zip([*ports.values(), ports["Data"]], inside.values(), strict=True):
        m.d.sync += signal.eq(port)
    vhdl = convert(m, name="Top", ports=list(ports.values()))
    names = vhdl.entities["Top"]
    assert names.ports["Data"] == "Data" and names.ports["sum"] == "sum"
    given = [names.signals[name].lower() for name in (*ports, *inside)]
    assert len(set(given)) == len(given) and "top" not in given
