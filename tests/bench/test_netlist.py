"""Registers outside of ports, counts of cells, and own names of nets, on small netlists."""

from __future__ import annotations

from typing import Any

import pytest

from firm_hdl.bench import DEVICES, BenchError
from firm_hdl.bench.devices import Area
from firm_hdl.bench.netlist import Names, cell_counts, register_ports, top_module
from firm_hdl.bench.paths import critical_path

ECP5 = DEVICES["ecp5"]


def lut(a: int, z: int) -> dict[str, Any]:
    return {"type": "LUT4", "connections": {"A": [a], "Z": [z], "B": ["0"]}}


def flip_flop(d: int, q: int) -> dict[str, Any]:
    return {"type": "TRELLIS_FF", "connections": {"CLK": [2], "DI": [d], "Q": [q]}}


def small() -> dict[str, Any]:
    """A module of three ports, a register and a look-up table."""
    return {
        "ports": {
            "clk": {"direction": "input", "bits": [2]},
            "rst": {"direction": "input", "bits": [3]},
            "i": {"direction": "input", "bits": [4, 5]},
            "o": {"direction": "output", "bits": [7, "0"]},
        },
        "cells": {
            "fill_LUT4_A_Z_LUT4_Z": lut(4, 6),
            "fill_TRELLIS_FF_Q": flip_flop(6, 7),
        },
        "netnames": {
            "clk": {"bits": [2]},
            "rst": {"bits": [3]},
            "i": {"bits": [4, 5]},
            "o": {"bits": [7, "0"]},
            "fill_LUT4_A_Z": {"bits": [6]},
            "core.fill": {"bits": [7]},
            "$abc$1$x": {"bits": [6]},
            "f": {"bits": [7], "hide_name": 1},
        },
    }


def test_cells_count_by_type() -> None:
    top = small()
    assert cell_counts(top) == {"LUT4": 1, "TRELLIS_FF": 1}
    assert ECP5.area({"LUT4": 3, "TRELLIS_FF": 4, "CCU2C": 5, "$scopeinfo": 6}) == Area(
        lut=3, ff=4, carry=5
    )
    assert ECP5.area({"TRELLIS_DPR16X4": 1, "DP16KD": 2}) == Area(lutram=1, bram=2)


@pytest.mark.parametrize("netlist", [{}, {"modules": {}}, {"modules": {"top": {"cells": {}}}}])
def test_an_empty_netlist_is_no_netlist(netlist: dict[str, Any]) -> None:
    with pytest.raises(BenchError, match=r"^Yosys ended without an error, and its netlist has no"):
        top_module(netlist)


def test_each_bit_of_a_port_gets_a_register_outside() -> None:
    top = small()
    assert ECP5.placer is not None
    assert register_ports(top, ECP5.placer) == 3
    assert {name: port["bits"] for name, port in top["ports"].items()} == {
        "clk": [2],
        "rst": [3],
        "i": [8, 9],
        "o": [10, "0"],
    }
    added = {name: c["connections"] for name, c in top["cells"].items() if name.startswith("port")}
    assert added == {
        "port i[0]": {"CLK": [2], "DI": [8], "Q": [4]},
        "port i[1]": {"CLK": [2], "DI": [9], "Q": [5]},
        "port o[0]": {"CLK": [2], "DI": [7], "Q": [10]},
    }
    # The circuit itself is as it was.
    assert top["cells"]["fill_LUT4_A_Z_LUT4_Z"] == lut(4, 6)


def test_a_circuit_without_a_clock_has_no_clock_rate() -> None:
    top = small()
    del top["ports"]["clk"]
    assert ECP5.placer is not None
    with pytest.raises(BenchError, match=r"^the circuit has no clock 'clk', so it has no clock r"):
        register_ports(top, ECP5.placer)


@pytest.mark.parametrize(
    ("given", "own"),
    [
        ("o[0]", "o"),
        ("core.fill", "o"),
        ("fill_LUT4_A_Z", "(fill)"),
        ("fill_TRELLIS_FF_Q_3_DI[2]", "(fill)"),
        ("$abc$1$x", ""),
        ("port i[1]", "port i"),
        ("packed_LUT4x", "(packed_LUT4x)"),
    ],
)
def test_nets_have_the_names_of_the_design(given: str, own: str) -> None:
    assert Names(small()).of(given) == own


def segment(kind: str, delay: float, cell: str = "", net: str = "", to: str = "") -> dict[str, Any]:
    return {
        "type": kind,
        "delay": delay,
        "net": net,
        "from": {"cell": cell},
        "to": {"cell": to},
    }


def test_a_path_is_told_in_names_of_the_design() -> None:
    way = [
        segment("clk-to-q", 0.5, "port i[0]"),
        segment("routing", 1.0, net="i[0]"),
        segment("logic", 0.25),
        segment("routing", 0.5, net="fill_LUT4_A_Z"),
        segment("setup", 0.25, to="fill_TRELLIS_FF_Q"),
    ]
    other = [segment("clk-to-q", 9.0, "x")]
    report = {
        "critical_paths": [
            {"from": "<async>", "to": "posedge clk", "path": other},
            {"from": "posedge clk", "to": "posedge clk", "path": way},
        ]
    }
    found = critical_path(report, Names(small()))
    assert (found.ns, found.routing_ns, found.luts) == (2.5, 1.5, 1)
    assert found.points == ((0.5, "port i"), (1.5, "i"), (2.25, "(fill)"), (2.5, "fill"))
    assert str(found) == (
        "2.5 ns, 1.5 of them routing, 1 LUTs: port i 0.5 > i 1.5 > (fill) 2.2 > fill 2.5"
    )
    with pytest.raises(BenchError, match=r"^nextpnr reports no path from a register to"):
        critical_path({"critical_paths": report["critical_paths"][:1]}, Names(small()))
