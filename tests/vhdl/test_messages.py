"""Formats of `Print`, and the conditions and texts of `Assert`, `Assume` and `Cover`."""

from __future__ import annotations

import re
from typing import Any

import pytest
from amaranth.hdl import (
    Assert,
    Assume,
    Cat,
    ClockDomain,
    Const,
    Cover,
    Format,
    Module,
    Print,
    Signal,
)

from firm_hdl.vhdl.convert import convert

A, S, NONE = Signal(12, name="a"), Signal(8, name="s"), Signal(0, name="none")
PORTS = [A, S, Signal(name="e")]


def architecture(statement: Any, domain: str = "comb", edge: str = "pos") -> str:
    """Return the text of a design with a statement, in a line."""
    module = Module()
    ports = list(PORTS)
    if domain == "sync":
        clocked = ClockDomain("sync", clk_edge=edge, reset_less=True)
        module.domains += clocked
        ports.append(clocked.clk)
    with module.If(PORTS[2]):
        module.d[domain] += statement
    text = convert(module, ports=ports).files["top.vhd"]
    return re.sub(r"\n+ *", " ", text.partition("\nbegin\n")[2])


@pytest.mark.parametrize(
    ("form", "text"),
    [
        (Format("{:d}", A), "to_decimal(unsigned(a))"),
        (Format("{}", A), "to_decimal(unsigned(a))"),
        (Format("{:d}", A.as_signed()), "to_decimal(signed(unsigned(a)))"),
        (Format("{:b}", A), "to_string(unsigned(a))"),
        (Format("{:o}", A), "to_ostring(unsigned(a))"),
        (Format("{:x}", A), "to_hstring(unsigned(a))"),
        (Format("{:X}", A), "to_hstring(unsigned(a))"),
        # Fields have no width here.
        (Format("{:>+12d}", A), "to_decimal(unsigned(a))"),
        (Format("{:#06x}", A), "to_hstring(unsigned(a))"),
        (Format("{:c}", S), "to_characters(unsigned(s))"),
        # A character has eight bits.
        (Format("{:c}", A), "to_characters(unsigned(a(7 downto 0)))"),
        (Format("{:c}", A[:3]), "to_characters(resize(unsigned(a(2 downto 0)), 8))"),
        # The first character of a string is in the lowest bits, as in Amaranth's simulator.
        (Format("{:s}", Const(0x43_42_41, 24)), 'to_characters(unsigned\'(x"414243"))'),
        (
            Format("{:s}", Cat(S, A[:8])),
            "to_characters(unsigned'(unsigned(s) & unsigned(a(7 downto 0))))",
        ),
        (Format("{}", NONE), '"0"'),
        # Each field has its own bits.
        (
            Format("{:d} of {:x}, {:b}", S, A, A[:3]),
            'to_decimal(unsigned(s)) & " of " & to_hstring(unsigned(a)) & ", " & '
            "to_string(unsigned(a(2 downto 0)))",
        ),
        (Format("{{{:d}}} {{}}", S), '"{" & to_decimal(unsigned(s)) & "} {}"'),
        (Format('"{:d}"', S), '"""" & to_decimal(unsigned(s)) & """"'),
        (
            Format("\t{:d}\n.", S),
            "character'val(9) & to_decimal(unsigned(s)) & character'val(10) & \".\"",
        ),
        (Format("ö {:d}", S), '"? " & to_decimal(unsigned(s))'),
    ],
)
def test_a_format_is_an_expression(form: Format, text: str) -> None:
    assert f"report {text} severity note;" in architecture(Print(form))


@pytest.mark.parametrize(
    ("words", "end", "text"),
    [
        (["one", "two"], "\n", '"one two"'),
        (["  one  "], "\n", '"  one  "'),
        # Only the end of the line is left out, because a report has its own.
        (["one\n"], "\n", '"one" & character\'val(10)'),
        (["one"], "", '"one"'),
        ([""], "\n", '""'),
    ],
)
def test_all_of_a_line_is_reported(words: list[str], end: str, text: str) -> None:
    assert f"report {text} severity note;" in architecture(Print(*words, end=end))


@pytest.mark.parametrize(
    ("statement", "text"),
    [
        (Assert(A == 1), '"assertion failed in top"'),
        (Assume(A == 1), '"assumption failed in top"'),
        (Assert(A == 1, "too far"), '"too far"'),
        (Assume(A == 1, Format("at {}", A)), '"at " & to_decimal(unsigned(a))'),
    ],
)
def test_what_does_not_hold_is_an_error(statement: Any, text: str) -> None:
    found = architecture(statement)
    assert f"assert unsigned(a) = 1 report {text} severity error;" in found
    # Where its condition is met, and when all signals have settled.
    assert "postponed process (all) begin if " in found


def test_a_cover_is_a_comment() -> None:
    found = architecture(Cover(A == 1))
    assert "-- Cover: to_std_logic(unsigned(a) = 1)" in found
    assert "assert" not in found and "translate_off" not in found


@pytest.mark.parametrize(("edge", "function"), [("pos", "rising_edge"), ("neg", "falling_edge")])
def test_a_message_with_a_clock_comes_at_its_edge(edge: str, function: str) -> None:
    found = architecture(Print("here"), "sync", edge)
    assert f"process (clk) begin if {function}(clk) and " in found
    assert "postponed" not in found
    # Synthesis sees none of it.
    assert found.index("translate_off") < found.index("process (clk)")
    assert found.index("end process") < found.index("translate_on")
