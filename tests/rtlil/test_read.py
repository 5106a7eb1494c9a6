# amaranth: UnusedElaboratable=no
"""The reader of RTLIL: everything that Amaranth prints, and errors for other input."""

from __future__ import annotations

import pytest
from amaranth.back import rtlil as amaranth_rtlil
from amaranth.hdl import Instance, Module, Signal

from firm_hdl.rtlil.ir import (
    Assign,
    Bits,
    Cell,
    Process,
    Slice,
    Switch,
    bits_of,
    cut,
    join,
    spec_width,
)
from firm_hdl.rtlil.read import parse

HEAD = "attribute \\top 1\nmodule \\top\n"
WIRES = "wire width 4 \\a\nwire width 4 input 0  signed \\b\nwire width 4 $1\n"


def one(text: str) -> Cell | Process:
    (item,) = parse(f"{HEAD}{WIRES}{text}\nend\n").top.items
    return item


def test_the_first_line_counts() -> None:
    with pytest.raises(ValueError, match=r"^RTLIL line 1: expected a module, not 'wires'$"):
        parse(f"wires\n{HEAD}end\n")


def test_reads_wires_with_attributes() -> None:
    text = 'attribute \\init 4\'0101\nattribute \\note "say \\"a\\"\\n"\nwire width 4 \\c\n'
    wires = parse(f"{HEAD}{WIRES}{text}end\n").top.wires
    assert [wire.name for wire in wires.values()] == ["a", "b", "$1", "c"]
    assert wires["c"].attributes == {"init": Bits("0101"), "note": 'say "a"\n'}
    assert (wires["b"].direction, wires["b"].signed) == ("input", True)
    # An attribute belongs to the next wire only.
    assert parse(f"{HEAD}{text}wire width 1 \\d\nend\n").top.wires["d"].attributes == {}


def test_attributes_belong_to_the_next_module_only() -> None:
    design = parse("attribute \\keep 1\nmodule \\a\nend\nmodule \\b\nend\n")
    assert [module.attributes for module in design.modules.values()] == [{"keep": 1}, {}]


def test_the_top_is_the_marked_module_or_else_the_first() -> None:
    first, marked = "module \\a\nend\n", "attribute \\top 1\nmodule \\b\nend\n"
    last = "module \\c\nend\n"
    assert parse(first + marked + last).top.name == "b"
    assert parse(first + last).top.name == "a"


@pytest.mark.parametrize("separator", ["\x0b", "\x0c", "\x1c", "\x85", "\u2028"])
def test_only_line_feeds_end_a_line(separator: str) -> None:
    wires = parse(f'{HEAD}attribute \\note "a{separator}b"\nwire width 4 \\c\nend\n').top.wires
    assert wires["c"].attributes == {"note": f"a{separator}b"}


def test_reads_specifications_least_significant_first() -> None:
    cell = one(
        "cell $and $2\nconnect \\A { \\a [3:2] 2'01 }\nconnect \\B \\b [1]\nconnect \\Y $1\nend"
    )
    assert isinstance(cell, Cell)
    assert cell.ports["A"] == (Bits("01"), Slice("a", 2, 2))
    assert cell.ports["B"] == (Slice("b", 1, 1),)
    assert cell.ports["Y"] == (Slice("$1", 0, 4),)
    assert cell.line == 6


def test_reads_processes() -> None:
    process = one(
        "process $2\nassign $1 [3:0] 4'0000\nswitch \\a [1:0]\ncase 2'0-, 2'11\n"
        "assign $1 [3:0] \\b [3:0]\ncase\nend\nend"
    )
    assert isinstance(process, Process)
    assert process.line == 6
    default, switch = process.body
    assert default == Assign(target=(Slice("$1", 0, 4),), value=(Bits("0000"),))
    assert isinstance(switch, Switch)
    assert [case.patterns for case in switch.cases] == [("0-", "11"), ()]


def test_a_constant_is_extended_by_its_first_digit() -> None:
    text = "wire width 4 \\a\nconnect \\a 4'%s"
    for digits, bits in [("01", "0001"), ("11", "0011"), ("0", "0000"), ("x1", "xxx1")]:
        design = parse(f"attribute \\top 1\nmodule \\m\n{text % digits}\nend\n")
        assert design.top.connections == (((Slice("a", 0, 4, True),), (Bits(bits),)),)


