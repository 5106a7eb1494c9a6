"""Registers outside of ports, counts of cells, and own names of nets, on small netlists."""

from __future__ import annotations

from typing import Any

import pytest

from firm_hdl.bench import DEVICES, BenchError
from firm_hdl.bench.devices import Area
from firm_hdl.bench.netlist import Names, cell_counts, register_ports, top_module
from firm_hdl.bench.paths import critical_path

ECP5 = DEVICES["ecp5"]


def lut(z: int, *inputs: int) -> dict[str, Any]:
    ports = dict(zip("ABC", [[bit] for bit in inputs], strict=False))
    return {
        "type": "LUT4",
        "port_directions": {"Z": "output", **dict.fromkeys(ports, "input"), "D": "input"},
        "connections": {"Z": [z], **ports, "D": ["0"]},
    }


def flip_flop(d: int, q: int) -> dict[str, Any]:
    return {
        "type": "TRELLIS_FF",
        "port_directions": {"CLK": "input", "DI": "input", "Q": "output"},
        "connections": {"CLK": [2], "DI": [d], "Q": [q]},
    }


def small() -> dict[str, Any]:
    """A module of three ports, a register, and two look-up tables between them."""
    return {
        "ports": {
            "clk": {"direction": "input", "bits": [2]},
            "rst": {"direction": "input", "bits": [3]},
            "i": {"direction": "input", "bits": [4, 5]},
            "o": {"direction": "output", "bits": [7, "0"]},
        },
        "cells": {
            "fill_LUT4_A_Z_LUT4_Z": lut(6, 5, 7, 8),
            "i_LUT4_A": lut(8, 4, 5),
            "fill_TRELLIS_FF_Q": flip_flop(6, 7),
            "$1": flip_flop(6, 9),
        },
        "netnames": {
            "clk": {"bits": [2]},
            "rst": {"bits": [3]},
            "i": {"bits": [4, 5]},
            "o": {"bits": [7, "0"]},
            "i_LUT4_A_Z": {"bits": [8]},
            "fill_LUT4_A_Z": {"bits": [6]},
            "core.fill": {"bits": [7]},
            "$abc$1$x": {"bits": [6]},
            "f": {"bits": [7], "hide_name": 1},
        },
    }


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


def test_each_bit_of_a_port_gets_a_register_outside() -> None:
    top = small()
    assert ECP5.placer is not None
    assert register_ports(top, ECP5.placer) == 3
    assert {name: port["bits"] for name, port in top["ports"].items()} == {
        "clk": [2],
        "rst": [3],
        "i": [10, 11],
        "o": [12, "0"],
    }
    added = {name: c["connections"] for name, c in top["cells"].items() if name.startswith("port")}
    assert added == {
        "port i[0]": {"CLK": [2], "DI": [10], "Q": [4]},
        "port i[1]": {"CLK": [2], "DI": [11], "Q": [5]},
        "port o[0]": {"CLK": [2], "DI": [7], "Q": [12]},
    }
    # The circuit itself is as it was.
    assert top["cells"]["fill_LUT4_A_Z_LUT4_Z"] == lut(6, 5, 7, 8)


def test_a_circuit_without_a_clock_has_no_clock_rate() -> None:
    top = small()
    del top["ports"]["clk"]
    assert ECP5.placer is not None
    with pytest.raises(BenchError, match=r"^the circuit has no clock 'clk', so it has no clock r"):
        register_ports(top, ECP5.placer)


def test_nets_have_the_names_of_the_design() -> None:
    names = Names(small())
    nets = ("o[0]", "core.fill", "i[1]", "fill_LUT4_A_Z", "$abc$1$x", "unknown")
    assert [names.net(net) for net in nets] == ["o", "o", "i", "", "", ""]
    cells = ("fill_TRELLIS_FF_Q", "port i[1]", "$1", "unknown")
    assert [names.register(cell) for cell in cells] == ["o", "port i", "$1", "unknown"]


@pytest.mark.parametrize(
    ("net", "joining"),
    [("i[1]", ["o", "i"]), ("core.fill", ["i"]), ("i_LUT4_A_Z", ["i", "o"]), ("", ["i", "o"])],
)
def test_what_joins_a_path_is_named_through_other_logic(net: str, joining: list[str]) -> None:
    assert list(Names(small()).joining("fill_LUT4_A_Z_LUT4_Z", net)) == joining


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
