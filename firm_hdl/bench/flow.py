"""From a circuit's RTLIL to its area, its clock rate and its critical path."""

from __future__ import annotations

import json
import statistics
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from firm_hdl.bench.devices import Area, Device, Placer
from firm_hdl.bench.netlist import CriticalPath, Names, cell_counts, critical_path, top_module
from firm_hdl.bench.surroundings import surround
from firm_hdl.bench.tools import BenchError, Tool, find_nextpnr, find_yosys, written
from firm_hdl.rtlil import without_indices

__all__ = ["Measured", "Placed", "measure"]

# Yosys 0.70 aborts on some circuits after ABC, but not if they are flattened before. It has never
# aborted on circuits without names, but then a critical path has no names either.
PREPARATIONS = (
    "",
    "hierarchy -top top; proc; flatten; opt_clean; ",
    "hierarchy -top top; proc; flatten; opt_clean; rename -hide */w:*; ",
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Placed:
    """The clock rate that one run of nextpnr reached."""

    seed: int
    mhz: float
    path: CriticalPath  # The path that limits the clock rate.


@dataclass(frozen=True, slots=True, kw_only=True)
class Measured:
    """The figures of a circuit."""

    device: Device
    area: Area  # Area of the circuit alone.
    # Number of flip-flops outside of the circuit's ports. They are not in `area`.
    port_registers: int
    placed: tuple[Placed, ...]  # One for each seed; none if the device has no nextpnr.
    mapping: str  # Commands of Yosys that mapped the circuit.
    placement: str  # Options of nextpnr, without the seed.
    tools: Mapping[str, str]  # Versions of the tools, by name.
    # Why nextpnr gave no clock rate, for example because the circuit does not fit; else empty.
    problem: str = ""

    @property
    def mhz(self) -> float | None:
        """Median of the clock rates, in MHz."""
        rates = [each.mhz for each in self.placed]
        return statistics.median(rates) if rates else None

    @property
    def path(self) -> CriticalPath | None:
        """The critical path of the run nearest to the median."""
        middle = self.mhz
        if middle is None:
            return None
        return min(self.placed, key=lambda each: abs(each.mhz - middle)).path


def measure(
    rtlil: str,
    device: Device,
    seeds: Sequence[int],
    *,
    mapping: str = "",
    report: Callable[[Placed], None] = lambda placed: None,
) -> Measured:
    """Measure a circuit.

    * `rtlil`: as `amaranth.back.rtlil.convert` returns it, with the name ``top``. Its clock is
      ``clk``.
    * `seeds`: seeds of nextpnr, one for each run.
    * `mapping`: commands of Yosys before the mapping, such as ``scratchpad -set abc9.D 4000``.
    * `report`: called after each run.

    Raises `BenchError` if the circuit has no area. If it has no clock rate, `Measured.problem` says
    why.
    """
    yosys = find_yosys()
    placer = device.placer if seeds else None
    nextpnr = find_nextpnr(placer.package, placer.program) if placer else None
    placed: list[Placed] = []
    added = 0
    problem = ""
    with tempfile.TemporaryDirectory(prefix="firm-hdl-bench-") as name:
        folder = Path(name)
        (folder / "top.il").write_text(without_indices(rtlil), encoding="utf-8")
        top, script = _synthesize(yosys, folder, device, mapping)
        area = _area(device, top)
        if placer and nextpnr:
            names = Names(top)
            added = surround(top, placer)
            for file, text in placer.files.items():
                (folder / file).write_text(text, encoding="utf-8")
            (folder / "ports.json").write_text(json.dumps({"modules": {"top": top}}))
            try:
                for seed in seeds:
                    placed.append(_place(nextpnr, folder, placer, seed, names))
                    report(placed[-1])
            except BenchError as error:
                problem = str(error)
    return Measured(
        device=device,
        area=area,
        port_registers=added,
        placed=tuple(placed),
        mapping=script,
        placement=" ".join(placer.options) if placer else "",
        tools={tool.title: tool.version for tool in (yosys, nextpnr) if tool},
        problem=problem,
    )


def _area(device: Device, top: dict[str, Any]) -> Area:
    """Count a mapped circuit's cells. If no cell counts, its names are unknown: an error."""
    counts = cell_counts(top)
    area = device.area(counts)
    if not area.lut and not area.ff:
        raise BenchError(f"no cell of {', '.join(sorted(counts))} counts on {device.title}")
    return area


def _synthesize(
    yosys: Tool, folder: Path, device: Device, mapping: str
) -> tuple[dict[str, Any], str]:
    """Map a circuit; return its module, and the commands that did it."""
    problem = BenchError("Yosys was not run")
    before = f"{mapping}; " if mapping else ""
    for preparation in PREPARATIONS:
        script = f"{before}{preparation}{device.synthesis}"
        netlist = folder / "top.json"
        netlist.unlink(missing_ok=True)
        try:
            yosys.run(folder, "-q", "-p", f"read_rtlil top.il; {script} -json {netlist.name}")
        except BenchError as error:
            if "Assert" not in str(error):
                raise
            problem = error
            continue
        return top_module(json.loads(written(yosys, netlist))), script
    raise problem


def _place(nextpnr: Tool, folder: Path, placer: Placer, seed: int, names: Names) -> Placed:
    """Place and route once."""
    report = folder / "report.json"
    report.unlink(missing_ok=True)
    nextpnr.run(
        folder,
        *placer.options,
        *("--json", "ports.json", "--report", report.name),
        *("--seed", str(seed), "--timing-allow-fail", "-q"),
    )
    found = json.loads(written(nextpnr, report))
    rates = [clock["achieved"] for clock in found.get("fmax", {}).values()]
    if len(rates) != 1:
        raise BenchError(f"{nextpnr.title} reports {len(rates)} clocks, not 1")
    return Placed(seed=seed, mhz=round(rates[0], 1), path=critical_path(found, names))
