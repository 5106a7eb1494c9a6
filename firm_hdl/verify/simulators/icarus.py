"""Icarus Verilog, on exported Verilog: four-valued, and quick to compile."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from firm_hdl.export.top import Top
from firm_hdl.jobs.processes import made_by, run_tool
from firm_hdl.jobs.programs import ProgramMissingError, find_program, version_of, which
from firm_hdl.verify.simulators.benches import RESULTS, written
from firm_hdl.verify.simulators.trace import Trace
from firm_hdl.verify.simulators.verilog import modules_of, write_inputs

__all__ = ["Icarus"]

PACKAGE = "iverilog"


class Icarus:
    """Icarus Verilog, on the Verilog that ``firm-hdl build`` writes.

    Parameters
    ----------
    standard : str
        The language standard that the Verilog is read as, for the option ``-g``. 2012 is
        SystemVerilog, which cocotb uses.

    Raises
    ------
    ProgramMissingError
    """

    title = "Icarus Verilog"

    def __init__(self, standard: str = "2012") -> None:
        self.standard = standard
        self.path = find_program(self.title, "IVERILOG", ["iverilog"], PACKAGE)
        # The compiler and vvp belong together, so look for vvp beside the compiler first.
        run = which(str(Path(self.path).with_name("vvp"))) or which("vvp")
        if run is None:
            raise ProgramMissingError(f"{self.title} has no command vvp beside '{self.path}'")
        self.run_path = run

    @property
    def version(self) -> str:
        # What the compiler writes runs in vvp.
        said = (version_of(path, "-V") for path in (self.path, self.run_path))
        return "; ".join(each.partition("; ")[0] for each in said)

    def replay(self, trace: Trace, tops: Callable[[], list[Top]], folder: Path) -> list[str]:
        files = write_inputs(trace, tops(), folder)
        text = written("replay_icarus.v", trace, modules=modules_of(trace))
        (folder / "replay.v").write_text(text, encoding="utf-8")
        return self.run([*files, "replay.v"], self.standard, folder)

    def run(self, files: Sequence[str], standard: str, folder: Path) -> list[str]:
        """Run what has been written to a folder; return the rows of outputs."""
        compiler = [self.path, f"-g{standard}", "-s", "replay", "-o", "replay.vvp"]
        run_tool([*compiler, *files], folder)
        made_by(self.title, folder / "replay.vvp")
        run_tool([self.run_path, "-n", "replay.vvp"], folder)
        return made_by("vvp", folder / RESULTS).read_text().upper().splitlines()
