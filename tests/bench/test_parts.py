"""Figures of packet parts."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from firm_hdl.bench import BenchError, Device
from firm_hdl.bench.devices import Area
from firm_hdl.bench.page import area_table, converter_table
from firm_hdl.bench.parts import PARTS, PartResult, part_table, parts_text, run_parts
from firm_hdl.bench.parts import run as part_run
from firm_hdl.bench.tables import row
from tests.bench.results import result

NAMES = [f"{part.name}, {part.parameters}" for part in PARTS]
WIDTH = NAMES.index("`PacketWidth`, 8 to 1 bytes")


def test_parts_have_different_names() -> None:
    assert len(set(NAMES)) == len(NAMES)


def test_table_and_file_have_the_figures() -> None:
    measured = PartResult(part=PARTS[WIDTH], measured=result().measured)
    missing = PartResult(part=PARTS[0], problem="too large")
    assert part_table([measured, missing]).splitlines()[2:] == [
        "| `PacketWidth` | 8 to 1 bytes | 100 | 50 | 0 | 0 | 82.5 (80, 90, 82) |"
    ]
    first, second = json.loads(parts_text([measured, missing]))["parts"]
    assert (first["part"], first["parameters"]) == ("`PacketWidth`", "8 to 1 bytes")
    assert (first["circuit"]["mhz"], first["problem"]) == (82.5, "")
    assert (second["circuit"], second["problem"]) == (None, "too large")


def test_each_kind_of_cell_has_its_column() -> None:
    # Five different numbers: equal ones hide that two are in each other's place.
    found = result()
    assert found.measured is not None
    area = Area(lut=1001, ff=202, carry=33, lutram=4, bram=5)
    measured = replace(found.measured, area=area)
    (line,) = part_table([PartResult(part=PARTS[WIDTH], measured=measured)]).splitlines()[2:]
    assert line.split(" | ")[2:6] == ["1,001", "202", "4", "5"]
    found = replace(found, measured=measured)
    assert row(found).split()[4:9] == ["1001", "202", "33", "4", "5"]
    # These two have one column for both kinds of memory.
    for table, first in ((converter_table, 4), (area_table, 3)):
        (line, *_) = table([found]).splitlines()[2:]
        assert line.strip("| ").split(" | ")[first : first + 4] == ["1,001", "202", "33", "9"]


def test_a_part_is_mapped(ecp5: Device) -> None:
    (found,) = run_parts(parts=[WIDTH], seeds=(), jobs=1)
    assert found.problem == "" and found.measured is not None
    assert found.part == PARTS[WIDTH]
    # A word that is sent byte by byte, and the byte that is sent, are registers.
    assert found.measured.area.ff >= 72 and found.measured.device == ecp5


def test_a_part_without_figures_has_the_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*given: object, **options: object) -> None:
        raise BenchError("Yosys says no")

    monkeypatch.setattr(part_run, "measure_once", fail)
    (found,) = run_parts(parts=[WIDTH], jobs=1)
    assert (found.measured, found.problem) == (None, "Yosys says no")
