"""Reports and netlists of the tools for one circuit, on each device."""

from __future__ import annotations

import json
from typing import Any

import pytest

from firm_hdl.bench import DEVICES
from firm_hdl.bench.devices import Area
from firm_hdl.bench.netlist import Names, cell_counts, critical_path, top_module
from tests.bench.make_reports import FOLDER


def kept(name: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((FOLDER / f"{name}.json").read_text())
    return found


@pytest.mark.parametrize(
    ("name", "area"),
    [
        ("ecp5", Area(lut=3, ff=8, carry=7)),
        ("ice40", Area(lut=12, ff=8, carry=12)),
        ("gowin", Area(lut=3, ff=8, carry=14)),
        ("xc7", Area(lut=10, ff=8, carry=2)),
    ],
)
def test_cells_are_those_of_the_circuit(name: str, area: Area) -> None:
    assert DEVICES[name].area(cell_counts(top_module(kept(name)["netlist"]))) == area


@pytest.mark.parametrize(
    ("name", "path"),
    [
        (
            "ecp5",
            "2.6 ns, 1.2 of them routing, 8 cells: total 0.4 > large 2.6 > port large 2.6",
        ),
        (
            "ice40",
            "2.9 ns, 1.9 of them routing, 1 cell: port enable 0.5 > enable 1.1 > & rst 1.4 > "
            "total 2.9",
        ),
        (
            "gowin",
            "1.2 ns, 0.4 of them routing, 1 cell: port large 0.2 > sum register 0 1.2",
        ),
    ],
)
def test_paths_have_the_names_of_the_design(name: str, path: str) -> None:
    found = kept(name)
    critical = critical_path(found["report"], Names(top_module(found["netlist"])))
    assert str(critical) == path
    (rate,) = found["report"]["fmax"].values()
    assert critical.ns == pytest.approx(1000 / rate["achieved"], abs=0.02)


def test_every_device_has_its_files() -> None:
    assert {file.stem for file in FOLDER.iterdir()} == set(DEVICES)
    with_rate = {name for name in DEVICES if "report" in kept(name)}
    assert with_rate == {name for name, device in DEVICES.items() if device.placer is not None}
