"""Icarus Verilog, on exported Verilog: four-valued, and quick to compile."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from firm_hdl.export.top import Top
from firm_hdl.jobs.processes import made_by, run_tool
from firm_hdl.jobs.programs import ProgramMissingError, find_program
from firm_hdl.verify.simulators.trace import ARESETN, Trace
from firm_hdl.verify.simulators.verilog import (
    RESULTS,
    STIMULI,
    instances,
    vector,
    write_inputs,
)

__all__ = ["Icarus"]

PACKAGE = "iverilog"

_LOOP = f"""\
  integer stimuli, results, count, is_compared, number, got;
  reg is_first = 1;
  initial begin
    stimuli = $fopen("{STIMULI}", "r");
    results = $fopen("{RESULTS}", "w");
    while ($fscanf(stimuli, "%d %d", count, is_compared) == 2) begin
      repeat (count) begin
        got = $fscanf(stimuli, "%d", number);
        case (number)
          {ARESETN}: got = $fscanf(stimuli, "%b", aresetn);
"""

_SETTLE = """\
          default: begin $display("no input %0d", number); $finish_and_return(1); end
        endcase
      end
      #5;
      if (is_compared) begin
"""

_END = """\
        $fwrite(results, "\\n");
        is_first = 0;
      end
      aclk = 1;
      #5;
      aclk = 0;
    end
    $fclose(results);
    $finish;
  end
endmodule
"""


class Icarus:
    """Icarus Verilog, on the Verilog that ``firm-hdl build`` writes.

    Parameters
    ----------
    standard : str
        The language that the Verilog is read as: what comes behind ``-g``. 2012 is SystemVerilog,
        and what cocotb takes.

    Raises
    ------
    ProgramMissingError
    """

    title = "Icarus Verilog"

    def __init__(self, standard: str = "2012") -> None:
        self.standard = standard
        self.path = find_program(self.title, "IVERILOG", ["iverilog"], PACKAGE)
        # The two belong together: look beside the compiler first.
        beside = os.pathsep.join([str(Path(self.path).parent), os.environ.get("PATH", "")])
        run = shutil.which("vvp", path=beside)
        if run is None:
            raise ProgramMissingError(f"{self.title} has no command vvp beside '{self.path}'")
        self.run_path = run

    def replay(self, trace: Trace, tops: Callable[[], list[Top]], folder: Path) -> list[str]:
        files = write_inputs(trace, tops(), folder)
        (folder / "replay.v").write_text("".join(_bench(trace)), encoding="utf-8")
        return self.run([*files, "replay.v"], self.standard, folder)

    def run(self, files: Sequence[str], standard: str, folder: Path) -> list[str]:
        """Run what has been written to a folder; return the rows of outputs."""
        compiler = [self.path, f"-g{standard}", "-s", "replay", "-o", "replay.vvp"]
        run_tool([*compiler, *files], folder)
        made_by(self.title, folder / "replay.vvp")
        run_tool([self.run_path, "-n", "replay.vvp"], folder)
        return made_by("vvp", folder / RESULTS).read_text().upper().splitlines()


def _bench(trace: Trace) -> Iterator[str]:
    """Write a bench that knows nothing but ports: rows of inputs in, rows of outputs out."""
    yield "module replay;\n  reg aclk = 0, aresetn = 0;\n"
    for pin in trace.inputs:
        yield f"  reg {vector(pin)}i{pin.number} = 0;\n"
    for pin in trace.outputs:
        yield f"  wire {vector(pin)}o{pin.number};\n  reg {vector(pin)}was{pin.number};\n"
    yield from instances(trace)
    yield _LOOP
    for pin in trace.inputs:
        yield f'          {pin.number}: got = $fscanf(stimuli, "%b", i{pin.number});\n'
    yield _SETTLE
    for pin in trace.outputs:
        n = pin.number
        yield f"""\
        if (is_first || o{n} !== was{n}) begin
          was{n} = o{n};
          $fwrite(results, "{n} %b ", o{n});
        end
"""
    yield _END
