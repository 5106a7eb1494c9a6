"""Counts of cells, own names of nets, and critical paths, on a small netlist."""

from __future__ import annotations

from typing import Any

import pytest

from firm_hdl.bench import DEVICES, BenchError
from firm_hdl.bench.devices import Area
from firm_hdl.bench.netlist import Names, cell_counts, critical_path, top_module
from tests.bench.netlists import flip_flop, lut, small

ECP5 = DEVICES["ecp5"]


def test_cells_count_by_type() -> None:
    top = small()
    assert cell_counts(top) == {"LUT4": 2, "TRELLIS_FF": 2}
    assert ECP5.area({"LUT4": 3, "TRELLIS_FF": 4, "CCU2C": 5, "$scopeinfo": 6}) == Area(
        lut=3, ff=4, carry=5
    )
    assert ECP5.area({"TRELLIS_DPR16X4": 1, "DP16KD": 2}) == Area(lutram=1, bram=2)


@pytest.mark.parametrize("netlist", [{}, {"modules": {}}, {"modules": {"top": {"cells": {}}}}])
def test_an_empty_netlist_is_no_netlist(netlist: dict[str, Any]) -> None:
    with pytest.raises(BenchError, match=r"^Yosys ended without an error, and its netlist has no"):
        top_module(netlist)


def test_nets_have_the_names_of_the_design() -> None:
    names = Names(small())
    nets = ("o[0]", "core.fill", "i[1]", "fill_LUT4_A_Z", "$abc$1$x", "unknown")
    assert [names.net(net) for net in nets] == ["o", "o", "i", "", "", ""]
    cells = ("fill_TRELLIS_FF_Q", "port i[1]", "$1", "unknown")
    assert [names.register(cell) for cell in cells] == ["o", "port i", "$1", "unknown"]


@pytest.mark.parametrize("end", ["", "_LC", "_DFFLC", "$nextpnr_LUT4_1"])
def test_placed_cell_of_ice40_has_the_register_behind_its_table(end: str) -> None:
    top = small()
    assert Names(top).register(f"fill_LUT4_A_Z_LUT4_Z{end}") == "o"
    assert list(Names(top).joining(f"fill_LUT4_A_Z_LUT4_Z{end}", "i[1]")) == ["o", "i"]
    # The table drives a register outside of a port, and nothing else that has a name.
    top["cells"]["port q[1]"] = flip_flop(8, 20)
    del top["cells"]["fill_LUT4_A_Z_LUT4_Z"]
    assert Names(top).register(f"i_LUT4_A{end}") == "port q"


@pytest.mark.parametrize(
    ("net", "joining"),
    [("i[1]", ["o", "i"]), ("core.fill", ["i"]), ("i_LUT4_A_Z", ["i", "o"]), ("", ["i", "o"])],
)
def test_joint_of_a_path_is_named_through_other_logic(net: str, joining: list[str]) -> None:
    assert list(Names(small()).joining("fill_LUT4_A_Z_LUT4_Z", net)) == joining


def segment(kind: str, delay: float, cell: str = "", net: str = "", to: str = "") -> dict[str, Any]:
    return {
        "type": kind,
        "delay": delay,
        "net": net,
        "from": {"cell": cell},
        "to": {"cell": to},
    }


def test_path_has_the_names_of_the_design() -> None:
    way = [
        segment("clk-to-q", 0.5, "port i[0]"),
        segment("routing", 1.0, net="i[0]"),
        segment("logic", 0.25, "i_LUT4_A"),
        segment("routing", 0.5, net="i_LUT4_A_Z"),
        segment("logic", 0.25, "fill_LUT4_A_Z_LUT4_Z"),
        segment("routing", 0.0, net="fill_LUT4_A_Z"),
        segment("setup", 0.25, to="fill_TRELLIS_FF_Q"),
    ]
    other = [segment("clk-to-q", 9.0, "x")]
    report = {
        "critical_paths": [
            {"from": "<async>", "to": "posedge clk", "path": other},
            {"from": "posedge clk", "to": "<async>", "path": other},
            {"from": "posedge clk", "to": "posedge clk", "path": way},
        ]
    }
    found = critical_path(report, Names(small()))
    assert (found.ns, found.routing_ns, found.cells) == (2.75, 1.5, 2)
    assert found.points == ((0.5, "port i"), (1.5, "i"), (2.5, "& o"), (2.75, "o"))
    assert str(found) == (
        "2.8 ns, 1.5 of them routing, 2 cells: port i 0.5 > i 1.5 > & o 2.5 > o 2.8"
    )
    with pytest.raises(BenchError, match=r"^nextpnr reports no path from a register to"):
        critical_path({"critical_paths": report["critical_paths"][:1]}, Names(small()))


def test_at_most_three_signals_join_at_a_point_and_each_only_once() -> None:
    names = {"x": 10, "a": 20, "b": 21, "c": 22, "d": 23}
    top = {
        # `d` joins the first table, and so do the others, through logic without a name.
        "cells": {"l0": lut(40, 20, 21, 22), "l1": lut(30, 10, 40, 23), "l2": lut(31, 30, 40)},
        "netnames": {name: {"bits": [bit]} for name, bit in names.items()}
        | {"l1_LUT4_A_Z": {"bits": [30]}},
    }
    way = [
        segment("routing", 1.0, net="x"),
        segment("logic", 0.5, "l1"),
        segment("routing", 0.25, net="l1_LUT4_A_Z"),
        segment("logic", 0.5, "l2"),
    ]
    report = {"critical_paths": [{"from": "posedge clk", "to": "posedge clk", "path": way}]}
    found = critical_path(report, Names(top))
    assert found.points == ((1.0, "x"), (1.5, "& d, a, b"), (2.25, "& c"))
