"""The RTLIL as a flat circuit: from the JSON that Yosys writes, which is made by hand here."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from firm_hdl.equivalence import ProofError
from firm_hdl.equivalence.circuit import Circuit
from firm_hdl.equivalence.rtlil_side import read_rtlil

# Inputs `a` (nets 2 and 3), `c` (4) and `r` (5); the register `q` (6 and 7) is an output.
BASE: dict[str, Any] = {
    "attributes": {"top": "1"},
    "ports": {
        "a": {"direction": "input", "bits": [2, 3]},
        "c": {"direction": "input", "bits": [4]},
        "r": {"direction": "input", "bits": [5]},
        "nothing": {"direction": "input", "bits": []},
        "o": {"direction": "output", "bits": [6, 7]},
    },
    "netnames": {
        "a": {"bits": [2, 3], "attributes": {}},
        "q": {"bits": [6, 7], "attributes": {"init": "10", "hdlname": "inner q"}},
    },
    "cells": {
        "kept": {
            "type": "$dff",
            "parameters": {"CLK_POLARITY": "1"},
            "port_directions": {"CLK": "input", "D": "input", "Q": "output"},
            "connections": {"CLK": [4], "D": [2, 3], "Q": [6, 7]},
        }
    },
}


class Yosys:
    """Writes given modules in place of Yosys."""

    def __init__(self, *modules: dict[str, Any]) -> None:
        self.modules = modules

    def run_yosys(self, folder: Path, script: str, timeout: float | None) -> None:
        assert (folder / "amaranth.il").read_text(encoding="utf-8") == "text"
        made = {f"m{number}": module for number, module in enumerate(self.modules)}
        (folder / "amaranth.json").write_text(json.dumps({"modules": made}))


def read(folder: Path, *others: dict[str, Any], **changes: Any) -> Circuit:
    """Read the module with changed parts, such as more cells, and other modules."""
    module = {**BASE, **{part: {**BASE[part], **new} for part, new in changes.items()}}
    return read_rtlil("text", Yosys(module, *others), folder, None)  # type: ignore[arg-type]


def cell(kind: str, y: list[int], **parameters: str) -> dict[str, Any]:
    """Return a cell with the operands `a` and `c`."""
    ways = {"A": "input", "B": "input", "Y": "output"}
    connections = {"A": [2, 3], "B": [4], "Y": y}
    return {
        "type": kind,
        "parameters": parameters,
        "port_directions": ways,
        "connections": connections,
    }


def test_registers_without_an_initial_value_start_with_any(tmp_path: Path) -> None:
    with pytest.raises(ProofError, match=r"^a register of the RTLIL has no name \(net 6\)$"):
        read(tmp_path, netnames={"q": {"bits": [6, 7], "attributes": {}}})
    some = {"bits": [6, 7], "attributes": {"init": "1x"}}
    flops = read(tmp_path, netnames={"q": some}).flops
    assert [flops[net].init for net in (6, 7)] == ["x", "1"]


@pytest.mark.parametrize(
    "kind",
    [
        *("$tribuf", "$anyseq", "$anyconst", "$allseq", "$allconst", "$initstate"),
        *("$dffe", "$sdff", "$aldff", "$dffsr", "$ff", "$sr", "$mem_v2", "$memrd", "$meminit"),
    ],
)
def test_cells_that_a_proof_does_not_know_are_refused(tmp_path: Path, kind: str) -> None:
    with pytest.raises(ProofError, match=rf"^the design has \{kind}, which a proof does not"):
        read(tmp_path, cells={"odd": cell(kind, [8, 9])})


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"ports": {"o": {"direction": "inout", "bits": [6, 7]}}},
            "o is a port of mode inout, which a proof does not support",
        ),
        (
            {"cells": {"odd": cell("part", [8, 9])}},
            "the design has an instance of part, which is not in the design",
        ),
        (
            {"netnames": {"w": {"bits": ["0"], "attributes": {"init": "1"}}}},
            "w has an initial value, but is not a register",
        ),
        (
            {"netnames": {"w": {"bits": [7, 6], "attributes": {"init": "10"}}}},
            "w has an initial value, but is not a register",
        ),
    ],
)
def test_a_design_that_is_no_circuit_is_refused(tmp_path: Path, changes, message) -> None:
    with pytest.raises(ProofError, match=f"^{message}$"):
        read(tmp_path, **changes)


@pytest.mark.parametrize("offset", [1, -1])
def test_a_memory_starts_at_address_0(tmp_path: Path, offset: int) -> None:
    memory = {"attributes": {}, "width": 2, "size": 2, "start_offset": offset}
    module = {**BASE, "memories": {"mem": memory}}
    with pytest.raises(ProofError, match=r"^memory mem does not start at address 0$"):
        read_rtlil("text", Yosys(module), tmp_path, None)  # type: ignore[arg-type]
    module = {**BASE, "memories": {"mem": {**memory, "start_offset": 0}}}
    assert read_rtlil("text", Yosys(module), tmp_path, None) == read(tmp_path)  # type: ignore[arg-type]


@pytest.mark.parametrize(("tops", "found"), [(["0"], 1), (["1"], 2), (["0", "1", "1"], 3)])
def test_there_is_one_outermost_module(tmp_path: Path, tops: list[str], found: int) -> None:
    others = [{**BASE, "attributes": {"top": top}} for top in tops]
    if found == 1:
        assert read(tmp_path, *others, {**BASE, "attributes": {}}) == read(tmp_path)
        with pytest.raises(ProofError, match="the RTLIL has 0 outermost modules"):
            read_rtlil("text", Yosys(*others), tmp_path, None)  # type: ignore[arg-type]
    else:
        with pytest.raises(ProofError, match=f"^the RTLIL has {found} outermost modules$"):
            read(tmp_path, *others)
