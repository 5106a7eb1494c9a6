"""Proofs of designs with memories: equal designs are proved, broken ones are not."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

from firm_hdl.equivalence import ProofError, Tools, prove
from firm_hdl.equivalence.memories import MemoryCircuit
from firm_hdl.equivalence.miter import make_miter
from firm_hdl.equivalence.proof import solve
from firm_hdl.equivalence.rtlil_side import read_rtlil
from firm_hdl.vhdl.convert import Vhdl, convert
from tests.depth import by_depth
from tests.rtlil.memory_designs import DESIGNS, Store, random_stores, rtlil_of

FULL = {"mem": Store(depth=5, init=[1, 2, 3], granularity=4, reads=("comb", "transparent"))}
TWO = {"mem": Store(depth=4, writes=2)}


@cache
def _full_design(deep: bool = False) -> tuple[str, Vhdl]:
    text = rtlil_of(FULL, deep=deep)
    return text, convert(text, name="stores")


@pytest.mark.parametrize("name", DESIGNS)
@pytest.mark.sampled(16)
def test_memories_are_proved_equal(name: str, tools: Tools) -> None:
    proof = prove(rtlil_of(DESIGNS[name]), convert(rtlil_of(DESIGNS[name])), tools=tools)
    assert proof.result == "equal", proof
    assert proof.unmatched == ()
    words = [s.depth * (s.shape if isinstance(s.shape, int) else 9) for s in DESIGNS[name].values()]
    if name != "contents alone":
        assert proof.registers >= sum(words)


@pytest.mark.parametrize("seed", range(by_depth(2, 6)))
@pytest.mark.sampled(2)
def test_random_memories_are_proved_equal(seed: int, tools: Tools) -> None:
    text = rtlil_of(random_stores(seed))
    proof = prove(text, convert(text), tools=tools)
    assert proof.result == "equal", proof


@pytest.mark.thorough
def test_memories_of_inner_modules_are_proved_equal(tools: Tools) -> None:
    text, vhdl = _full_design(deep=True)
    proof = prove(text, vhdl, tools=tools)
    assert (proof.result, proof.registers, proof.unmatched) == ("equal", 5 * 8 + 8, ())


# Each twin is the VHDL with this one change.
VHDL_TWINS = {
    "another write address": ("mem(to_integer(unsigned(mem_w0_addr)))(3", "mem(0)(3"),
    "the write address of a read port": (
        "mem(to_integer(unsigned(mem_w0_addr)))(7",
        "mem(to_integer(unsigned(mem_r0_addr)))(7",
    ),
    "another read address": (
        "std_logic_vector(mem(to_integer(unsigned(mem_r0_addr))))",
        "std_logic_vector(mem(to_integer(unsigned(mem_r1_addr))))",
    ),
    "another address of the register": (
        "mem_r1_data_q <= mem(to_integer(unsigned(mem_r1_addr)))",
        "mem_r1_data_q <= mem(to_integer(unsigned(mem_r0_addr)))",
    ),
    "another enable": ("if mem_w0_en(0) = '1' and unsigned", "if mem_w0_en(1) = '1' and unsigned"),
    "no enable": ("if mem_w0_en(0) = '1' and unsigned", "if unsigned"),
    "an inverted enable": (
        "if mem_w0_en(1) = '1' and unsigned",
        "if mem_w0_en(1) = '0' and unsigned",
    ),
    "no enable of the register": ("if mem_r1_en = '1' then", "if mem_r1_en /= 'U' then"),
    "another initial value": ('1 => "00000010"', '1 => "00000011"'),
    "another initial value of the rest": (
        "others => (others => '0')\n  );",
        "others => (others => '1')\n  );",
    ),
    "another initial value of the register": (
        "mem_r1_data_q : unsigned(7 downto 0) := (others => '0')",
        "mem_r1_data_q : unsigned(7 downto 0) := (others => '1')",
    ),
    "initial values in another order": ('0 => "00000001",\n    1', '1 => "00000001",\n    0'),
    "no initial values": (
        ' := (\n    0 => "00000001",\n    1 => "00000010",\n    2 => "00000011",\n'
        "    others => (others => '0')\n  )",
        "",
    ),
    "a missing word": ("array (0 to 4)", "array (0 to 3)"),
    "one word more": ("array (0 to 4)", "array (0 to 5)"),
    "words in another order": ("array (0 to 4)", "array (4 downto 0)"),
    "a missing bit of a word": (
        "<= unsigned(mem_w0_data(3 downto 0));\n      end if;\n      if mem_w0_en(1)",
        "<= '0' & unsigned(mem_w0_data(2 downto 0));\n      end if;\n      if mem_w0_en(1)",
    ),
    "a swapped lane": (
        "(3 downto 0) <= unsigned(mem_w0_data(3 downto 0));\n      end if;\n      if",
        "(3 downto 0) <= unsigned(mem_w0_data(7 downto 4));\n      end if;\n      if",
    ),
    "a lane at another place": (
        "mem(to_integer(unsigned(mem_w0_addr)))(3 downto 0) <=",
        "mem(to_integer(unsigned(mem_w0_addr)))(7 downto 4) <=",
    ),
    "the last word is not written": (
        "en(0) = '1' and unsigned(mem_w0_addr) < 5",
        "en(0) = '1' and unsigned(mem_w0_addr) < 4",
    ),
    "the last word is not read": ("\n      < 5 else", "\n      < 4 else"),
    "1 beyond the last word": ("< 5 else (others => '0')", "< 5 else (others => '1')"),
    "1 beyond the last word in the register": (
        "mem_r1_data_q <= (others => '0')",
        "mem_r1_data_q <= (others => '1')",
    ),
    "the other edge": (
        "if rising_edge(clk) then\n      if mem_w0_en",
        "if falling_edge(clk) then\n      if mem_w0_en",
    ),
    "not transparent for a lane": (
        "unsigned(mem_w0_addr) and mem_w0_en(0) = '1' then  -- transparent",
        "unsigned(mem_w0_addr) and mem_w0_en(0) = 'U' then",
    ),
    "transparent at another address": (
        "if unsigned(mem_r1_addr) = unsigned(mem_w0_addr) and mem_w0_en(1)",
        "if unsigned(mem_r0_addr) = unsigned(mem_w0_addr) and mem_w0_en(1)",
    ),
    "transparent with other data": (
        "mem_r1_data_q(7 downto 4) <= unsigned(mem_w0_data(7 downto 4))",
        "mem_r1_data_q(7 downto 4) <= unsigned(mem_w0_data(3 downto 0))",
    ),
}


@pytest.mark.parametrize("what", [*VHDL_TWINS][:: by_depth(7, 1)])
@pytest.mark.sampled(4)
def test_a_change_of_the_vhdl_is_found(what: str, tools: Tools) -> None:
    text, vhdl = _full_design()
    old, new = VHDL_TWINS[what]
    body = vhdl.files["stores.vhd"]
    assert body.count(old) == 1
    files = {**vhdl.files, "stores.vhd": body.replace(old, new)}
    try:
        proof = prove(text, replace(vhdl, files=files), tools=tools)
    except ProofError as error:
        # A memory of another size has other words, so `prove` raises an error.
        assert what == "a missing word" or what == "one word more"
        assert str(error) == "memory mem of the VHDL has not 5 words"
    else:
        assert proof.result == "unequal", what
        assert proof.differences


# The number of the occurrence that changes, the old text, and the new text.
RTLIL_TWINS = {
    "another write address": (
        0,
        r"connect \ADDR \mem_w0_addr [2:0]",
        r"connect \ADDR \mem_r0_addr [2:0]",
    ),
    "another read address": (
        0,
        r"connect \ADDR \mem_r0_addr [2:0]",
        r"connect \ADDR \mem_w0_addr [2:0]",
    ),
    "another enable": (0, r"{ \mem_w0_en [1] ", r"{ \mem_w0_en [0] "),
    "swapped data": (
        0,
        r"\DATA \mem_w0_data [7:0]",
        r"\DATA { \mem_w0_data [3:0] \mem_w0_data [7:4] }",
    ),
    "another initial value": (0, "0000001100000010", "0000001100000000"),
    "the other edge": (0, r"\CLK_POLARITY 1", r"\CLK_POLARITY 0"),
    "the other edge of the register": (2, r"\CLK_POLARITY 1", r"\CLK_POLARITY 0"),
    "not transparent": (0, r"\TRANSPARENCY_MASK 1'1", r"\TRANSPARENCY_MASK 1'0"),
    "no enable of the register": (0, r"\EN \mem_r1_en [0]", r"\EN 1'1"),
}


@pytest.mark.parametrize("what", RTLIL_TWINS)
@pytest.mark.sampled(9)
def test_a_change_of_the_rtlil_is_found(what: str, tools: Tools) -> None:
    text, vhdl = _full_design()
    number, old, new = RTLIL_TWINS[what]
    proof = prove(_replace_nth(text, old, new, number), vhdl, tools=tools)
    assert proof.result == "unequal", what


@pytest.mark.thorough
def test_two_writes_of_one_word_happen_in_order(tools: Tools) -> None:
    text = rtlil_of(TWO)
    vhdl = convert(text, name="stores")
    first, second = re.findall(
        r"      if mem_w\d_en = '1' then\n.*?end if;\n", vhdl.files["stores.vhd"], re.DOTALL
    )
    assert prove(text, vhdl, tools=tools).result == "equal"
    swapped = vhdl.files["stores.vhd"].replace(first + second, second + first)
    assert swapped != vhdl.files["stores.vhd"]
    broken = replace(vhdl, files={**vhdl.files, "stores.vhd": swapped})
    assert prove(text, broken, tools=tools).result == "unequal"


def test_a_counterexample_names_the_word(tools: Tools) -> None:
    text, vhdl = _full_design(deep=True)
    body = vhdl.files["stores_inner.vhd"]
    broken, count = re.subn(r"(_en\(\d\) = '1' and \w+_addr <) 5 then", r"\1 4 then", body)
    assert count == 2
    files = {**vhdl.files, "stores_inner.vhd": broken}
    proof = prove(text, replace(vhdl, files=files), tools=tools)
    assert proof.differences[0].startswith("next state of inner.mem[4] is ")
    assert proof.counterexample["input mem_w0_addr"] == 4


# Yosys leaves reads beyond the last word undefined, and gives the words of contents no names.
@pytest.mark.parametrize(
    "name",
    sorted(set(DESIGNS) - {"odd depth", "transparent", "contents alone", "several"})[
        :: by_depth(6, 1)
    ],
)
@pytest.mark.sampled(2)
def test_yosys_makes_the_same_registers_of_a_memory(
    name: str, tools: Tools, tmp_path: Path
) -> None:
    """Up to the last word, memories have the meaning that Yosys' `memory_map` gives them."""
    assert _as_yosys_maps_it(rtlil_of(DESIGNS[name]), rtlil_of(DESIGNS[name]), tools, tmp_path)


