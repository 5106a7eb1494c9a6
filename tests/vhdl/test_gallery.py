# amaranth: UnusedElaboratable=no
"""The VHDL of each design in the gallery is the text that was reviewed."""

from __future__ import annotations

import pytest
from amaranth.hdl import Module, Signal, signed
from amaranth.lib import enum

from firm_hdl.vhdl.convert import convert
from tests.vhdl.gallery import GALLERY, conditions, registers

SUBJECTS = [conditions, registers]


def test_every_subject_has_designs() -> None:
    assert {make.__module__ for make, _ in GALLERY.values()} == {each.__name__ for each in SUBJECTS}


@pytest.mark.parametrize("name", GALLERY)
def test_a_design_reads_as_if_written_by_hand(name: str) -> None:
    make, text = GALLERY[name]
    module, ports = make()
    whole = convert(module, name="t", ports=ports).files["t.vhd"]
    head, _, body = whole.partition("architecture rtl of t is\n")
    assert head.endswith("end entity;\n\n")
    assert body == f"{text}\nend architecture;\n"


@pytest.mark.parametrize("count", [8, 9])
def test_eight_names_of_values_fit_after_a_port_and_nine_do_not(count: int) -> None:
    kind = enum.Enum("Kind", {f"A{n}": n for n in range(count)})
    m, i, o = Module(), Signal(kind, name="i"), Signal(signed(4), name="o")
    m.d.comb += o.eq(i)
    text = convert(m, name="t", ports=[i, o]).files["t.vhd"]
    names = ", ".join(f"{n} A{n}" for n in range(count))
    assert (f";  -- {names}\n" in text) == (count == 8)
    assert ("A0" in text) == (count == 8)
    assert "o : out std_logic_vector(3 downto 0)" in text and "  -- signed" in text
