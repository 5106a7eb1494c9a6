"""Runs of Yosys and nextpnr: their arguments, their order, and files of an earlier run."""

from __future__ import annotations

import json
import statistics
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import pytest

from firm_hdl.bench import DEVICES, BenchError, Device, measure
from firm_hdl.bench import flow as bench_flow
from firm_hdl.bench import tools as bench_tools
from firm_hdl.bench.flow import PREPARATIONS, Measured
from firm_hdl.bench.tools import Tool
from tests.bench.netlists import small

ABORTED = "ERROR: Assert `x' failed in y.cc"


@dataclass
class Fake:
    """A tool without a program: `work` gets the folder, the arguments, and the number of the run.

    Its result is written as the tool would; an exception is its failure.
    """

    title: str
    file: str
    work: Callable[[Path, Sequence[str], int], str]
    version: str = "9"
    runs: list[Sequence[str]] = field(default_factory=list)

    def run(self, folder: Path, *arguments: str) -> str:
        self.runs.append(arguments)
        text = self.work(folder, arguments, len(self.runs) - 1)
        if text:
            (folder / self.file).write_text(text)
        return ""


def netlist(*_: object) -> str:
    return json.dumps({"modules": {"top": small()}})


def report(*rates: float) -> str:
    """Return a report of nextpnr: a clock for each rate, and a path with that rate's delay."""
    path = {"type": "clk-to-q", "delay": 1000 / (rates or (1.0,))[0], "from": {"cell": "$1"}}
    return json.dumps(
        {
            "fmax": {f"clk{number}": {"achieved": rate} for number, rate in enumerate(rates)},
            "critical_paths": [{"from": "posedge clk", "to": "posedge clk", "path": [path]}],
        }
    )


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch) -> Callable[..., tuple[Measured, Fake, Fake]]:
    """Measure a small circuit with tools that are not there."""

    def measured(
        seeds: Sequence[int] = (),
        *,
        yosys: Callable[[Path, Sequence[str], int], str] = netlist,
        nextpnr: Callable[[Path, Sequence[str], int], str] = lambda *_: report(100.0),
        device: Device = DEVICES["ecp5"],
        **options: Any,
    ) -> tuple[Measured, Fake, Fake]:
        tools = Fake("Yosys", "top.json", yosys), Fake("nextpnr", "report.json", nextpnr)
        monkeypatch.setattr(bench_flow, "find_yosys", lambda: tools[0])
        monkeypatch.setattr(bench_flow, "find_nextpnr", lambda package, program: tools[1])
        return measure("module \\top\nend\n", device, seeds, **options), *tools

    return measured


def test_each_seed_is_a_run_of_nextpnr(run: Callable[..., Any]) -> None:
    rates = [99.96, 140.0, 120.04]
    found, _, nextpnr = run((5, 1, 9), nextpnr=lambda folder, words, n: report(rates[n]))
    assert [words[words.index("--seed") + 1] for words in nextpnr.runs] == ["5", "1", "9"]
    assert [(each.seed, each.mhz) for each in found.placed] == [(5, 100.0), (1, 140.0), (9, 120.0)]
    assert found.mhz == 120.0 == statistics.median(each.mhz for each in found.placed)
    assert found.path == found.placed[2].path
    assert found.path is not None and found.path.ns == round(1000 / 120.04, 2)
    assert found.problem == ""
    assert found.tools == {"Yosys": "9", "nextpnr": "9"}
    options = DEVICES["ecp5"].placer.options  # type: ignore[union-attr]
    assert all(words[: len(options)] == options for words in nextpnr.runs)
    assert found.placement == " ".join(options)


def test_the_area_is_that_of_the_circuit_without_registers_around_it(
    run: Callable[..., Any],
) -> None:
    found, _, _ = run((1,))
    assert (found.area.lut, found.area.ff, found.port_registers) == (2, 2, 3)


def test_a_circuit_of_registers_or_of_logic_alone_has_an_area(run: Callable[..., Any]) -> None:
    for kind, lut, ff in (("LUT4", 2, 0), ("TRELLIS_FF", 0, 2)):
        top = small()
        top["cells"] = {name: cell for name, cell in top["cells"].items() if cell["type"] == kind}
        text = json.dumps({"modules": {"top": top}})
        found, _, _ = run(yosys=lambda *_, text=text: text)
        assert (found.area.lut, found.area.ff) == (lut, ff)


