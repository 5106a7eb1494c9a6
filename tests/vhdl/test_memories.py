"""Memories in VHDL: simulation and inference by GHDL."""

from __future__ import annotations

import re
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest
from amaranth.hdl import Module
from amaranth.lib.memory import Memory
from amaranth.lib.wiring import Component, In, Out

from firm_hdl.vhdl.convert import Vhdl, convert
from tests.rtlil.memory_designs import DESIGNS, Store, Stores, rtlil_of, simulated
from tests.vhdl.ghdl import GHDL, analyse, difference, run, simulate, synthesize

STEPS = 200


def _vhdl(name: str) -> Vhdl:
    return convert(rtlil_of(DESIGNS[name]), name="stores")


@pytest.mark.usefixtures("ghdl")
@pytest.mark.parametrize("name", DESIGNS)
@pytest.mark.sampled(3)
def test_memories_behave_as_in_amaranth(name: str, tmp_path: Path) -> None:
    inputs, outputs, steps, wanted = simulated(DESIGNS[name], steps=STEPS, seed=len(name))
    assert difference(wanted, simulate(_vhdl(name), steps, inputs, outputs, tmp_path)) is None


@pytest.mark.usefixtures("ghdl")
@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("asynchronous", "mem(to_integer(unsigned(mem_w0_addr)))", "mem(0)"),
        ("one bit", "(0 => mem_w0_data)", '"0"'),
        ("lanes", "(7 downto 6) <= unsigned(mem_w0_data(7 downto 6))", '(7 downto 6) <= "00"'),
        ("transparent", "= '1' then  -- transparent", "= 'U' then"),
        ("synchronous", "if mem_r0_en = '1' then", "if true then"),
        ("odd depth", '2 => "00000011"', '2 => "00000010"'),
    ],
)
@pytest.mark.sampled(6)
def test_a_changed_memory_is_noticed(name: str, old: str, new: str, tmp_path: Path) -> None:
    vhdl = _vhdl(name)
    text = vhdl.files["stores.vhd"]
    assert old in text
    broken = replace(vhdl, files={**vhdl.files, "stores.vhd": text.replace(old, new)})
    inputs, outputs, steps, wanted = simulated(DESIGNS[name], steps=STEPS, seed=len(name))
    assert difference(wanted, simulate(broken, steps, inputs, outputs, tmp_path)) is not None


# GHDL infers no RAM for a single word, nor for a memory with constant addresses.
@pytest.mark.usefixtures("ghdl")
@pytest.mark.parametrize("name", sorted(set(DESIGNS) - {"one word", "odd depth", "contents alone"}))
@pytest.mark.sampled(3)
def test_ghdl_infers_a_ram(name: str, tmp_path: Path) -> None:
    output = synthesize(_vhdl(name), tmp_path)
    for memory, store in DESIGNS[name].items():
        width = store.shape if isinstance(store.shape, int) else store.shape.size
        signal = _vhdl(name).entities["stores"].memories[memory]
        assert f'found RAM "{signal}", width: {width} bits, depth: {store.depth}' in output


@pytest.mark.usefixtures("ghdl")
def test_a_write_beyond_the_last_word_stops_the_simulation(tmp_path: Path) -> None:
    """A proof cannot find this, because synthesis may do anything beyond the last word."""
    vhdl = _vhdl("transparent")
    broken = vhdl.files["stores.vhd"].replace("(mem_w0_addr) < 5", "(mem_w0_addr) <= 5")
    assert broken != vhdl.files["stores.vhd"]
    inputs, outputs, steps, _ = simulated(DESIGNS["transparent"], steps=STEPS, seed=1)
    files = {**vhdl.files, "stores.vhd": broken}
    with pytest.raises(AssertionError, match="bound"):
        simulate(replace(vhdl, files=files), steps, inputs, outputs, tmp_path)


def test_memories_have_names_of_their_own() -> None:
    vhdl = _vhdl("several")
    names = vhdl.entities["stores"]
    assert names.memories == {"mem": "mem", "data": "data", "signal": "signal_sig"}
    assert set(names.memories.values()).isdisjoint(names.signals.values())
    for signal in names.memories.values():
        assert f"  signal {signal} : {signal}_array := (" in vhdl.files["stores.vhd"]


