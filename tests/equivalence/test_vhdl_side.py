"""The VHDL as a flat circuit: instances in instances, and what no netlist of a design has."""

from __future__ import annotations

import re

import pytest

from firm_hdl.equivalence import ProofError
from firm_hdl.equivalence.vhdl_side import read_vhdl
from tests.equivalence.test_dump import DUMP

# `both` is a pair of the inverters `one` and `two`; GHDL numbers the nets of an entity once.
NESTED = r"""
module {m2} $top
  module {m100} \top
    input \a;
    input \b;
    output \y;
    output \z;
    instance \top{i2}: \top
      input \top.\y{p1} <- \both.\y{n5w1}
      input \top.\z{p2} <- \both.\z{n6w1}
      outputs \top.\a{n1w1} \top.\b{n2w1}
    instance \both{i5}: \pair
      input \both.\a{p5} <- \top.\a{n1w1}
      input \both.\b{p6} <- \top.\b{n2w1}
      outputs \both.\y{n5w1} \both.\z{n6w1}
  module {m101} \pair
    input \a;
    input \b;
    output \y;
    output \z;
    instance \pair{i7}: \pair
      input \pair.\y{p9} <- \one.\y{n4w1}
      input \pair.\z{p10} <- \two.\y{n11w1}
      outputs \pair.\a{n9w1} \pair.\b{n10w1}
    instance \one{i3}: \leaf
      input \one.\a{p4} <- \pair.\a{n9w1}
      outputs \one.\y{n4w1}
    instance \Two{i9}: \leaf
      input \Two.\a{p11} <- \pair.\b{n10w1}
      outputs \Two.\y{n11w1}
  module {m102} \leaf
    input \a;
    output \y;
    instance \leaf{i10}: \leaf
      input \leaf.\y{p12} <- \n.$o{n7w1}
      outputs \leaf.\a{n12w1}
    instance \n{i4}: $signal
      input \n.$i{p7} <- %9.$o{n8w1}
      outputs \n.$o{n7w1}
    instance %9{i6}: $not
      input %9.$i{p8} <- \leaf.\a{n12w1}
      outputs %9.$o{n8w1}
  instance $top{i1}: $top
"""
OWN = NESTED[NESTED.index("    instance \\top") : NESTED.index("    instance \\both")]
LEAF = NESTED[NESTED.index("  module {m102}") : NESTED.index("  instance $top")]


def changed(text, *changes):
    """Return a netlist with some of its lines replaced."""
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return text


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ([(LEAF, LEAF + LEAF.replace("leaf", "spare"))], "netlist has 2 outermost entities"),
        ([("\\one{i3}: \\leaf", "\\one{i3}: \\top")], "netlist has 0 outermost entities"),
        ([(OWN, "")], "GHDL's netlist has no content of top"),
        ([(LEAF, "")], "the VHDL has an instance of leaf, which is not in the design"),
        ([("\\one.\\y", "\\one.\\z")], "GHDL's instance one does not fit its module"),
        ([("\\one.\\a", "\\one.\\b")], "GHDL's instance one does not fit its module"),
        (
            [("\\leaf.\\a{n12w1}", "\\leaf.\\a{n12w2}")],
            "GHDL's netlist connects nets of different widths",
        ),
        ([("%9{i6}: $not", "\\n{i6}: $signal"), ("%9.", "\\n.")], "has two signals n"),
    ],
)
def test_a_netlist_that_contradicts_itself_is_refused(changes, message):
    with pytest.raises(ProofError, match=message):
        read_vhdl(changed(NESTED, *changes))


# GHDL prints the width of a net at each of its uses.
USES = [(found.start(), found.end()) for found in re.finditer(r"(?<=\{n)\d+w1(?=\})", NESTED)]


@pytest.mark.parametrize(("start", "end"), USES)
def test_a_net_has_one_width_wherever_it_is_used(start, end):
    for width in (0, 2, 3):
        other = f"{NESTED[:start]}{NESTED[start:end].removesuffix('1')}{width}{NESTED[end:]}"
        with pytest.raises(ProofError, match=r"has two widths|different widths|an unknown form"):
            read_vhdl(other)


def only_flop(circuit):
    """Return what the four bits of the register have in common."""
    flops = [circuit.flops[bit] for bit in circuit.outputs["o"]]
    [kept] = {(each.rising, each.reset, each.reset_level) for each in flops}
    return kept, [flop.init for flop in flops], [flop.reset_value for flop in flops]


RESET = [
    ("$idff\n", "$iadff\n"),
    (
        "      input %4.$init",
        "      input %4.$rst{p9} <- \\top.\\rst{n9w1}\n"
        "      input %4.$rst_val{p10} <- %3.$o{n5w4}\n      input %4.$init",
    ),
    ("    input \\clk;", "    input \\clk;\n    input \\rst;"),
    ("\\top.\\clk{n2w1}\n    instance", "\\top.\\clk{n2w1} \\top.\\rst{n9w1}\n    instance"),
]


def test_a_register_without_a_constant_initial_value_starts_with_any():
    plain = changed(DUMP, ("$idff\n", "$dff\n"), ("      input %4.$init{p6} <- %3.$o{n5w4}\n", ""))
    unknown = changed(DUMP, ("$const_UB32\n      parameters $val=5", "$const_X"))
    for text in (plain, unknown):
        assert only_flop(read_vhdl(text))[1] == ["x"] * 4


def test_a_reset_without_a_constant_value_is_refused():
    loads = [("%4.$rst_val{p10} <- %3.$o{n5w4}", "%4.$rst_val{p10} <- \\top.\\a{n1w4}")]
    with pytest.raises(ProofError, match="asynchronous reset of the VHDL has no constant value"):
        read_vhdl(changed(DUMP, *RESET, *loads))


def test_assertions_are_no_part_of_a_circuit():
    claim = "    instance %8{i9}: $assert\n      input %8.$cond{p9} <- %2.$o{n4w1}\n"
    more = changed(DUMP, ("    connect", claim + "    connect"))
    assert read_vhdl(more) == read_vhdl(DUMP)
