"""Files of results, tables, and changes between two sets."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import pytest

from firm_hdl.bench import BenchError
from firm_hdl.bench.compare import compare, compared
from firm_hdl.bench.cycles import STATED
from firm_hdl.bench.devices import DEVICES, Area
from firm_hdl.bench.results import Result, read_results, results_text
from firm_hdl.bench.tables import geometric_mean, head, row, summary
from tests.bench.results import result


def test_results_come_back_from_a_file(tmp_path: Path) -> None:
    bare = replace(result("p/msg/B"), measured=None, cycles=None, problem="too large")
    both = [result("p/msg/C", direction="serializer"), result(), bare]
    file = tmp_path / "a.json"
    file.write_text(results_text(both))
    assert read_results(file) == [result(), bare, result("p/msg/C", direction="serializer")]
    first = json.loads(file.read_text())["results"][0]
    assert first["simulation"]["cycles_per_beat"] == 1.25
    # 600 bytes in 100 cycles of 82.5 MHz.
    assert first["gbit_per_s"] == 3.96
    assert first["circuit"]["mhz"] == 82.5
    assert first["circuit"]["tools"] == {"Yosys": "0.70", "nextpnr-ecp5": "0.11.1"}


def test_the_reason_of_a_circuit_without_a_clock_rate_comes_back(tmp_path: Path) -> None:
    placed = result(mhz=())
    assert placed.measured is not None
    found = replace(placed, measured=replace(placed.measured, problem="no room"))
    file = tmp_path / "a.json"
    file.write_text(results_text([found]))
    assert read_results(file) == [found]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", r"is not a file of results of bench \(JSONDecodeError"),
        ("[]", r"is not a file of results of bench \(TypeError"),
        ('{"format": 1}', r"is not a file of results of bench \(KeyError: 'results'\)"),
        ('{"format": 7, "results": []}', "has format 7, and 1 is read"),
        ('{"format": 0, "results": []}', "has format 0, and 1 is read"),
        ('{"format": 1, "results": [{"type": "x"}]}', r"is not a file .*\(KeyError"),
    ],
)
def test_other_files_are_refused(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "a.json"
    file.write_text(text)
    with pytest.raises(BenchError, match=message):
        read_results(file)


@pytest.mark.parametrize("figure", ["NaN", "-1", f"1{'0' * 400}", '"2"', "true", "null"])
@pytest.mark.parametrize("name", ["lut", "mhz", "latency", "beats"])
def test_figures_that_nobody_measured_are_refused(tmp_path: Path, name: str, figure: str) -> None:
    text, count = re.subn(rf'(?<="{name}": )[0-9.]+', figure, results_text([result()]))
    assert count
    file = tmp_path / "a.json"
    file.write_text(text)
    with pytest.raises(BenchError, match="is not a file of results of bench"):
        read_results(file)


def test_a_line_has_all_figures_and_the_path() -> None:
    line, path = row(result()).splitlines()
    assert line.split() == [
        *("p/msg/A", "cdr", "deserializer", "8", "100", "50", "0", "0", "0"),
        *("82.5", "(80.0", "90.0", "82.5)", "0.800", "2", "3.96"),
    ]
    assert path == (
        "    12.5 ns, 8.0 of them routing, 9 cells: step 0.5 > & fill, offset 12.0 > run 12.5"
    )
    assert row(result(), path=False) == line
    bare = replace(result(), measured=None, cycles=None, problem="too large")
    assert row(bare).split("\n")[1] == "    no figures: too large"
    # Numbers are aligned with their headings.
    names = head(None)
    assert names.index("LUT") + 3 == line.index("100") + 3
    assert names.index("latency") + 7 == line.rindex(" 2 ") + 2


def test_the_summary_has_means_and_extremes() -> None:
    others = [result("p/msg/B", beats=50, mhz=(70.0,)), result("p/msg/C", beats=100)]
    text = summary([result(), *others], STATED)
    assert text == (
        "Yosys 0.70, nextpnr-ecp5 0.11.1: synth_ecp5 -top top; --45k\n"
        "simulated with 16 messages, strings of 4 to 10 characters, sequences of 3 to 8 elements, "
        "seed 0\n"
        "beats per cycle: 0.737 (geometric mean of 3), 2 below 0.85, lowest 0.500 "
        "(p/msg/B (lyrical, cdr, 8 bytes) deserializer)\n"
        "lowest clock rate: 70.0 MHz (p/msg/B (lyrical, cdr, 8 bytes) deserializer)"
    )
    assert summary([result(problem="x")], None).endswith(
        "1 of 1 converters are without some figures"
    )
    assert geometric_mean([0.5, 2.0]) == pytest.approx(1)


def test_two_converters_have_a_mean_and_one_has_none() -> None:
    two = [result(beats=50), result("p/msg/B", beats=100, mhz=(70.0,))]
    mean, lowest = summary(two, None).splitlines()[1:]
    assert mean == (
        "beats per cycle: 0.707 (geometric mean of 2), 1 below 0.85, lowest 0.500 "
        "(p/msg/A (lyrical, cdr, 8 bytes) deserializer)"
    )
    assert lowest == "lowest clock rate: 70.0 MHz (p/msg/B (lyrical, cdr, 8 bytes) deserializer)"
    # The other one of the two has no clock rate, no cycles, or neither of them.
    for other in (result("p/msg/B", mhz=()), replace(result("p/msg/B"), measured=None)):
        assert "clock rate" not in summary([result(), other], None)
    bare = replace(result("p/msg/B"), cycles=None)
    assert "beats per cycle" not in summary([result(), bare], STATED)
    assert summary([result(), bare], STATED).splitlines()[1].startswith("simulated with 16")
    assert "simulated" not in summary([bare], STATED)
    # Exactly 0.85 is not below.
    limit = [result(beats=85), result("p/msg/B", beats=84)]
    assert ", 1 below 0.85, lowest 0.840" in summary(limit, None)
    wrong = [result(), result("p/msg/B", problem="x"), result("p/msg/C", problem="y")]
    assert summary(wrong, None).endswith("\n2 of 3 converters are without some figures")


def test_changes_beyond_the_threshold_are_reported() -> None:
    new = result(lut=90, ff=51, mhz=(60.0,), latency=3)
    found = {
        change.figure: (str(change), change.is_worse) for change in compare([result()], [new], 0.02)
    }
    where = "p/msg/A (lyrical, cdr, 8 bytes) deserializer"
    assert found == {
        "LUT": (f"better {where}: LUT 100 -> 90 (-10.0 %)", False),
        "MHz": (f"worse  {where}: MHz 82.5 -> 60 (-27.3 %)", True),
        "latency": (f"worse  {where}: latency 2 -> 3 (+50.0 %)", True),
        "Gbit/s": (f"worse  {where}: Gbit/s 3.960 -> 2.880 (-27.3 %)", True),
    }
    assert len(list(compare([result()], [new], 0.01))) == 5
    assert list(compare([result()], [result()], 0.0)) == []


def test_figures_that_vanish_are_worse_and_those_that_appear_are_not() -> None:
    missing = replace(result(mhz=()), cycles=None)
    changes = list(compare([result()], [missing], 0.02))
    assert {each.figure for each in changes} == {"MHz", "beats per cycle", "latency", "Gbit/s"}
    assert all(each.is_worse for each in changes)
    assert str(changes[0]).endswith("MHz 82.5 -> none")
    assert not any(each.is_worse for each in compare([missing], [result()], 0.02))


def with_area(**counts: int) -> Result:
    """Return a result with 100 of each element of an area, or with other counts."""
    found = result()
    assert found.measured is not None
    area = dict.fromkeys(("lut", "ff", "carry", "lutram", "bram"), 100) | counts
    return replace(found, measured=replace(found.measured, area=Area(**area)))


@pytest.mark.parametrize(
    ("name", "figure"),
    [("lut", "LUT"), ("ff", "FF"), ("carry", "carry"), ("lutram", "RAM"), ("bram", "BRAM")],
)
def test_more_of_any_element_is_worse(name: str, figure: str) -> None:
    for count, is_worse in ((103, True), (97, False)):
        (change,) = compare([with_area()], [with_area(**{name: count})], 0.02)
        assert (change.figure, change.new, change.is_worse) == (figure, count, is_worse)
        word, share = ("worse ", "+3.0 %") if is_worse else ("better", "-3.0 %")
        assert str(change).startswith(word)
        assert str(change).endswith(f"{figure} 100 -> {count} ({share})")
    # Exactly the threshold is not beyond it.
    assert list(compare([with_area()], [with_area(**{name: 102})], 0.02)) == []
    # From nothing, any change is.
    (change,) = compare([with_area(**{name: 0})], [with_area(**{name: 1})], 9.0)
    assert str(change).endswith(f"{figure} 0 -> 1") and change.is_worse


@pytest.mark.parametrize(
    ("better", "figures"),
    [
        ({"mhz": (99.0,)}, ["MHz", "Gbit/s"]),
        ({"beats": 100}, ["beats per cycle"]),
        ({"latency": 1}, ["latency"]),
    ],
)
def test_more_speed_and_less_latency_are_better(
    better: dict[str, object], figures: list[str]
) -> None:
    there = list(compare([result()], [result(**better)], 0.02))
    back = list(compare([result(**better)], [result()], 0.02))
    assert [each.figure for each in there] == [each.figure for each in back] == figures
    assert not any(each.is_worse for each in there) and all(each.is_worse for each in back)


def test_comparison_names_different_tools_and_missing_converters() -> None:
    old = [result(), result("p/msg/B")]
    text, is_fine = compared(old, [result(mapping="synth_ecp5 -abc9"), result("p/msg/C")], 0.02)
    provenance = "Yosys 0.70, nextpnr-ecp5 0.11.1; {}; --45k; seeds 1 2 3; " + str(STATED)
    assert text == (
        f"not alike: {result().converter}: {provenance.format('synth_ecp5 -top top')}, "
        f"now {provenance.format('synth_ecp5 -abc9')}\n"
        "1 converters compared, 1 are new, 1 are not measured now; 0 figures changed by more than "
        "2 %"
    )
    assert is_fine
    # A comparison without common converters is no pass.
    assert not compared(old, [result("p/msg/C")], 0.02)[1]
    assert not compared(old, [result(lut=200)], 0.02)[1]
    # The same converter on another device, bus or wire is another one.
    (first,) = [each for each in old if each.converter.type == "p/msg/A"]
    assert first.measured is not None
    other = replace(first, measured=replace(first.measured, device=DEVICES["ice40"]))
    for each in (other, result(bus_bytes=4), result(direction="serializer")):
        text, is_fine = compared([first], [each], 0.02)
        assert text.startswith("0 converters compared, 1 are new, 1 are not") and not is_fine
    assert compared(old, [result(lut=50)], 0.02)[1]


def test_the_path_is_that_of_the_run_nearest_to_the_median() -> None:
    for rates, middle in (((90.0, 70.0, 80.0), 2), ((70.0, 90.0, 80.0, 81.0), 2)):
        measured = result(mhz=rates).measured
        assert measured is not None
        placed = [
            replace(each, path=replace(each.path, ns=float(number)))
            for number, each in enumerate(measured.placed)
        ]
        path = replace(measured, placed=tuple(placed)).path
        assert path is not None and path.ns == middle
