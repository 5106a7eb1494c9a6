"""GHDL, on exported VHDL."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from firm_hdl.export.top import Top
from firm_hdl.jobs.processes import made_by, run_tool
from firm_hdl.jobs.programs import find_ghdl, version_of
from firm_hdl.verify.simulators.benches import RESULTS, STIMULI, written
from firm_hdl.verify.simulators.trace import Trace
from firm_hdl.vhdl.convert import convert

__all__ = ["Ghdl"]

RUN = ("--ieee-asserts=disable-at-0",)


class Ghdl:
    """GHDL, on the VHDL that ``firm-hdl build`` writes for the ``_flat`` entities.

    Raises
    ------
    ProgramMissingError
    """

    title = "GHDL"

    def __init__(self) -> None:
        self.path = find_ghdl()

    @property
    def version(self) -> str:
        return version_of(self.path)

    def replay(self, trace: Trace, tops: Callable[[], list[Top]], folder: Path) -> list[str]:
        files: dict[str, str] = {}
        ports: list[Mapping[str, str]] = []
        for device, top in zip(trace.devices, tops(), strict=True):
            vhdl = convert(top, name=device.name)
            files.update(vhdl.files)
            # The outermost entity is the last one.
            ports.append(list(vhdl.entities.values())[-1].ports)
        files["replay.vhd"] = written("replay.vhd", trace, ports=ports)
        for name, text in files.items():
            (folder / name).write_text(text, encoding="utf-8")
        (folder / STIMULI).write_text("".join(f"{row}\n" for row in trace.stimuli))
        run_tool([self.path, "-a", "--std=08", *files], folder)
        run_tool([self.path, "--elab-run", "--std=08", "replay", *RUN], folder)
        return made_by(self.title, folder / RESULTS).read_text().splitlines()
