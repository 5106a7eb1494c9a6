"""Figures come from the cache only if all that determines them is the same."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from firm_hdl.bench import run
from firm_hdl.bench.devices import DEVICES, Device
from firm_hdl.bench.flow import Measured
from tests.bench.results import result


def test_each_input_has_figures_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Any] = []
    tools = {"Yosys": "1"}

    def measure(*given: Any, **more: Any) -> Measured:
        asked.append((given, more))
        found = result(lut=len(asked)).measured
        assert found is not None
        return found

    monkeypatch.setattr(run, "measure", measure)
    monkeypatch.setattr(run, "versions", lambda device, *, with_placer: tools)
    usual = {
        "rtlil": "a",
        "device": DEVICES["ecp5"],
        "seeds": (1, 2),
        "mapping": "",
        "folder": tmp_path,
    }
    changes: list[dict[str, Any]] = [
        {},
        {"rtlil": "b"},
        {"device": DEVICES["ice40"]},
        # Another part of the same name.
        {"device": replace(DEVICES["ecp5"], title="another")},
        {"seeds": (1, 3)},
        {"seeds": (1, 2, 3)},
        {"seeds": (2, 1)},
        {"mapping": "abc"},
        {"folder": tmp_path / "other"},
    ]

    def lut(change: dict[str, Any]) -> int:
        return run.measure_once(**(usual | change)).area.lut  # type: ignore[arg-type]

    first = [lut(change) for change in changes]
    assert first == [*range(1, len(changes) + 1)]
    for change, (given, more) in zip(changes, asked, strict=True):
        inputs = usual | change
        assert given == (inputs["rtlil"], inputs["device"], inputs["seeds"])
        assert more == {"mapping": inputs["mapping"]}
    assert [lut(change) for change in changes] == first
    tools["Yosys"] = "2"
    assert lut({}) == len(changes) + 1
    # Without a folder, nothing is kept.
    assert lut({"folder": None}) == len(changes) + 2
    assert lut({"folder": None, "mapping": "abc"}) == len(changes) + 3
    assert asked[-1][1] == {"mapping": "abc"}


def test_figures_with_a_problem_and_damaged_files_are_measured_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    good = result().measured
    assert good is not None
    texts = ["{}", "[]", "null", '{"device": "abacus"}', ""]
    again = [replace(good, mapping=f"again {number}") for number in range(len(texts) + 1)]
    found = [replace(good, problem="no room"), good, *again]
    monkeypatch.setattr(run, "measure", lambda *_, **__: found.pop(0))
    monkeypatch.setattr(run, "versions", lambda device, *, with_placer: {})

    folder = tmp_path / "new" / "folder"

    def once() -> Measured:
        return run.measure_once("a", DEVICES["ecp5"], (1,), mapping="", folder=folder)

    assert once().problem == "no room" and once() == once() == good
    (file,) = folder.iterdir()
    for text, measured in zip([file.read_text()[:-9], *texts], again, strict=True):
        file.write_text(text)
        assert once() == once() == measured


def test_other_preparations_of_yosys_have_figures_of_their_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    good = result().measured
    assert good is not None
    found = [good, replace(good, mapping="again")]
    monkeypatch.setattr(run, "measure", lambda *_, **__: found.pop(0))
    monkeypatch.setattr(run, "versions", lambda device, *, with_placer: {})
    for preparations, mapping in ((("", "proc; "), good.mapping), (("",), "again")):
        monkeypatch.setattr(run, "PREPARATIONS", preparations)
        measured = run.measure_once("a", DEVICES["ecp5"], (1,), mapping="", folder=tmp_path)
        assert measured.mapping == mapping


@pytest.mark.parametrize(("seeds", "with_placer"), [((), False), ((0,), True)])
def test_nextpnr_is_looked_for_only_if_it_is_run(
    seeds: tuple[int, ...], with_placer: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []

    def versions(device: Device, **options: bool) -> dict[str, str]:
        asked.append((device.name, options))
        return {}

    monkeypatch.setattr(run, "measure", lambda *_, **__: result().measured)
    monkeypatch.setattr(run, "versions", versions)
    run.measure_once("a", DEVICES["ecp5"], seeds, mapping="", folder=tmp_path)
    assert asked == [("ecp5", {"with_placer": with_placer})]
