"""Netlists that Amaranth 0.5 rarely prints, but the format allows: a wire with several readers."""

from __future__ import annotations

import re

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
ADD = r"""
  cell $add $2
    parameter \A_SIGNED 0
    parameter \B_SIGNED 0
    connect \A \a [3:0]
    connect \B \s [3:0]
    connect \Y $1
  end
"""
NEXT = r"""
  process $3
    assign $1 [3:0] \q [3:0]
    switch \s [0]
      case 1'1
        assign $1 [3:0] \a [3:0]
    end
  end
  cell $dff $4
    parameter \CLK_POLARITY 1
    connect \D $1 [3:0]
    connect \CLK \clk [0]
    connect \Q \q
  end
"""


def body_of(*parts: str) -> str:
    text = convert(HEAD + "\n".join(parts) + "\nend\n").files["top.vhd"]
    return text.partition("\nbegin\n")[2]


@pytest.mark.parametrize("targets", ["op", "po"])
def test_each_name_of_an_operator_is_driven(targets: str) -> None:
    first, second = targets
    body = body_of(ADD, *(rf"connect \{name} $1 [3:0]" for name in targets))
    assert f"  {first} <= std_logic_vector(unsigned(a) + unsigned(s));" in body
    assert f"  {second} <= std_logic_vector(unsigned({first}));" in body


def test_an_operator_for_a_part_of_a_port_is_written_to_that_part() -> None:
    body = body_of(
        ADD,
        r"connect \o [1:0] $1 [1:0]",
        r"connect \o [3:2] \a [1:0]",
        r"connect { \p [3:1] \p [0] } { \s [2:0] $1 [3] }",
    )
    parts = re.findall(r"^  ([op]\S*|o\(.*?\)|p\(.*?\)) <= (.*);$", body, re.MULTILINE)
    found = dict(parts)
    assert set(found) == {"o(1 downto 0)", "o(3 downto 2)", "p(3 downto 1)", "p(0)"}
    assert found["o(3 downto 2)"] == "std_logic_vector(unsigned(a(1 downto 0)))"
    assert found["p(3 downto 1)"] == "std_logic_vector(unsigned(s(2 downto 0)))"
    assert "o <=" not in body and "p <=" not in body


def test_a_part_of_a_folded_operator_is_no_whole_port() -> None:
    body = body_of(ADD, r"connect \o [1:0] $1 [1:0]", r"connect \p [3:2] \a [1:0]")
    assert "o <=" not in body
    (value,) = re.findall(r"^  o\(1 downto 0\) <= (.*);$", body, re.MULTILINE)
    assert value == "std_logic_vector(unsigned(a(1 downto 0)) + unsigned(s(1 downto 0)))"


def test_a_next_state_that_is_read_is_a_signal() -> None:
    body = body_of(NEXT, r"connect \o $1 [3:0]", r"connect \p \q [3:0]")
    assert (
        "  o <= std_logic_vector(unsigned(a)) when s(0) = '1' else\n       std_logic_vector(q);"
        in body
    )
    assert "q <= unsigned(o);" in body
    part = body_of(NEXT, r"connect \o { $1 [3:2] \a [1:0] }", r"connect \p \q [3:0]")
    assert "choice_1 <= unsigned(a) when s(0) = '1' else" in part
    assert "q <= choice_1;" in part


def test_a_next_state_that_only_its_register_reads_is_none() -> None:
    body = body_of(NEXT, r"connect \o \q [3:0]", r"connect \p \q [3:0]")
    assert "if s(0) = '1' then\n        q <= unsigned(a);\n      end if;" in body


def test_a_register_of_a_part_of_a_choice_is_no_next_state() -> None:
    part = NEXT.replace(r"connect \D $1 [3:0]", r"connect \D $1 [1:0]")
    part = part.replace(r"connect \Q \q", r"connect \Q \r").replace(r"\q [3:0]", r"\s [3:0]")
    wire = "attribute \\init 2'01\nwire width 2 \\r\n"
    body = body_of(wire, part, r"connect \o { \r [1:0] \r [1:0] }", r"connect \p \s [3:0]")
    assert "choice_1 <= unsigned(a) when s(0) = '1' else" in body
    assert "r <= choice_1(1 downto 0);" in body


def test_second_names_of_a_whole_signal_and_of_its_fields_are_left_out_and_others_are_not() -> None:
    names = {"q$1": 4, "q$2": 2, "x$3": 4, "q.low": 2, "x.low": 2, "q[0]": 1, "x[0]": 1}
    wires = (f"wire width {width} \\{name}" for name, width in names.items())
    same = (rf"connect \{name} \q [{width - 1}:0]" for name, width in names.items())
    body = body_of(*wires, NEXT, r"connect \o \q [3:0]", r"connect \p \q [3:0]", *same)
    assert re.findall(r"^  (\w+) <= (q.*);$", body, re.MULTILINE) == [
        ("q_2", "q(1 downto 0)"),
        ("x_3", "q"),
        ("x_low", "q(1 downto 0)"),
        ("x_0", "q(0)"),
    ]


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


@pytest.mark.parametrize(
    ("words", "text"),
    [
        ((0, 0, 0), "(others => (others => '0'))"),
        ((5, 6, 7), '( 0 => "0101", 1 => "0110", 2 => "0111" )'),
        # A comma separates the last word from what stands for the words that are 0.
        ((0, 6, 7), '( 1 => "0110", 2 => "0111", others => (others => \'0\') )'),
        ((5, 0, 0), "( 0 => \"0101\", others => (others => '0') )"),
    ],
)
def test_words_that_are_0_share_a_choice(words: tuple[int, ...], text: str) -> None:
    bits = "".join(f"{word:04b}" for word in reversed(words))
    memory = rf"""
  memory width 4 size 3 \m
  cell $meminit_v2 $i
    parameter \MEMID "\\m"
    connect \ADDR {{ }}
    connect \DATA 12'{bits}
    connect \EN 4'1111
  end
"""
    vhdl = convert(HEAD + ADD + memory + "connect \\o $1 [3:0]\nend\n").files["top.vhd"]
    assert f"signal m : m_array := {text};" in " ".join(vhdl.split())


