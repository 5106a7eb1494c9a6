"""Simulators of exported text, behind one small interface.

A simulator replays a trace (:mod:`firm_hdl.verify.trace`): it makes the text of the devices, drives
the rows of inputs, and gives the rows of outputs that it saw. To add one is to write a class with
these three members and to name it in `SIMULATORS`.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Protocol

from firm_hdl.export.top import Top
from firm_hdl.export.vhdl import convert
from firm_hdl.verify.processes import run_tool
from firm_hdl.verify.replay_bench import replay_bench
from firm_hdl.verify.trace import Trace

__all__ = ["SIMULATORS", "Ghdl", "SimulatorMissingError", "TextSimulator", "find_ghdl", "simulator"]

GHDL_NAMES = ("ghdl", "ghdl-mcode", "ghdl-llvm", "ghdl-gcc")
GHDL_RUN = ("--ieee-asserts=disable-at-0",)


class SimulatorMissingError(ValueError):
    """A simulator is not installed; the text says how to get it."""


class TextSimulator(Protocol):
    """A simulator of exported text.

    Attributes
    ----------
    title : str
        What it is called in reports.
    """

    title: str

    def replay(self, trace: Trace, tops: Callable[[], list[Top]], folder: Path) -> list[str]:
        """Run a trace; return rows of outputs as they are in `Trace.expected`.

        Parameters
        ----------
        tops : callable
            Gives the devices, in order, to be exported.
        folder : Path
            An empty one, for what the simulator needs and leaves.

        Raises
        ------
        ToolError
        """


class Ghdl:
    """GHDL, on the VHDL that ``firm-hdl build`` writes for the ``_flat`` entities.

    Raises
    ------
    SimulatorMissingError
    """

    title = "GHDL"

    def __init__(self) -> None:
        self.path = find_ghdl()

    def replay(self, trace: Trace, tops: Callable[[], list[Top]], folder: Path) -> list[str]:
        files: dict[str, str] = {}
        ports: list[Mapping[str, str]] = []
        for device, top in zip(trace.devices, tops(), strict=True):
            vhdl = convert(top, name=device.name)
            files.update(vhdl.files)
            # The outermost entity is the last one.
            ports.append(list(vhdl.entities.values())[-1].ports)
        files["replay.vhd"] = replay_bench(trace, ports)
        for name, text in files.items():
            (folder / name).write_text(text, encoding="utf-8")
        (folder / "stimuli.txt").write_text("".join(f"{row}\n" for row in trace.stimuli))
        run_tool([self.path, "-a", "--std=08", *files], folder)
        run_tool([self.path, "--elab-run", "--std=08", "replay", *GHDL_RUN], folder)
        return (folder / "results.txt").read_text().splitlines()


def find_ghdl() -> str:
    """Return the command of GHDL: the environment's ``GHDL``, or the first that is installed.

    Raises
    ------
    SimulatorMissingError
    """
    names = [os.environ["GHDL"]] if os.environ.get("GHDL") else GHDL_NAMES
    for name in names:
        if path := shutil.which(name):
            return path
    if names is not GHDL_NAMES:
        raise SimulatorMissingError(f"GHDL is '{names[0]}' in the environment, and no such command")
    raise SimulatorMissingError("GHDL is not installed (Debian, Ubuntu: apt install ghdl-mcode)")


SIMULATORS: dict[str, Callable[[], TextSimulator]] = {"ghdl": Ghdl}
"""By the name that ``firm-hdl verify --simulator`` takes."""


def simulator(name: str) -> TextSimulator | None:
    """Return a simulator by its name; `None` for ``python``, which is there anyway.

    Raises
    ------
    SimulatorMissingError
    """
    return None if name == "python" else SIMULATORS[name]()
