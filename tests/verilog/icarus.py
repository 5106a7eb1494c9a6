"""Run Verilog in Icarus Verilog."""

from __future__ import annotations

import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

__all__ = ["replay", "simulate"]


def simulate(text: str, standard: str, folder: Path) -> list[str]:
    """Run a text that has the module `bench`; return the lines that it prints."""
    (folder / "all.v").write_text(text)
    # Icarus warns of constant addresses beyond the last word.
    command = ["iverilog", standard, "-o", "bench", "-s", "bench", "all.v"]
    subprocess.run(command, cwd=folder, capture_output=True, check=True)
    done = subprocess.run(
        ["vvp", "-n", "bench"], cwd=folder, capture_output=True, text=True, check=True
    )
    return done.stdout.splitlines()


def replay(
    text: str,
    module: str,
    inputs: Mapping[str, int],
    outputs: Mapping[str, int],
    steps: Sequence[Mapping[str, int]],
    standard: str,
    folder: Path,
) -> list[dict[str, str]]:
    """Set inputs, given by width, in steps; return the bits of the outputs after each step."""
    inputs = {port: width for port, width in inputs.items() if width}
    outputs = {port: width for port, width in outputs.items() if width}
    rows = ("".join(f"{step[n]:0{width}b}" for n, width in inputs.items()) for step in steps)
    (folder / "stimuli.txt").write_text("".join(f"{row}\n" for row in rows))
    ports = ", ".join(f".{n}({n})" for n in [*inputs, *outputs])
    declared = [f"  reg [{width - 1}:0] {n} = 0;\n" for n, width in inputs.items()]
    declared += [f"  wire [{width - 1}:0] {n};\n" for n, width in outputs.items()]
    bench = f"""
module bench;
{"".join(declared)}
  reg [{sum(inputs.values()) - 1}:0] steps [0:{len(steps) - 1}];
  integer step;
  {module} dut({ports});
  initial begin
    $readmemb("stimuli.txt", steps);
    for (step = 0; step < {len(steps)}; step = step + 1) begin
      {{{", ".join(inputs)}}} = steps[step];
      #1;
      $display("{" ".join(["%b"] * len(outputs))}", {", ".join(outputs)});
    end
  end
endmodule
"""
    lines = simulate(text + bench, standard, folder)
    assert len(lines) == len(steps)
    return [dict(zip(outputs, line.split(), strict=True)) for line in lines]