@pytest.mark.thorough
def test_yosys_makes_other_registers_of_another_memory(tools: Tools, tmp_path: Path) -> None:
    text = rtlil_of(FULL | {"mem": replace(FULL["mem"], depth=8)})
    assert _as_yosys_maps_it(text, text, tools, tmp_path)
    for what, (number, old, new) in RTLIL_TWINS.items():
        # Yosys stops at a port that is transparent for one of another clock.
        if old in text and not what.startswith("the other edge"):
            assert not _as_yosys_maps_it(
                text, _replace_nth(text, old, new, number), tools, tmp_path
            )


def _as_yosys_maps_it(text: str, other: str, tools: Tools, folder: Path) -> bool:
    """Return whether a memory equals the registers that Yosys makes of another one."""
    # A register without an initial value has no name in Yosys.
    text, other = (re.sub(r"(INIT_VALUE \d+')x+", r"\g<1>0", each) for each in (text, other))
    (folder / "in.il").write_text(other, encoding="utf-8")
    script = "proc -noopt; flatten; memory_collect; memory_map; dffunmap; opt_clean"
    tools.run_yosys(folder, f"read_rtlil in.il; {script}; write_rtlil out.il", None)
    ours = read_rtlil(text, tools, folder, None)
    theirs = read_rtlil((folder / "out.il").read_text(encoding="utf-8"), tools, folder, None)
    miter = make_miter(ours, theirs, ports={}, signals={path: path for path in ours.signals})
    return not miter.differences and bool(solve(miter, tools, folder, 60).equal)