@pytest.mark.parametrize("rates", [(), (100.0, 50.0)])
def test_another_number_of_clocks_than_one_is_a_problem(
    run: Callable[..., Any], rates: tuple[float, ...]
) -> None:
    found, _, _ = run((1,), nextpnr=lambda *_: report(*rates))
    assert found.problem == f"nextpnr reports {len(rates)} clocks, not 1"
    assert found.placed == ()


def test_a_run_that_writes_no_report_does_not_get_that_of_the_run_before(
    run: Callable[..., Any],
) -> None:
    found, _, nextpnr = run((1, 2, 3), nextpnr=lambda *given: report(90.0) * (given[2] != 1))
    assert [each.seed for each in found.placed] == [1]
    assert found.problem == "nextpnr ended without an error, but did not write report.json"
    assert len(nextpnr.runs) == 2


def test_files_of_the_device_are_there_for_nextpnr(run: Callable[..., Any]) -> None:
    seen = []

    def place(folder: Path, words: Sequence[str], number: int) -> str:
        seen.append((folder / "pins.cst").read_text())
        (words_of_ports,) = [words[at + 1] for at, word in enumerate(words) if word == "--json"]
        ports = json.loads((folder / words_of_ports).read_text())["modules"]["top"]["ports"]
        assert set(ports) == {"clk", "rst", "scan_in", "scan_out"}
        return report(90.0)

    gowin = replace(DEVICES["gowin"], cells=DEVICES["ecp5"].cells)
    found, _, _ = run((1,), device=gowin, nextpnr=place)
    assert found.problem == "" and len(found.placed) == 1
    assert [text.count("IO_LOC") for text in seen] == [4]


def test_yosys_that_aborts_is_run_with_more_preparation(run: Callable[..., Any]) -> None:
    def yosys(folder: Path, words: Sequence[str], number: int) -> str:
        assert not (folder / "top.json").exists()
        if number < 2:
            (folder / "top.json").write_text("half a netlist")
            raise BenchError(ABORTED)
        return netlist()

    found, tool, _ = run(yosys=yosys, mapping="tee x")
    scripts = [f"tee x; {before}synth_ecp5 -top top" for before in PREPARATIONS]
    assert [words[-1] for words in tool.runs] == [
        f"read_rtlil top.il; {script} -json top.json" for script in scripts
    ]
    # The last one is that of the figures.
    assert found.mapping == scripts[-1] and PREPARATIONS[0] == ""


@pytest.mark.parametrize(("error", "runs"), [(ABORTED, len(PREPARATIONS)), ("ERROR: other", 1)])
def test_yosys_that_always_fails_is_an_error(
    run: Callable[..., Any], error: str, runs: int
) -> None:
    seen = []

    def yosys(*given: object) -> str:
        seen.append(given)
        raise BenchError(error)

    with pytest.raises(BenchError, match=f"^{error}$"):
        run(yosys=yosys)
    assert len(seen) == runs


def test_reasons_are_of_the_log_of_this_run(tmp_path: Path) -> None:
    path = tmp_path / "tool"
    path.write_text("#!/bin/sh\necho 'ERROR: one'; echo 'ERROR: two'; echo 'ERROR: three'; exit 1")
    path.chmod(0o755)
    (tmp_path / "tool.log").write_text("ERROR: of an earlier run\n")
    with pytest.raises(BenchError, match=r"^x failed: ERROR: one ERROR: two$"):
        Tool(title="x", command=(str(path),), version="1").run(tmp_path)


@pytest.mark.parametrize(
    ("name", "with_placer", "tools"),
    [
        ("ecp5", True, ["Yosys", "nextpnr-ecp5"]),
        ("ecp5", False, ["Yosys"]),
        ("xc7", True, ["Yosys"]),
    ],
)
def test_versions_are_those_of_the_tools_that_are_needed(
    monkeypatch: pytest.MonkeyPatch, name: str, with_placer: bool, tools: list[str]
) -> None:
    monkeypatch.setattr(
        bench_tools, "find_yosys", lambda: Tool(title="Yosys", command=(), version="1")
    )
    monkeypatch.setattr(
        bench_tools,
        "find_nextpnr",
        lambda package, program: Tool(title=program, command=(package,), version="2"),
    )
    found = bench_tools.versions(DEVICES[name], with_placer=with_placer)
    assert list(found) == tools and list(found.values()) == ["1", "2"][: len(tools)]