@pytest.mark.parametrize(("place", "word"), [(5, "mem(5)"), (6, "mem(0)"), (7, "mem(0)")])
def test_no_constant_address_is_beyond_the_last_word(place: int, word: str) -> None:
    """VHDL checks the index, even where the word is not used."""
    text = convert(Stores({"mem": Store(depth=6, reads=(), places=(place,))}), name="stores")
    assert re.findall(r"mem\(\d+\)", text.files["stores.vhd"]) == [word]


_BENCH = """
library ieee;
use ieee.std_logic_1164.all;
entity bench is
end entity;
architecture sim of bench is
  signal clk, en, data : std_logic := '0';
  signal addr : std_logic_vector(2 downto 0) := "000";
  signal r_data : std_logic;
begin
  dut : entity work.stores port map (
    clk => clk, rst => '0', mem_w0_addr => addr, mem_w0_data => data, mem_w0_en => en,
    mem_r0_addr => addr, mem_r0_data => r_data);
  process
  begin
    addr <= "XXX"; wait for 1 ns;
    assert r_data = '{read}' report "unknown address" severity failure;
    addr <= "001"; data <= '1'; en <= 'X'; wait for 1 ns;
    clk <= '1'; wait for 1 ns; clk <= '0'; wait for 1 ns;
    assert r_data = '0' report "unknown enable" severity failure;
    en <= '1'; data <= 'X'; wait for 1 ns;
    clk <= '1'; wait for 1 ns; clk <= '0'; wait for 1 ns;
    assert r_data = 'X' report "unknown data" severity failure;
    addr <= "010"; wait for 1 ns;
    assert r_data = '0' report "another word" severity failure;
    report "done";
    wait;
  end process;
end architecture;
"""


@pytest.mark.usefixtures("ghdl")
@pytest.mark.parametrize(
    ("depth", "init", "read"), [(8, [0] * 8, "0"), (8, [1, 0, 0], "1"), (5, [1, 0, 0], "0")]
)
def test_unknown_values_stop_no_simulation(
    depth: int, init: list[int], read: str, tmp_path: Path
) -> None:
    """An unknown address reads word 0, or 0 if there are fewer words than addresses."""
    store = Store(shape=1, depth=depth, init=init)
    vhdl = convert(Stores({"mem": store}), name="stores")
    analyse(vhdl, tmp_path)
    (tmp_path / "bench.vhd").write_text(_BENCH.format(read=read))
    run(tmp_path, "-a", "--std=08", "bench.vhd")
    output = run(tmp_path, "--elab-run", "--std=08", "bench", "--ieee-asserts=disable")
    assert "done" in output


@pytest.mark.usefixtures("ghdl")
def test_a_wrong_bench_fails(tmp_path: Path) -> None:
    vhdl = convert(Stores({"mem": Store(shape=1, init=[1])}), name="stores")
    analyse(vhdl, tmp_path)
    (tmp_path / "bench.vhd").write_text(_BENCH.format(read="0"))
    assert GHDL is not None
    run(tmp_path, "-a", "--std=08", "bench.vhd")
    command = [GHDL, "--elab-run", "--std=08", "bench", "--ieee-asserts=disable"]
    process = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert process.returncode != 0 and "unknown address" in process.stdout + process.stderr


@pytest.mark.parametrize(("to", "bypasses"), [(2, True), (1, False)])
def test_a_transparent_port_passes_on_what_is_written_to_its_own_word(
    to: int, bypasses: bool
) -> None:
    """Both addresses are constants, so the text alone says whether they are the same."""

    class Fixed(Component):
        def __init__(self) -> None:
            super().__init__({"given": In(8), "seen": Out(8)})

        def elaborate(self, platform: object) -> Module:
            m = Module()
            m.submodules.memory = memory = Memory(shape=8, depth=4, init=[])
            write = memory.write_port()
            read = memory.read_port(transparent_for=(write,))
            m.d.comb += [write.addr.eq(to), read.addr.eq(2)]
            m.d.comb += [write.en.eq(1), read.en.eq(1)]
            m.d.comb += [write.data.eq(self.given), self.seen.eq(read.data)]
            return m

    text = convert(Fixed(), name="fixed").files["fixed.vhd"]
    assert f"memory({to}) <= unsigned(given);" in text
    assert ("read_data <= unsigned(given);" in text) is bypasses