# RTLIL of memories that Amaranth never prints.
REFUSED = {
    "contents in parts": (0, "\\EN 8'11111111", "\\EN 8'11111110"),
    "contents that are not constant": (0, "40'00000000", "40'0000000z"),
    "a write port without a clock": (0, "\\CLK_ENABLE 1", "\\CLK_ENABLE 0"),
    "write ports without consecutive numbers": (0, "\\PORTID 0", "\\PORTID 1"),
    "a read port with a reset": (0, "\\SRST 1'0", "\\SRST \\rst [0]"),
    "a read port with collisions": (0, "\\COLLISION_X_MASK 1'0", "\\COLLISION_X_MASK 1'1"),
    "a transparent read port without a clock": (
        0,
        "\\TRANSPARENCY_MASK 1'0",
        "\\TRANSPARENCY_MASK 1'1",
    ),
}


@pytest.mark.sampled(3)
@pytest.mark.parametrize("what", REFUSED)
def test_memories_that_amaranth_never_prints_are_refused(what: str, tools: Tools) -> None:
    text, vhdl = _full_design()
    number, old, new = REFUSED[what]
    with pytest.raises(
        ProofError, match=rf"^memory mem has {what}, which a proof does not support$"
    ):
        prove(_replace_nth(text, old, new, number), vhdl, tools=tools)


