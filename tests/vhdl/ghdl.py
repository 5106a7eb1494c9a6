"""Simulate a design in `amaranth.sim` and its VHDL in GHDL, on the same input vectors.

A step sets all inputs, including clocks, at once, waits until all signals have settled, and records
all outputs. GHDL reads the steps from a file and writes the outputs to another; Python compares.
"""

from __future__ import annotations

import random
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from amaranth.hdl import Cat, Value
from amaranth.sim import Simulator

from firm_hdl.jobs.programs import ProgramMissingError, find_ghdl
from firm_hdl.vhdl.convert import Vhdl

__all__ = ["GHDL", "analyse", "difference", "expected", "run", "simulate", "synthesize", "vectors"]

try:
    GHDL: str | None = find_ghdl()
except ProgramMissingError:
    GHDL = None

Steps = list[dict[str, int]]


def vectors(
    inputs: Mapping[str, int], clocks: Sequence[str], *, steps: int, seed: int, rare: float = 0.1
) -> Steps:
    """Make input values: even steps change data and resets, odd steps change some of the clocks.

    Parameters
    ----------
    inputs : mapping of str to int
        Widths.
    rare : float
        Probability that a reset is high.
    """
    chosen = random.Random(seed)
    now = dict.fromkeys(inputs, 0)
    result: Steps = []
    for step in range(steps):
        for name, width in inputs.items():
            if name in clocks:
                if step % 2 and chosen.random() < 0.8:
                    now[name] ^= 1
            elif not step % 2:
                ones = (1 << width) - 1
                anything = chosen.getrandbits(width + 1) & ones
                now[name] = chosen.choice([0, ones, 1 & ones, anything, anything, anything])
                if name.endswith("rst"):
                    now[name] = int(chosen.random() < rare)
        result.append(dict(now))
    return result


def expected(
    design: Any, inputs: Mapping[str, Value], outputs: Mapping[str, Value], steps: Steps
) -> Steps:
    """Run Amaranth's simulator; return the outputs after each step."""
    result: Steps = []
    outside = Cat(*inputs.values())

    async def bench(ctx: Any) -> None:
        for step in steps:
            bits = place = 0
            for name, value in inputs.items():
                bits |= step[name] << place
                place += len(value)
            # One assignment, so that clocks which change together change in the same delta.
            ctx.set(outside, bits)
            await ctx.delay(1e-9)
            result.append({name: ctx.get(value.as_unsigned()) for name, value in outputs.items()})

    simulator = Simulator(design)
    simulator.add_testbench(bench)
    simulator.run()
    return result


def run(folder: Path, *arguments: str) -> str:
    """Run GHDL, which must succeed; return its output."""
    assert GHDL is not None
    done = subprocess.run(
        [GHDL, *arguments], cwd=folder, capture_output=True, text=True, timeout=300, check=False
    )
    output = done.stdout + done.stderr
    assert done.returncode == 0, f"{' '.join(arguments)}: {output}"
    return output


def analyse(vhdl: Vhdl, folder: Path) -> None:
    """Analyse the files in GHDL, which must print nothing."""
    for name, text in vhdl.files.items():
        (folder / name).write_text(text)
    assert run(folder, "-a", "--std=08", "--warn-error", *vhdl.files) == ""


def synthesize(vhdl: Vhdl, folder: Path) -> str:
    """Return the netlist that GHDL synthesizes, as VHDL."""
    analyse(vhdl, folder)
    return run(folder, "--synth", "--std=08", "--out=raw-vhdl", vhdl.top)


def simulate(
    vhdl: Vhdl, steps: Steps, inputs: Mapping[str, int], outputs: Mapping[str, int], folder: Path
) -> Steps:
    """Run GHDL; return the outputs after each step.

    Parameters
    ----------
    inputs, outputs : mapping of str to int
        Widths of the ports by their names in the netlist.
    """
    analyse(vhdl, folder)
    ports = list(vhdl.entities.values())[-1].ports
    into = {name: width for name, width in inputs.items() if width}
    out = {name: width for name, width in outputs.items() if width}
    rows = (
        "".join(f"{step[name]:0{width}b}" for name, width in into.items()) or "0" for step in steps
    )
    (folder / "stimuli.txt").write_text("".join(f"{row}\n" for row in rows))
    (folder / "bench.vhd").write_text(_bench(vhdl.top, ports, into, out))
    run(folder, "-a", "--std=08", "bench.vhd")
    printed = run(folder, "--elab-run", "--std=08", "bench", "--ieee-asserts=disable-at-0")
    assert printed == "", printed
    result: Steps = []
    for row in (folder / "results.txt").read_text().splitlines():
        seen, place = dict.fromkeys(outputs, 0), 0
        for name, width in out.items():
            seen[name] = int(row[place : place + width], 2)
            place += width
        result.append(seen)
    return result


def _associations(signal: str, ports: Mapping[str, str], widths: Mapping[str, int]) -> list[str]:
    place = sum(widths.values())
    result = []
    for name, width in widths.items():
        place -= width
        bits = f"{place}" if width == 1 else f"{place + width - 1} downto {place}"
        result.append(f"{ports[name]} => {signal}({bits})")
    return result


def _bench(
    top: str, ports: Mapping[str, str], inputs: Mapping[str, int], outputs: Mapping[str, int]
) -> str:
    """Return a bench that applies rows of bits, and writes rows of bits."""
    parts = _associations("stim", ports, inputs) + _associations("seen", ports, outputs)
    joined = ",\n    ".join(parts)
    return f"""\
library ieee;
use ieee.std_logic_1164.all;
use std.textio.all;
entity bench is end entity;
architecture sim of bench is
  signal stim : std_logic_vector({max(sum(inputs.values()) - 1, 0)} downto 0) := (others => '0');
  signal seen : std_logic_vector({sum(outputs.values()) - 1} downto 0);
begin
  dut : entity work.{top} port map (
    {joined});
  process
    file stimuli : text open read_mode is "stimuli.txt";
    file results : text open write_mode is "results.txt";
    variable row : line;
    variable bits : std_logic_vector(stim'range);
  begin
    while not endfile(stimuli) loop
      readline(stimuli, row);
      read(row, bits);
      stim <= bits;
      wait for 1 ns;
      write(row, seen);
      writeline(results, row);
    end loop;
    wait;
  end process;
end architecture;
"""


def difference(want: Steps, got: Steps) -> str | None:
    """Return a description of the first difference, or `None`."""
    if len(want) != len(got):
        return f"{len(got)} steps instead of {len(want)}"
    for index, (right, seen) in enumerate(zip(want, got, strict=True)):
        for name, value in right.items():
            if seen[name] != value:
                return f"step {index}: {name} is {seen[name]:#x} instead of {value:#x}"
    return None