def test_reads_what_amaranth_prints_of_an_instance() -> None:
    module, value = Module(), Signal(4)
    module.submodules.unit = Instance(
        "unit", p_number=-5, p_text='a "b"', p_real=1.5, i_x=value[:2], o_y=Signal(3, name="y")
    )
    text = amaranth_rtlil.convert(module, ports=[value])
    (cell,) = (item for item in parse(text).top.items if isinstance(item, Cell))
    assert cell.parameters == {"number": -5, "text": 'a "b"', "real": 1.5}
    assert {name: spec_width(spec) for name, spec in cell.ports.items()} == {"x": 2, "y": 3}
    (chunk,) = cell.ports["y"]
    assert isinstance(chunk, Slice) and chunk.bare


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("cell $pow $2\nend", r"^RTLIL line 6: Amaranth 0\.5 emits no cells of kind \$pow$"),
        ("wire \\x", r"^RTLIL line 6: malformed wire 'wire \\\\x'$"),
        ("wire width 1 \\a", r"^RTLIL line 6: wire 'a' is declared twice$"),
        ("connect \\a \\b [1:0]", r"^RTLIL line 6: widths 4 and 2 differ$"),
        ("connect \\a \\c [3:0]", r"^RTLIL line 6: no wire 'c'$"),
        ("connect \\a \\b [4:1]", r"^RTLIL line 6: slice \[4:1\] is out of range$"),
        ("connect \\a 1'01", r"^RTLIL line 6: constant 1'01 has 2 bits$"),
        ("process $2\nswitch \\a\ncase 2'01\nend\nend", r"^RTLIL line 8: pattern .* does not fit"),
        ("process $2\nsync always\nend", r"^RTLIL line 7: unexpected 'sync always' in a process$"),
        ("connect { \\a \\b", r"^RTLIL line 6: malformed signal '\{ \\\\a \\\\b'$"),
        ("cell $not $2\nconnect \\A { \\a\nend", r"^RTLIL line 7: malformed signal '\{ \\\\a'$"),
        # A slice of a slice, two values without braces, a brace too many.
        ("connect \\a \\b [3:0] [3:0]", r"^RTLIL line 6: malformed signal"),
        ("connect \\a 4'0000 [3:0]", r"^RTLIL line 6: malformed signal"),
        ("connect \\a [1:2] \\b", r"^RTLIL line 6: slice \[1:2\] is out of range$"),
        ("cell $not $2\nconnect \\A \\a \\b\nend", r"^RTLIL line 7: malformed signal"),
        ("cell $not $2\nconnect \\A\nend", r"^RTLIL line 7: (malformed|unexpected)"),
        ("connect \\a { \\b } }", r"^RTLIL line 6: malformed signal"),
        ("cell $not $2\nsync always\nend", r"^RTLIL line 7: unexpected 'sync always' in a cell$"),
        ("cell $not", r"^RTLIL line 6: malformed cell 'cell \$not'$"),
        ("memory width 4 \\m", r"^RTLIL line 6: malformed memory 'memory width 4 \\\\m'$"),
        ("attribute \\init", r"^RTLIL line 6: malformed 'attribute \\\\init'$"),
        ('attribute \\init 0"', r"^RTLIL line 6: malformed constant '0\"'$"),
        ("attribute \\init 2'011", r'^RTLIL line 6: malformed constant "2\'011"$'),
        ("process $2\nswitch \\a\nassign \\a \\b", r"^RTLIL line 8: expected a case, not 'assign"),
        ("process $2\nswitch \\a\ncase 5'00001\nend\nend", r"^RTLIL line 8: pattern .* does not"),
        ("sync always", r"^RTLIL line 6: unexpected 'sync always' in a module$"),
        ("cell $not $2", r"^RTLIL line \d+: unexpected|the text ends inside a block$"),
    ],
)
def test_refuses_with_a_line_number(text: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        parse(f"{HEAD}{WIRES}{text}\nend\n")


def test_cuts_and_joins() -> None:
    spec = (Bits("01"), Slice("a", 4, 4))
    assert cut(spec, 1, 3) == (Bits("0"), Slice("a", 4, 2))
    assert join((Slice("a", 0, 2),), (Slice("a", 2, 1),), (Bits("1"),), (Bits("0"),)) == (
        Slice("a", 0, 3),
        Bits("01"),
    )


def test_constants_are_bits_and_nothing_else_is() -> None:
    assert bits_of((Bits("01"), Bits("1x"))) == "1x01"
    assert bits_of(()) == ""
    for other in ((Slice("a", 0, 1), Bits("1")), (Bits("1"), Slice("a", 0, 1))):
        assert bits_of(other) is None