def test_contents_that_come_twice_are_refused(tools: Tools) -> None:
    text, vhdl = _full_design()
    (cell,) = re.findall(r"^ *cell \$meminit_v2 .*?^ *end\n", text, re.MULTILINE | re.DOTALL)
    again = re.sub(r"(cell \S+ )\S+", r"\1\\again", cell, count=1)
    with pytest.raises(ProofError, match=r"^memory mem has contents in parts, which a proof"):
        prove(text.replace(cell, cell + again), vhdl, tools=tools)


def test_ports_wider_than_their_memory_are_refused() -> None:
    memory = MemoryCircuit("mem", 4, 2, lambda width: tuple(range(2, 2 + width)))
    port = {"type": "$memrd_v2", "parameters": {"WIDTH": "1000"}, "connections": {}}
    with pytest.raises(ProofError, match=r"^memory mem has ports of two widths, which a proof"):
        memory.add([port], tuple)


def test_write_ports_of_two_clocks_are_refused(tools: Tools) -> None:
    text = rtlil_of(TWO)
    broken = _replace_nth(text, r"connect \CLK \clk [0]", r"connect \CLK \rst [0]", 1)
    with pytest.raises(ProofError, match="write ports with several clocks"):
        prove(broken, convert(text), tools=tools)


def _replace_nth(text: str, old: str, new: str, number: int) -> str:
    """Replace one of several places."""
    parts = text.split(old)
    assert len(parts) > number + 1
    return old.join(parts[: number + 1]) + new + old.join(parts[number + 1 :])


@pytest.mark.parametrize(("script", "kind"), [("memory_collect", "mem_v2"), ("opt_dff", "dffe")])
def test_registers_of_other_kinds_are_refused(
    script: str, kind: str, tools: Tools, tmp_path: Path
) -> None:
    (tmp_path / "in.il").write_text(rtlil_of(DESIGNS["synchronous"]), encoding="utf-8")
    mapped = "memory_map; " if kind == "dffe" else ""
    tools.run_yosys(tmp_path, f"read_rtlil in.il; {mapped}{script}; write_rtlil out.il", None)
    other = (tmp_path / "out.il").read_text(encoding="utf-8")
    with pytest.raises(ProofError, match=rf"^the design has \${kind}, which a proof does not"):
        read_rtlil(other, tools, tmp_path, None)
