# amaranth: UnusedElaboratable=no
"""Each figure is that of its name: parts, plots, estimates, comparisons and counts of cycles."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from firm_hdl.bench import command
from firm_hdl.bench.compare import compare
from firm_hdl.bench.cycles import Stated, values
from firm_hdl.bench.devices import DEVICES, PARITY, Area
from firm_hdl.bench.results import Result
from firm_hdl.bench.tables import summary
from firm_hdl.cli import main
from tests.bench.results import result
from tests.strategies import make

SVG = "{http://www.w3.org/2000/svg}"
AREA = Area(lut=1001, ff=202, carry=33, lutram=4, bram=5)


def measured(found: Result, **changes: Any) -> Result:
    """Return a result with other figures of the circuit."""
    assert found.measured is not None
    return replace(found, measured=replace(found.measured, **changes))


def test_each_change_of_a_figure_has_its_name_and_its_direction() -> None:
    old = measured(result(), area=AREA)
    for name, figure in zip(
        ("lut", "ff", "carry", "lutram", "bram"),
        ("LUT", "FF", "carry", "RAM", "BRAM"),
        strict=True,
    ):
        number = getattr(AREA, name)
        for change in (1, -1):
            new = measured(old, area=replace(AREA, **{name: number + change}))
            (found,) = compare([old], [new], 0.0)
            assert (found.figure, found.old, found.new) == (figure, number, number + change)
            assert found.is_worse == (change > 0)


@pytest.mark.parametrize(("beats", "is_worse"), [(40, True), (90, False)])
def test_fewer_beats_per_cycle_are_worse(beats: int, is_worse: bool) -> None:
    # 80 beats in 100 cycles before.
    (found,) = compare([result()], [result(beats=beats)], 0.02)
    assert (found.figure, found.is_worse) == ("beats per cycle", is_worse)
    assert (found.old, found.new) == (pytest.approx(0.8), pytest.approx(beats / 100))


def test_each_mapping_is_told_with_its_own_tools() -> None:
    one = result()
    other = measured(result("p/msg/B"), mapping="abc", tools={"Yosys": "0.99"}, placement="--25k")
    assert summary([one, other], None).splitlines()[:2] == [
        "Yosys 0.99: abc; --25k",
        "Yosys 0.70, nextpnr-ecp5 0.11.1: synth_ecp5 -top top; --45k",
    ]


def test_cells_of_all_kinds_are_added_up() -> None:
    assert DEVICES["gowin"].area({"LUT1": 1, "LUT4": 20, "DFF": 300, "DFFNRE": 4000}) == Area(
        lut=21, ff=4300
    )
    assert DEVICES["xc7"].area({"RAMB18E1": 1, "RAMB36E1": 2, "SRL16E": 4}) == Area(
        lutram=4, bram=3
    )
    # With any edge, enable, and set or reset, synchronous or not.
    resets = ("", "R", "S", "SR", "SS")
    kinds = {f"SB_DFF{n}{e}{r}" for n in ("", "N") for e in ("", "E") for r in resets}
    assert DEVICES["ice40"].area(dict.fromkeys(kinds, 1)) == Area(ff=20)
    assert "SB_DFFNESS" in kinds
    kinds = {
        f"DFF{n}{r}{e}" for n in ("", "N") for r in ("", "S", "R", "P", "C") for e in ("", "E")
    }
    assert DEVICES["gowin"].area(dict.fromkeys(kinds, 1)) == Area(ff=20)
    kinds = {f"FD{r}E{n}" for r in "RSCP" for n in ("", "_1")}
    assert DEVICES["xc7"].area(dict.fromkeys(kinds, 1)) == Area(ff=8)


@pytest.mark.parametrize(
    ("name", "first", "last"), [("gowin", 1, 4), ("xc7", 1, 6), ("ecp5", 4, 4)]
)
def test_tables_of_all_sizes_that_a_device_has_count(name: str, first: int, last: int) -> None:
    assert DEVICES[name].area({f"LUT{n}": 10**n for n in range(1, 8)}) == Area(
        lut=sum(10**n for n in range(first, last + 1))
    )


@pytest.mark.parametrize(
    ("name", "carry", "lutram", "bram"),
    [
        ("ecp5", "CCU2C", "TRELLIS_DPR16X4", "DP16KD"),
        ("gowin", "ALU", "RAM16SDP4", "SDPX9B"),
        ("xc7", "CARRY4", "RAM32M", "RAMB36E1"),
        ("ice40", "SB_CARRY", None, "SB_RAM40_4KNRNW"),
    ],
)
def test_carry_chains_and_memories_are_those_of_the_device(
    name: str, carry: str, lutram: str | None, bram: str
) -> None:
    counts = {carry: 3, bram: 5} | ({lutram: 4} if lutram else {})
    assert DEVICES[name].area(counts) == Area(carry=3, lutram=4 if lutram else 0, bram=5)


@pytest.mark.parametrize(
    ("name", "title", "options"),
    [
        ("ecp5", "LFE5U-45F-8", ["--45k", "--speed 8", "--out-of-context", "--router router1"]),
        ("ice40", "HX8K", ["--hx8k", "--pcf-allow-unconstrained"]),
        ("gowin", "GW2A-LV18PG256C8/I7", ["--device GW2A-LV18PG256C8/I7", "family=GW2A-18"]),
    ],
)
def test_the_part_that_is_placed_is_the_one_in_the_title(
    name: str, title: str, options: list[str]
) -> None:
    device = DEVICES[name]
    assert device.title.endswith(title) and device.placer is not None
    words = f" {' '.join(device.placer.options)} "
    assert [option for option in options if f" {option} " not in words] == []


def test_the_table_of_parity_is_the_xor_of_four_bits() -> None:
    ones = [bin(number).count("1") for number in range(16)]
    assert "".join(str(ones[number] % 2) for number in reversed(range(16))) == PARITY


def test_numbers_of_messages_have_all_their_bits() -> None:
    message = make("ros2", {"b": "uint8", "c": "int8", "w": "uint64", "v": "int64"})
    drawn = [value for value, _ in zip(values(message, Stated(seed=3)), range(300), strict=False)]
    assert max(value["b"] for value in drawn) > 240 and max(v["c"] for v in drawn) > 120
    assert max(value["w"] for value in drawn) >> 63 == 1
    assert max(value["v"] for value in drawn) >> 62 == 1


@pytest.fixture
def given_results(monkeypatch: pytest.MonkeyPatch) -> list[Result]:
    """The results of the command; without them, none is measured."""
    results: list[Result] = []
    monkeypatch.setattr(command, "versions", lambda device, *, with_placer: {})
    monkeypatch.setattr(command, "run_tasks", lambda tasks, jobs: results)
    return results


def test_a_problem_is_a_failure_also_if_no_figure_is_worse(
    given_results: list[Result], tmp_path: Path
) -> None:
    file = tmp_path / "old.json"
    words = ["bench", "std_msgs/msg/Bool"]
    given_results.append(result())
    assert main([*words, "--json", str(file)]) == 0
    assert main([*words, "--compare", str(file)]) == 0
    given_results[:] = [result(problem="no room")]
    assert main([*words, "--compare", str(file)]) == 1
    # Eight percent more.
    given_results[:] = [result(lut=108)]
    assert main([*words, "--compare", str(file), "--threshold", "9"]) == 0
    assert main([*words, "--compare", str(file), "--threshold", "7"]) == 1
    # The old figures are read before the file is replaced.
    assert main([*words, "--compare", str(file), "--json", str(file)]) == 1
    assert main([*words, "--compare", str(file)]) == 0
