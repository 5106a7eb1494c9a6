"""The strict reader of GHDL's dump of a netlist."""

from __future__ import annotations

import re

import pytest

from firm_hdl.equivalence import ProofError
from firm_hdl.equivalence.dump import Net, parse_dump
from firm_hdl.equivalence.vhdl_side import read_vhdl

DUMP = r"""
module {m2} $top
  module {m9} $not
    input $i[?];
    output $o[?];
  module {m100} \top
    input \a[3:0];
    input \clk;
    output \o[3:0];
    # top.vhd:1:1
    instance \top{i2}: \top
      input \top.\o{p1} <- \r.$o{n7w4}
      outputs \top.\a{n1w4} \top.\clk{n2w1}
    instance %1{i3}: $not
      input %1.$i{p2} <- \top.\a{n1w4}
      outputs %1.$o{n3w4}
    instance %2{i4}: $posedge
      input %2.$i{p3} <- \top.\clk{n2w1}
      outputs %2.$o{n4w1}
    instance %3{i5}: $const_UB32
      parameters $val=5
      outputs %3.$o{n5w4}
    instance %4{i6}: $idff
      input %4.$clk{p4} <- %2.$o{n4w1}
      input %4.$d{p5} <- %1.$o{n3w4}
      input %4.$init{p6} <- %3.$o{n5w4}
      outputs %4.$q{n6w4}
    instance \r{i7}: $isignal
      input \r.$i{p7} <- %4.$q{n6w4}
      input \r.$init{p8} <- %3.$o{n5w4}
      outputs \r.$o{n7w4}
    connect \r.$o{n7w4} -> \top.\o{p1}
  instance $top{i1}: $top
"""


def test_modules_and_instances_are_read() -> None:
    (module,) = parse_dump(DUMP).values()
    assert module.ports == {"a": 4, "clk": 1, "o": 4}
    assert module.own is not None
    assert module.own.inputs == {"o": Net(7, 4)}
    assert [instance.kind for instance in module.instances][-2:] == ["$idff", "$isignal"]
    assert module.instances[2].parameters == (5,)


def test_a_width_may_be_behind_the_brace() -> None:
    text = re.sub(r"\{n(\d+)w(\d+)\}", r"{n\1}:\2", DUMP)
    assert text != DUMP
    assert parse_dump(text) == parse_dump(DUMP)


def test_registers_are_cut_out_with_their_initial_values() -> None:
    circuit = read_vhdl(DUMP)
    assert [cell.kind for cell in circuit.cells] == ["$not"]
    assert circuit.outputs["o"] == circuit.signals[("r",)]
    flops = [circuit.flops[bit] for bit in circuit.signals[("r",)] if isinstance(bit, int)]
    assert [flop.init for flop in flops] == list("1010")
    assert {flop.clock for flop in flops} == set(circuit.inputs["clk"])
    assert all(flop.rising for flop in flops)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("$not\n      input", "$gate\n      input", r"GHDL's netlist has \$gate, which a proof"),
        ("    # top.vhd:1:1", "    something else", "has an unknown line: 'something"),
        ("<- \\top.\\a{n1w4}", "<- ?", "has an unknown line"),
        ("%3.$o{n5w4}\n    instance %4", "%3.$o{n6w4}\n    instance %4", "drives a net twice"),
        (
            "      outputs %1.$o{n3w4}",
            "      input %1.$i{p2} <- \\top.\\a{n1w4}\n      outputs %1.$o{n3w4}",
            "has an unknown line: 'input %1",
        ),
        ("outputs %1.$o{n3w4}", "outputs %1.$o{n3w4} %1.$o{n8w4}", "has an unknown line: 'outputs"),
        ("      parameters $val=5", "      settings $val=5", "has an unknown line: 'settings"),
        ("    input \\clk;", "    inout \\clk;", "top has a port of mode inout"),
        ("<- %1.$o{n3w4}", "<- %1.$o{n3w5}", "GHDL's net 3 has two widths"),
        ("<- %2.$o{n4w1}", "<- \\top.\\clk{n2w1}", "a register of the VHDL has no clock edge"),
        ("%1.$i{p2} <- \\top.\\a{n1w4}", "%1.$i{p2} <- %5.$o{n9w3}", "an unknown form"),
        ("\\r.$i{p7} <- %4.$q{n6w4}", "\\r.$i{p7} <- \\r.$o{n7w4}", "is defined by itself"),
    ],
)
def test_unknown_syntax_is_an_error(old: str, new: str, message: str) -> None:
    assert old in DUMP
    with pytest.raises(ProofError, match=message):
        read_vhdl(DUMP.replace(old, new))


def test_an_empty_netlist_is_an_error() -> None:
    with pytest.raises(ProofError, match="empty"):
        parse_dump("module {m2} $top\n")