@pytest.mark.parametrize("enable", ["0", "1"])
def test_a_read_port_that_is_never_enabled_keeps_its_value(enable: str) -> None:
    read = rf"""
  memory width 4 size 4 \m
  cell $memrd_v2 $r
    parameter \MEMID "\\m"
    parameter \CLK_ENABLE 1
    parameter \CLK_POLARITY 1
    connect \ADDR \a [1:0]
    connect \DATA \q
    connect \EN 1'{enable}
    connect \CLK \clk [0]
  end
"""
    assert ("q <= m(" in body_of(read, r"connect \o \q [3:0]")) == (enable == "1")


@pytest.mark.parametrize("kind", ["shl", "shr"])
def test_all_bits_of_a_distance_count_for_a_cut_result(kind: str) -> None:
    shift = rf"""
  wire width 2 $7
  cell ${kind} $8
    parameter \A_SIGNED 0
    parameter \B_SIGNED 0
    parameter \Y_WIDTH 2
    connect \A \a [1:0]
    connect \B \s [3:0]
    connect \Y $7
  end
"""
    assert "to_integer(unsigned(s))" in body_of(shift, r"connect \o { 2'00 $7 }")
    # A distance that is a result of an operator keeps its bits, too.
    summed = body_of(ADD, shift.replace(r"\B \s [3:0]", r"\B $1"), r"connect \o { 2'00 $7 }")
    assert "to_integer(unsigned(a) + unsigned(s))" in summed


def test_a_memory_without_bits_has_no_text() -> None:
    memory = r"""
  memory width 0 size 4 \m
  wire width 0 $5
  cell $memrd_v2 $6
    parameter \MEMID "\\m"
    parameter \CLK_ENABLE 0
    connect \ADDR \a [1:0]
    connect \DATA $5
    connect \EN 1'1
    connect \CLK 1'0
    connect \ARST 1'0
    connect \SRST 1'0
  end
"""
    text = convert(HEAD + ADD + memory + "connect \\o $1 [3:0]\nend\n").files["top.vhd"]
    assert "array" not in text and "unsigned(a) + unsigned(s)" in text


@pytest.mark.parametrize(("part", "is_guard"), [("$5", True), ("$5 [3:2]", False)])
def test_a_choice_of_a_part_of_a_quotient_is_no_guard(part: str, is_guard: bool) -> None:
    width = 4 if is_guard else 2
    division = rf"""
  wire width 4 $5
  wire width 1 $6
  wire width {width} $7
  cell $divfloor $8
    parameter \A_SIGNED 0
    parameter \B_SIGNED 0
    connect \A \a [3:0]
    connect \B \s [3:0]
    connect \Y $5
  end
  cell $reduce_bool $9
    parameter \A_SIGNED 0
    connect \A \s [3:0]
    connect \Y $6
  end
  cell $mux $10
    connect \A {width}'{"0" * width}
    connect \B {part}
    connect \S $6
    connect \Y $7
  end
"""
    rest = "$7 [3:0]" if is_guard else "{ $7 [1:0] 2'00 }"
    body = body_of(division, rf"connect \o {rest}", r"connect \p \s [3:0]")
    assert "floor_div(unsigned(a), unsigned(s))" in body
    # Without the choice, the quotient is the value of the port.
    assert ("divfloor_5(3 downto 2)" in body) == ("mux" in body) == (not is_guard)


ASYNCHRONOUS = r"""
  wire width 1 $5
  cell $and $6
    parameter \A_SIGNED 0
    parameter \B_SIGNED 0
    connect \A \a [0]
    connect \B \s [0]
    connect \Y $5
  end
  cell $adff $4
    parameter \CLK_POLARITY 1
    parameter \ARST_POLARITY 1
    parameter \ARST_VALUE 4'0101
    connect \D \a [3:0]
    connect \CLK \clk [0]
    connect \ARST $5
    connect \Q \q
  end
"""


def test_an_operator_that_only_resets_is_a_signal() -> None:
    body = body_of(ASYNCHRONOUS, r"connect \o \q [3:0]", r"connect \p \s [3:0]")
    (name,) = re.findall(r"process \(clk, (\w+)\)", body)
    assert f"  {name} <= a(0) and s(0);" in body
    assert f"if {name} = '1' then" in body


def test_each_part_of_a_target_has_its_part_of_the_value() -> None:
    chosen = r"""
  wire width 2 $5
  cell $mux $6
    parameter \WIDTH 2
    connect \A \a [1:0]
    connect \B \a [3:2]
    connect \S \s [0]
    connect \Y $5
  end
"""
    split = NEXT.replace(
        r"assign $1 [3:0] \a [3:0]", r"assign { $1 [3:2] $1 [1:0] } { \a [1:0] $5 [1:0] }"
    )
    body = body_of(chosen, split, r"connect \o \q [3:0]")
    lines = [line.strip() for line in body.splitlines() if "downto" in line]
    assert lines == [
        "q(1 downto 0) <= unsigned(a(3 downto 2));",
        "q(1 downto 0) <= unsigned(a(1 downto 0));",
        "q(3 downto 2) <= unsigned(a(1 downto 0));",
    ]
