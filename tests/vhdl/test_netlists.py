"""Netlists that Amaranth 0.5 rarely prints, but the format allows: a wire with several readers."""

from __future__ import annotations

import pytest

from firm_hdl.vhdl.convert import convert

HEAD = r"""
attribute \top 1
module \top
  wire width 1 input 0 \clk
  wire width 4 input 1 \a
  wire width 4 input 2 \s
  wire width 4 output 3 \o
  wire width 4 output 4 \p
  attribute \init 4'0101
  wire width 4 \q
  wire width 4 $1
"""


def body_of(*parts: str) -> str:
    text = convert(HEAD + "\n".join(parts) + "\nend\n").files["top.vhd"]
    return text.partition("\nbegin\n")[2]


def test_a_read_port_is_transparent_for_the_ports_in_its_mask_only() -> None:
    ports = [
        rf"""
  cell $memwr_v2 $w{number}
    parameter \MEMID "\\m"
    parameter \PORTID {number}
    parameter \CLK_POLARITY 1'1
    connect \ADDR \a [1:0]
    connect \DATA \{name} [3:0]
    connect \EN {{ \s [{number}] \s [{number}] \s [{number}] \s [{number}] }}
    connect \CLK \clk [0]
  end
"""
        for number, name in enumerate("asas")
    ]
    read = r"""
  cell $memrd_v2 $r
    parameter \MEMID "\\m"
    parameter \TRANSPARENCY_MASK 4'0010
    parameter \CLK_ENABLE 1
    parameter \CLK_POLARITY 1'1
    connect \ADDR \s [1:0]
    connect \DATA \q
    connect \EN 1'1
    connect \CLK \clk [0]
  end
"""
    body = body_of("memory width 4 size 4 \\m", *ports, read, r"connect \o \q [3:0]")
    start = "if unsigned(s(1 downto 0)) = unsigned(a(1 downto 0)) and s({}) = '1' then"
    assert [f"{start.format(n)}  -- transparent" in body for n in range(4)] == [
        False,
        True,
        False,
        False,
    ]


@pytest.mark.parametrize(
    ("write_at", "forwards"),
    [("2'01", "q <="), ("2'10", ""), ("\\a [1:0]", 'if unsigned\'("01") = unsigned(a')],
)
def test_ports_with_constant_addresses_meet_always_or_never(write_at: str, forwards: str) -> None:
    ports = rf"""
  memory width 4 size 4 \m
  cell $memwr_v2 $w
    parameter \MEMID "\\m"
    parameter \PORTID 0
    parameter \CLK_POLARITY 1'1
    connect \ADDR {write_at}
    connect \DATA \a [3:0]
    connect \EN 4'1111
    connect \CLK \clk [0]
  end
  cell $memrd_v2 $r
    parameter \MEMID "\\m"
    parameter \TRANSPARENCY_MASK 1'1
    parameter \CLK_ENABLE 1
    parameter \CLK_POLARITY 1'1
    connect \ADDR 2'01
    connect \DATA \q
    connect \EN 1'1
    connect \CLK \clk [0]
  end
"""
    body = body_of(ports, r"connect \o \q [3:0]")
    _, read, after = body.partition("q <= m(1);\n")
    assert read and after.partition("end if;")[0].strip().startswith(forwards)
    assert ("q <= unsigned(a);" in after) == bool(forwards)
